// Path tracing with next-event estimation, combined with the material's sampling by the balance
// heuristic (Veach, Guibas 1995): the unbiased reference. One sample a point and iteration.
#include "integrator/integrator.h"

#include "walk/connect.h"
#include "walk/dimension.h"
#include "walk/eye.h"

#include <string.h>

struct path {
  const struct measurement *measure;
  struct walk *walk;
  uint64_t run;
};

static void *path_new(const struct measurement *measure, struct arena *arena) {
  struct path *state = arena_new(arena, struct path, 1);
  state->measure = measure;
  state->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  walk_delay_roulette(state->walk, arena);
  return state;
}

static void path_begin(void *data, uint64_t run) {
  struct path *state = data;
  state->run = run;
}

// Adds weight * throughput * rgb to the pixel of path j.
static void add(const struct path *state, int j, double weight, const double rgb[3],
                double *frame) {
  const struct walk *walk = state->walk;
  if (walk->kind[j] & state->measure->left_out) return;
  for (int c = 0; c < walk->n_channels; c++)
    frame[walk->owner[j] * walk->n_channels + c] += weight * walk->throughput[c][j] * rgb[c];
}

// Emission met by path j: all of it where next-event estimation could not have found it.
static void add_emission(const struct path *state, int j, const struct surface *surface,
                         double *frame) {
  const struct walk *walk = state->walk;
  if (walk->scene->shape[surface->shape].light == LIGHT_NONE) return;
  double emitted[3], weight = 1;
  struct vec d = walk->ray[j].d;
  eye_emitted(walk->scene, surface, vec_scale(d, -1), emitted);
  if (walk->pdf[j] > 0)
    weight = connect_mis_weight(walk->scene, surface, walk->from[j], d, walk->pdf[j]);
  add(state, j, weight, emitted, frame);
}

// What the paths that hit nothing see.
static void add_background(const struct path *state, double *frame) {
  const struct walk *walk = state->walk;
  const struct scene *scene = walk->scene;
  for (int j = 0; j < walk->n; j++) {
    if (!walk_escaped(walk, j)) continue;
    for (uint32_t k = 0; k < scene->n_infinite; k++) {
      const struct light *light = &scene->light[scene->infinite[k]];
      struct vec d = walk->ray[j].d;
      double rgb[3], weight = 1;
      light->type->background(scene, light, d, rgb);
      if (walk->pdf[j] > 0)
        weight = connect_mis_weight_background(scene, light, walk->from[j], d, walk->pdf[j]);
      add(state, j, weight, rgb, frame);
    }
  }
}

// To a light, from a point of path j whose bsdf, place and weight are given.
static inline void connect(const struct path *state, int j, struct connection *from) {
  struct walk *walk = state->walk;
  if (light_path_after(walk->kind[j], false) & state->measure->left_out) return;
  from->wo = vec_scale(walk->ray[j].d, -1);
  from->owner = walk->owner[j];
  if (walk->medium) {
    from->medium = walk->medium[j];
    from->path = walk->path[j];
  }
  if (bsdf_delta_probability(from->bsdf, from->wo, TRANSPORT_RADIANCE) >= 1) return;
  double u[2] = {walk->u[3][0][j], walk->u[3][1][j]};
  connect_add(walk, from, walk->u[2][0][j], u, true);
}

static void connect_surface(const struct path *state, int j, const struct bsdf *bsdf,
                            struct vec p) {
  const struct walk *walk = state->walk;
  struct connection from = {.bsdf = bsdf, .p = p, .primitive = walk->hit[j].primitive};
  for (int c = 0; c < walk->n_channels; c++) from.weight[c] = walk->throughput[c][j];
  connect(state, j, &from);
}

// At a facet that emits nothing. True: the path goes on.
static bool meet_facet(const struct path *state, int j) {
  struct bsdf bsdf;
  walk_facet_bsdf(state->walk, j, walk_facet(state->walk, j), &bsdf);
  connect_surface(state, j, &bsdf, walk_point(state->walk, j));
  return walk_scatter_facet(state->walk, j);
}

// At a surface. True: the path goes on.
static bool meet_surface(const struct path *state, int j, bool last, double *frame) {
  struct walk *walk = state->walk;
  const struct shape *facet = last ? NULL : walk_facet(walk, j);
  if (facet && facet->light == LIGHT_NONE) return meet_facet(state, j);
  struct surface surface;
  scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
  add_emission(state, j, &surface, frame);
  if (last) return false;
  struct bsdf bsdf;
  walk_bsdf(walk, j, &surface, &bsdf);
  if (!bsdf.type) return false;
  connect_surface(state, j, &bsdf, surface.p);
  return walk_scatter(walk, j, &surface, &bsdf);
}

// The same in a medium, whose emission next-event estimation does not look for.
static bool meet_medium(const struct path *state, int j, bool last, double *frame) {
  struct walk *walk = state->walk;
  const struct collision *collision = &walk->collision[j];
  int n = walk->n_channels;
  if (!(walk->kind[j] & state->measure->left_out))
    for (int c = 0; c < n; c++)
      frame[walk->owner[j] * n + c] += collision->weight[c] * collision->at.emission[c];
  if (last) return false;
  struct bsdf phase = medium_bsdf(&walk->scene->medium[walk->medium[j]]);
  struct connection from = {.bsdf = &phase, .p = walk_point(walk, j), .primitive = PRIMITIVE_NONE};
  for (int c = 0; c < n; c++) from.weight[c] = collision->weight[c] * collision->at.sigma_s[c];
  connect(state, j, &from);
  return walk_scatter_in_medium(walk, j);
}

// At every vertex: add what it emits, connect it to a light, scatter.
static void meet(const struct path *state, double *frame) {
  struct walk *walk = state->walk;
  bool last = walk->vertex >= state->measure->depth;
  int alive = 0;
  if (!last) {
    walk_vertex_random(walk);
    if (walk->scene->n_lights > 1 && !walk->features.random_materials)
      walk_random(walk, 2, pair_of_vertex(walk->vertex, VERTEX_LIGHT));
    walk_random(walk, 3, pair_of_vertex(walk->vertex, VERTEX_EMITTER));
  }
  connect_begin(walk);
  for (int first = 0; first < walk->n; first += FACETS) {
    int on[FACETS], n = 0, count = walk_sample_facets(walk, first);
    for (int j = first; j < first + count; j++) {
      bool lives = walk_collided(walk, j) ? meet_medium(state, j, last, frame)
                                          : meet_surface(state, j, last, frame);
      on[n] = j;
      n += lives && !light_path_ends(walk->kind[j], state->measure->left_out);
    }
    walk_pack(walk, alive, on, n);
    alive += n;
  }
  connect_finish(walk, frame);
  walk->n = alive;
}

// Replicas of a pixel are told apart by the path number.
static uint64_t path_number(const struct measurement *measure, int j) {
  const struct camera *camera = &measure->scene->camera;
  uint64_t replica = (uint64_t)(j % measure->n_replicas);
  uint64_t pixels = (uint64_t)camera->width * (uint64_t)camera->height;
  return eye_path(camera, measure->pixel[j]) + replica * pixels;
}

static void path_step(void *data, uint64_t i, double *frame) {
  struct path *state = data;
  const struct measurement *measure = state->measure;
  struct walk *walk = state->walk;
  long size = (long)measure->n_points * walk->n_channels;
  memset(frame, 0, (size_t)size * sizeof *frame);
  walk->key = rng_key(measure->seed, state->run, RNG_EYE);
  walk_begin(walk, measure->seed, state->run, i);
  for (int first = 0; first < measure->n_points; first += WALK_BATCH) {
    int n = measure->n_points - first < WALK_BATCH ? measure->n_points - first : WALK_BATCH;
    for (int j = 0; j < n; j++) walk->path[j] = path_number(measure, first + j);
    eye_rays(walk, measure->pixel + first, n, measure->footprint);
    double *out = frame + (long)first * walk->n_channels;
    for (walk->vertex = 0; walk->n > 0 && walk->vertex <= measure->depth; walk->vertex++) {
      walk_trace_through(walk);
      if (walk->features.background) add_background(state, out);
      walk_drop_escaped(walk);
      meet(state, out);
    }
  }
  measurement_copy(measure, frame);
}

const struct integrator_type integrator_path = {
    .name = "path",
    .about = "path tracing with next-event estimation and multiple importance sampling, unbiased",
    .source = "Kajiya 1986; Veach and Guibas 1995",
    .photons = false,
    .independent = true,
    .create = path_new,
    .begin = path_begin,
    .step = path_step,
};
