#include "tests/bench/rays.h"

#include "bvh/bvh.h"
#include "numeric/rng.h"
#include "walk/eye.h"
#include "walk/light.h"
#include "walk/photons.h"

#include <string.h>

static struct rays rays_new(int n, struct arena *arena) {
  return (struct rays){arena_new(arena, struct ray, n), arena_new(arena, struct hit, n), 0};
}

static double rounded(double x) { return (double)(float)x; }
static struct vec vec_rounded(struct vec v) {
  return vec(rounded(v.x), rounded(v.y), rounded(v.z));
}

static void add(struct rays *rays, const struct ray *ray) {
  struct ray *out = &rays->ray[rays->n++];
  *out = (struct ray){vec_rounded(ray->o), vec_rounded(ray->d), rounded(ray->t_max), ray->leaving};
}

static struct walk *walk_of(const struct bench_scene *scene, enum rng_purpose purpose,
                            struct arena *arena) {
  struct walk *walk = walk_new(&scene->scene, scene->bvh, scene_features(&scene->scene), arena);
  walk->key = rng_key(1, 1, purpose);
  walk_begin(walk, 1, 1, 1);
  return walk;
}

static struct rays finished(const struct bench_scene *scene, struct rays rays) {
  bvh_closest(scene->bvh, rays.ray, rays.hit, rays.n);
  return rays;
}

struct rays rays_of_camera(const struct bench_scene *scene, struct arena *arena) {
  struct rays rays = rays_new(scene->n_pixels, arena);
  struct walk *walk = walk_of(scene, RNG_EYE, arena);
  for (int first = 0; first < scene->n_pixels; first += WALK_BATCH) {
    int left = scene->n_pixels - first, n = left < WALK_BATCH ? left : WALK_BATCH;
    for (int j = 0; j < n; j++)
      walk->path[j] = eye_path(&scene->scene.camera, scene->pixel[first + j]);
    eye_rays(walk, scene->pixel + first, n, true);
    for (int j = 0; j < n; j++) add(&rays, &walk->ray[j]);
  }
  return finished(scene, rays);
}

static void scatter(struct walk *walk) {
  int alive = 0;
  walk_drop_escaped(walk);
  walk_vertex_random(walk);
  for (int j = 0; j < walk->n; j++) {
    struct surface surface;
    scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
    struct bsdf bsdf;
    walk_bsdf(walk, j, &surface, &bsdf);
    if (bsdf.type && walk_scatter(walk, j, &surface, &bsdf)) walk_move(walk, alive++, j);
  }
  walk->n = alive;
}

struct rays rays_of_photons(const struct bench_scene *scene, int n, struct arena *arena) {
  struct rays rays = rays_new(n, arena);
  struct walk *walk = walk_of(scene, RNG_PHOTONS, arena);
  for (uint64_t first = 0; rays.n < n; first += WALK_BATCH) {
    walk->n = WALK_BATCH;
    for (int j = 0; j < walk->n; j++) walk->path[j] = first + (uint64_t)j;
    photons_emit(walk);
    for (walk->vertex = 0; walk->n > 0 && rays.n < n; walk->vertex++) {
      for (int j = 0; j < walk->n && rays.n < n; j++) add(&rays, &walk->ray[j]);
      walk_trace_through(walk);
      scatter(walk);
    }
  }
  return finished(scene, rays);
}

struct rays rays_to_lights(const struct bench_scene *scene, const struct rays *from,
                           struct arena *arena) {
  struct rays rays = rays_new(from->n, arena);
  for (int j = 0; j < from->n; j++) {
    const struct ray *ray = &from->ray[j];
    if (from->hit[j].primitive == PRIMITIVE_NONE) continue;
    struct surface surface;
    scene_surface(&scene->scene, ray, from->hit[j], &surface);
    struct light_sample sample;
    double u[2], choice, unused;
    uint64_t path = (uint64_t)j;
    rng_fill(rng_key(1, 1, RNG_TEST), 1, &path, 1, 0, &u[0], &u[1]);
    rng_fill(rng_key(1, 1, RNG_TEST), 1, &path, 1, 1, &choice, &unused);
    const struct light *light = light_choose(&scene->scene, choice);
    if (!light->type->sample(&scene->scene, light, surface.p, u, &sample)) continue;
    if (vec_dot(sample.wi, surface.ng) * vec_dot(ray->d, surface.ng) >= 0) continue;
    struct ray shadow = {surface.p, sample.wi, 0.999 * sample.distance, surface.primitive};
    add(&rays, &shadow);
  }
  return finished(scene, rays);
}

static const struct shape *largest_shape(const struct scene *scene) {
  const struct shape *largest = &scene->shape[0];
  for (uint32_t k = 1; k < scene->n_shapes; k++)
    if (scene->shape[k].count > largest->count) largest = &scene->shape[k];
  return largest;
}

static struct vec vertex_of(const struct scene *scene, const struct shape *shape, uint32_t triangle,
                            int corner) {
  const float *p = scene->position[scene->triangle[shape->local + triangle][corner]];
  return vec((double)p[0], (double)p[1], (double)p[2]);
}

static struct vec middle_of(const struct scene *scene, const struct shape *shape) {
  struct vec sum = vec(0, 0, 0);
  for (uint32_t k = 0; k < shape->count; k++)
    sum = vec_along(sum, vertex_of(scene, shape, k, 0), 1.0 / shape->count);
  return sum;
}

// Every other one at a vertex.
struct rays rays_at_edges(const struct bench_scene *of, int n, struct arena *arena) {
  const struct scene *scene = &of->scene;
  const struct shape *shape = largest_shape(scene);
  struct vec middle = middle_of(scene, shape);
  struct rays rays = rays_new(n, arena);
  struct rng_key key = rng_key(2, 1, RNG_TEST);
  for (uint64_t j = 0; j < (uint64_t)n; j++) {
    double pick, along, x, y;
    rng_fill(key, 1, &j, 1, 0, &pick, &along);
    rng_fill(key, 1, &j, 1, 1, &x, &y);
    uint32_t triangle = (uint32_t)(pick * shape->count);
    int corner = (int)(3 * x);
    struct vec a = vertex_of(scene, shape, triangle, corner);
    struct vec edge = vec_sub(vertex_of(scene, shape, triangle, (corner + 1) % 3), a);
    struct vec o = vec_add(middle, vec(0.01 * x, 0.01 * y, 0.01 * pick));
    struct vec d = vec_sub(vec_along(a, edge, j % 2 ? along : 0), o);
    add(&rays, &(struct ray){o, d, INFINITY, PRIMITIVE_NONE});
  }
  return finished(of, rays);
}

bool rays_hit_largest(const struct bench_scene *of, uint32_t primitive) {
  const struct shape *shape = largest_shape(&of->scene);
  return primitive >= shape->first && primitive - shape->first < shape->count;
}

void rays_check(const struct bench_scene *scene, const struct rays *rays, const char *name) {
  enum { MOST = 4096 };
  static struct hit hit[MOST];
  static struct ray ray[MOST];
  static unsigned char blocked[MOST];
  double afford = 1e7 / scene->scene.n_primitives;
  int n = afford < 8 ? 8 : afford < MOST ? (int)afford : MOST;
  n = n < rays->n ? n : rays->n;
  for (int j = 0; j < n; j++) ray[j] = rays->ray[(long)j * rays->n / n];
  bvh_closest_brute_force(&scene->scene, ray, hit, n);
  bvh_any(scene->bvh, ray, blocked, n);
  for (int j = 0; j < n; j++) {
    const struct hit *tree = &rays->hit[(long)j * rays->n / n];
    bench_check(tree->t == hit[j].t && tree->primitive == hit[j].primitive,
                "the tree's hits are not those of brute force", name);
    bench_check(blocked[j] == (hit[j].primitive != PRIMITIVE_NONE),
                "any hit and the closest hit differ", name);
  }
}
