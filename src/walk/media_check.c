#include "walk/media_check.h"

#include "numeric/rng.h"
#include "scene/camera.h"
#include "walk/photons.h"
#include "walk/walk.h"

enum { ACROSS = 48, RAYS = ACROSS * ACROSS, VERTICES = 24 };

struct traveller {
  struct ray ray;
  uint32_t medium;
  uint64_t number; // of the path
};

struct check {
  const struct scene *scene;
  const struct bvh *bvh;
  struct rng_key key;
  const char *from; // for messages: where the rays begin
  int n;
  struct traveller *way; // [RAYS], as the next two
  struct ray *ray;
  struct hit *hit;
  uint64_t disagrees; // the first path that did, or NOBODY
  struct problem said;
};
#define NOBODY UINT64_MAX

static void draw(const struct check *check, uint64_t path, int vertex, uint32_t pair, double u[2]) {
  rng_fill(check->key, (uint64_t)vertex + 1, &path, 1, pair, &u[0], &u[1]);
}

struct medium_name {
  char text[128];
};

static struct medium_name name_of(const struct scene *scene, uint32_t medium) {
  struct medium_name name = {"a vacuum"};
  if (medium != MEDIUM_NONE)
    snprintf(name.text, sizeof name.text, "medium \"%s\"", scene->medium[medium].name);
  return name;
}

// ---- what can be wrong ----

// True: it is the second path that finds something.
static bool disagree(struct check *check, uint64_t path) {
  if (check->disagrees != NOBODY && check->disagrees != path) return true;
  check->disagrees = path;
  return false;
}

static bool emits_towards(const struct scene *scene, const struct surface *surface, struct vec w) {
  uint32_t row = scene->shape[surface->shape].light;
  double rgb[3];
  if (row == LIGHT_NONE) return false;
  const struct light *light = &scene->light[row];
  light->type->radiance(scene, light, surface, w, rgb);
  return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0;
}

// The medium that the shape says is on the ray's side, if it says so.
static bool fits(struct check *check, const struct traveller *way, const struct surface *surface) {
  const struct scene *scene = check->scene;
  const struct shape *shape = &scene->shape[surface->shape];
  struct vec back = vec_scale(way->ray.d, -1);
  uint32_t here = vec_dot(back, surface->ng) > 0 ? shape->outside : shape->inside;
  bool says = shape->inside != MEDIUM_NONE || shape->outside != MEDIUM_NONE;
  if (here == way->medium || !(says || emits_towards(scene, surface, back))) return true;
  struct vec p = surface->p;
  problem_set(
      &check->said,
      "%s: media overlap: at (%g, %g, %g) a ray from %s is in %s, and the %s it meets has %s "
      "on that side; give them the same MediumInterface",
      scene->path, p.x, p.y, p.z, check->from, name_of(scene, way->medium).text, shape->type->name,
      name_of(scene, here).text);
  return !disagree(check, way->number);
}

static const struct light *light_at_infinity(const struct scene *scene) {
  for (uint32_t k = 0; k < scene->n_lights; k++)
    if (scene->light[k].type->at_infinity) return &scene->light[k];
  return NULL;
}

static bool may_leave(struct check *check, const struct traveller *way) {
  const struct scene *scene = check->scene;
  const struct light *light = light_at_infinity(scene);
  if (way->medium == MEDIUM_NONE || !light) return true;
  struct vec o = way->ray.o, d = way->ray.d;
  const char *why = scene->medium[way->medium].type->uniform
                        ? "nothing of it arrives through the unbounded medium"
                        : "what it emits begins in a vacuum";
  problem_set(&check->said,
              "%s: a ray from %s leaves the scene from (%g, %g, %g) along (%g, %g, %g) in %s, and "
              "LightSource \"%s\" shines from infinity: %s; enclose the medium in shapes of "
              "material \"interface\"",
              scene->path, check->from, o.x, o.y, o.z, d.x, d.y, d.z,
              name_of(scene, way->medium).text, light->type->name, why);
  return !disagree(check, way->number);
}

// ---- the way on ----

static bool scatter(const struct check *check, struct traveller *way, const struct surface *surface,
                    int vertex) {
  const struct scene *scene = check->scene;
  double direction[2], choice[2];
  draw(check, way->number, vertex, 0, direction);
  draw(check, way->number, vertex, 1, choice);
  struct bsdf bsdf;
  surface_bsdf(scene, surface, choice[1], &bsdf);
  struct bsdf_sample sample;
  const double u[3] = {direction[0], direction[1], choice[0]};
  if (!bsdf.type || !bsdf_sample(&bsdf, vec_scale(way->ray.d, -1), u, TRANSPORT_RADIANCE, &sample))
    return false;
  way->medium = surface_medium(scene, surface, sample.wi, way->medium);
  way->ray = (struct ray){surface->p, sample.wi, INFINITY, surface->primitive};
  return true;
}

// False: the path ends.
static bool go_on(const struct check *check, struct traveller *way, const struct surface *surface,
                  int vertex) {
  const struct scene *scene = check->scene;
  double u[2];
  draw(check, way->number, vertex, 2, u);
  if (u[0] < surface_opacity(scene, surface)) return scatter(check, way, surface, vertex);
  if (scene_material(scene, surface)->type->passed)
    way->medium = surface_medium(scene, surface, way->ray.d, way->medium);
  way->ray = walk_ray_beyond(surface, &way->ray);
  return true;
}

static bool step(struct check *check, int vertex) {
  int alive = 0;
  for (int j = 0; j < check->n; j++) check->ray[j] = check->way[j].ray;
  bvh_closest(check->bvh, check->ray, check->hit, check->n);
  for (int j = 0; j < check->n; j++) {
    struct traveller *way = &check->way[j];
    if (check->hit[j].primitive == PRIMITIVE_NONE) {
      if (!may_leave(check, way)) return false;
      continue;
    }
    struct surface surface;
    scene_surface(check->scene, &way->ray, check->hit[j], &surface);
    if (!fits(check, way, &surface)) return false;
    if (go_on(check, way, &surface, vertex)) check->way[alive++] = *way;
  }
  check->n = alive;
  return true;
}

static bool follow(struct check *check) {
  check->disagrees = NOBODY;
  check->said = (struct problem){{0}};
  for (int vertex = 0; vertex < VERTICES && check->n > 0; vertex++)
    if (!step(check, vertex)) return false;
  return true;
}

// ---- where rays begin ----

static void from_camera(struct check *check) {
  const struct scene *scene = check->scene;
  check->from = "the camera";
  check->key = rng_key(rng_hash_name("media of the camera"), 0, RNG_EYE);
  for (check->n = 0; check->n < RAYS; check->n++) {
    double x = (check->n % ACROSS + 0.5) / ACROSS, y = ((double)(check->n / ACROSS) + 0.5) / ACROSS;
    check->way[check->n] = (struct traveller){
        camera_ray(&scene->camera, x * scene->camera.width, y * scene->camera.height, NULL),
        scene->camera_medium, (uint64_t)check->n};
  }
}

// Each light in its turn, however dim.
static void from_lights(struct check *check) {
  const struct scene *scene = check->scene;
  check->from = "a light";
  check->key = rng_key(rng_hash_name("media of the lights"), 0, RNG_PHOTONS);
  for (check->n = 0; check->n < RAYS; check->n++) {
    const struct light *light = &scene->light[(uint32_t)check->n % scene->n_lights];
    uint64_t path = (uint64_t)check->n;
    double u[LIGHT_U];
    struct emission emission;
    draw(check, path, VERTICES, 0, u);
    draw(check, path, VERTICES, 1, u + 2);
    light->type->emit(scene, light, u, &emission);
    check->way[check->n] =
        (struct traveller){emission.ray, photons_start_in(scene, light, &emission.ray), path};
  }
}

bool media_check(const struct scene *scene, const struct bvh *bvh, struct arena scratch,
                 struct problem *problem) {
  if (!scene_features(scene).media) return true;
  struct check check = {.scene = scene,
                        .bvh = bvh,
                        .way = arena_new(&scratch, struct traveller, RAYS),
                        .ray = arena_new(&scratch, struct ray, RAYS),
                        .hit = arena_new(&scratch, struct hit, RAYS)};
  from_camera(&check);
  bool ok = follow(&check);
  if (ok && scene->n_lights > 0) {
    from_lights(&check);
    ok = follow(&check);
  }
  return ok || problem_set(problem, "%s", check.said.text);
}
