// Light tracing (Arvo 1986; Dutre, Lafortune, Willems 1993): paths from the lights; every surface
// they meet is connected to the camera and seen in all pixels whose filter covers the place. A
// second opinion without bias. What is seen in a mirror or through clear glass no connection finds:
// it is left out, but for lights themselves (L S* E), which eye paths add. A pixel is the integral
// of filter density times radiance over the film, so a photon of flux phi brings phi f times the
// film's pixels^2 per area of the surface, times the density.
#include "integrator/integrator.h"

#include "scene/camera.h"
#include "walk/connect.h"
#include "walk/dimension.h"
#include "walk/eye.h"
#include "walk/photons.h"

#include <string.h>

enum { NOWHERE = -1 };

struct mark { // a connection's place on the film
  double x, y;
};

struct light_tracer {
  const struct measurement *measure;
  struct walk *walk;
  uint64_t run;
  struct eye_point *point; // [WALK_BATCH]
  struct camera_finder finder;
  int *first, *next; // points by pixel, hashed: [mask + 1] the first of each chain; [n_points]
  uint32_t mask;
  struct mark *mark; // [WALK_BATCH] of the connections
  double *seen;      // [WALK_BATCH * n_channels] what arrives of each
  int n_marks;
};

// ---- which points a place on the film belongs to ----

static uint32_t bucket_of(const struct light_tracer *state, int x, int y) {
  uint32_t pixel = (uint32_t)y * (uint32_t)state->measure->scene->camera.width + (uint32_t)x;
  return (pixel ^ pixel >> 16) & state->mask; // neighbours in a row never collide
}

static void map_points(struct light_tracer *state, struct arena *arena) {
  const struct measurement *measure = state->measure;
  uint32_t size = 1;
  while (size < (uint32_t)measure->n_points) size *= 2;
  state->mask = size - 1;
  state->first = arena_new(arena, int, size);
  state->next = arena_new(arena, int, measure->n_points);
  for (uint32_t k = 0; k < size; k++) state->first[k] = NOWHERE;
  for (int j = 0; j < measure->n_points; j++) {
    uint32_t bucket = bucket_of(state, measure->pixel[j].x, measure->pixel[j].y);
    state->next[j] = state->first[bucket];
    state->first[bucket] = j;
  }
}

// Pixels lo[k] .. hi[k] of each axis: those whose filter covers the place.
struct cover {
  int lo[2], hi[2];
};

static struct cover cover_of(const struct light_tracer *state, struct mark at) {
  const struct camera *camera = &state->measure->scene->camera;
  const double *radius = state->measure->scene->filter.radius;
  double place[2] = {at.x, at.y}, most[2] = {camera->width - 1.0, camera->height - 1.0};
  struct cover cover;
  for (int k = 0; k < 2; k++) {
    double lo = -floor(-(place[k] - 0.5 - radius[k])), hi = floor(place[k] - 0.5 + radius[k]);
    bool some = lo <= most[k] && hi >= 0; // also false for what is not a number
    cover.lo[k] = some && lo > 0 ? (int)lo : 0;
    cover.hi[k] = !some ? -1 : hi < most[k] ? (int)hi : (int)most[k];
  }
  return cover;
}

// The measured point at a pixel, from `j` of its chain on.
static int point_at(const struct light_tracer *state, int j, int x, int y) {
  const struct pixel *pixel = state->measure->pixel;
  while (j != NOWHERE && (pixel[j].x != x || pixel[j].y != y)) j = state->next[j];
  return j;
}

static int first_at(const struct light_tracer *state, int x, int y) {
  return point_at(state, state->first[bucket_of(state, x, y)], x, y);
}

static bool is_measured(const struct light_tracer *state, struct mark at) {
  struct cover cover = cover_of(state, at);
  for (int y = cover.lo[1]; y <= cover.hi[1]; y++)
    for (int x = cover.lo[0]; x <= cover.hi[0]; x++)
      if (first_at(state, x, y) != NOWHERE) return true;
  return false;
}

static void add_at(const struct light_tracer *state, struct mark at, const double *value,
                   double *frame) {
  const struct filter *filter = &state->measure->scene->filter;
  int n_channels = state->walk->n_channels;
  struct cover cover = cover_of(state, at);
  for (int y = cover.lo[1]; y <= cover.hi[1]; y++) {
    double in_y = filter->type->density(filter, 1, at.y - (y + 0.5));
    for (int x = cover.lo[0]; x <= cover.hi[0]; x++) {
      double weight = in_y * filter->type->density(filter, 0, at.x - (x + 0.5));
      for (int j = first_at(state, x, y); j != NOWHERE; j = point_at(state, state->next[j], x, y))
        for (int c = 0; c < n_channels; c++) frame[(long)j * n_channels + c] += weight * value[c];
    }
  }
}

// ---- paths from the lights ----

// What a photon at a surface brings to the film, before visibility. False: nothing.
static bool brings(const struct light_tracer *state, int j, const struct bsdf *bsdf,
                   const struct sight *sight, double value[3]) {
  const struct walk *walk = state->walk;
  struct vec wo = vec_scale(sight->d, -1), wi = vec_scale(walk->ray[j].d, -1);
  double f[3];
  bsdf_value(bsdf, wo, wi, TRANSPORT_RADIANCE, f);
  double share = bsdf_photon_factor(bsdf, wi) * fabs(vec_dot(wo, bsdf->ng)) * sight->density /
                 (double)state->measure->n_emitted;
  bool any = false;
  for (int c = 0; c < walk->n_channels; c++) {
    value[c] = walk->throughput[c][j] * f[c] * share;
    any = any || value[c] != 0;
  }
  return any;
}

static void connect(struct light_tracer *state, int j, const struct surface *surface,
                    const struct bsdf *bsdf) {
  struct walk *walk = state->walk;
  if (walk->kind[j] & state->measure->left_out) return;
  double u[2] = {walk->u[3][0][j], walk->u[3][1][j]}, value[3];
  struct sight sight;
  if (!camera_find_point(&state->finder, surface->p, u, &sight)) return;
  struct mark mark = {sight.x, sight.y};
  if (!is_measured(state, mark) || !brings(state, j, bsdf, &sight, value)) return;
  struct ray ray = {surface->p, vec_scale(sight.d, -1), INFINITY, surface->primitive};
  connect_ray(walk, &ray, sight.distance, value, state->n_marks);
  state->mark[state->n_marks++] = mark;
}

// At every hit: connect to the camera, then scatter.
static void meet(struct light_tracer *state, double *frame) {
  struct walk *walk = state->walk;
  bool last = walk->vertex + 1 >= state->measure->depth && !(state->measure->skip_off & SKIP_LAST);
  int alive = 0;
  walk_vertex_random(walk);
  walk_random(walk, 3, pair_of_vertex(walk->vertex, VERTEX_EMITTER)); // here: where on the lens
  connect_begin(walk);
  state->n_marks = 0;
  for (int j = 0; j < walk->n; j++) {
    struct surface surface;
    scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
    struct bsdf bsdf;
    walk_bsdf(walk, j, &surface, &bsdf);
    if (!bsdf.type) continue;
    connect(state, j, &surface, &bsdf);
    if (!last && walk_scatter(walk, j, &surface, &bsdf) &&
        !light_path_ends(walk->kind[j], state->measure->left_out))
      walk_move(walk, alive++, j);
  }
  walk->n = alive;
  memset(state->seen, 0, (size_t)(state->n_marks * walk->n_channels) * sizeof *state->seen);
  connect_finish(walk, state->seen);
  for (int k = 0; k < state->n_marks; k++)
    add_at(state, state->mark[k], state->seen + k * walk->n_channels, frame);
}

static void trace_lights(struct light_tracer *state, double *frame) {
  const struct measurement *measure = state->measure;
  struct walk *walk = state->walk;
  walk->key = rng_key(measure->seed, state->run, RNG_PHOTONS);
  for (uint64_t first = 0; first < measure->n_emitted; first += WALK_BATCH) {
    uint64_t left = measure->n_emitted - first;
    walk->n = left < WALK_BATCH ? (int)left : WALK_BATCH;
    for (int j = 0; j < walk->n; j++) walk->path[j] = first + (uint64_t)j;
    photons_emit(walk);
    for (walk->vertex = 0; walk->n > 0 && walk->vertex < measure->depth; walk->vertex++) {
      walk_trace_through(walk);
      walk_drop_escaped(walk);
      meet(state, frame);
    }
  }
}

// ---- lights seen ----

static void add_emitted(struct light_tracer *state, double *frame) {
  const struct measurement *measure = state->measure;
  int n_channels = state->walk->n_channels;
  state->walk->key = rng_key(measure->seed, state->run, RNG_EYE);
  for (int first = 0; first < measure->n_points; first += WALK_BATCH) {
    int left = measure->n_points - first, n = left < WALK_BATCH ? left : WALK_BATCH;
    eye_trace(state->walk, measure->pixel + first, n, true, measure->depth, state->point);
    for (int j = 0; j < n; j++)
      for (int c = 0; c < n_channels; c++)
        frame[(long)(first + j) * n_channels + c] += state->point[j].emitted[c];
  }
}

// ---- the row ----

static void *light_new(const struct measurement *measure, struct arena *arena) {
  struct light_tracer *state = arena_new(arena, struct light_tracer, 1);
  state->measure = measure;
  state->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  state->point = arena_new(arena, struct eye_point, WALK_BATCH);
  state->mark = arena_new(arena, struct mark, WALK_BATCH);
  state->seen = arena_new(arena, double, WALK_BATCH * state->walk->n_channels);
  map_points(state, arena);
  return state;
}

static void light_begin(void *data, uint64_t run) {
  struct light_tracer *state = data;
  state->run = run;
}

static void light_step(void *data, uint64_t i, double *frame) {
  struct light_tracer *state = data;
  const struct measurement *measure = state->measure;
  memset(frame, 0, (size_t)measure->n_points * (size_t)state->walk->n_channels * sizeof *frame);
  walk_begin(state->walk, measure->seed, state->run, i);
  state->finder = camera_finder(&state->walk->scene->camera);
  if (measure->left_out != (LIGHT_PATH_ALL & ~LIGHT_PATH_EMITTED)) trace_lights(state, frame);
  if (!(measure->left_out & LIGHT_PATH_EMITTED)) add_emitted(state, frame);
  measurement_copy(measure, frame);
}

static bool light_accepts(const struct scene *scene, bool footprint, struct problem *problem) {
  if (scene_features(scene).media)
    return problem_set(problem,
                       "%s: integrator light connects surfaces only, and the scene has "
                       "participating media: take path, sppm or probabilistic",
                       scene->path);
  if (!scene->camera.type->find)
    return problem_set(problem,
                       "%s: integrator light cannot tell where a %s camera sees a point; use path",
                       scene->path, scene->camera.type->name);
  return footprint ||
         problem_set(problem,
                     "%s: integrator light measures areas of the film, no path meets the very "
                     "centre of a pixel; use pixel: footprint, or another integrator",
                     scene->path);
}

const struct integrator_type integrator_light = {
    .name = "light",
    .about =
        "light tracing, unbiased; leaves out what is seen in mirrors and clear glass, but lights",
    .source = "Arvo 1986; Dutre, Lafortune and Willems 1993",
    .photons = false,
    .independent = true,
    .blind_to_mirrored = true,
    .accepts = light_accepts,
    .create = light_new,
    .begin = light_begin,
    .step = light_step,
};
