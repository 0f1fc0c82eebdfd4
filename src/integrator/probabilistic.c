// Probabilistic progressive photon mapping (Knaus, Zwicker 2011): iterations are independent photon
// maps, each with its own radius r_i from a law that knows only i; the image is their average.
// No local statistics, any kernel.
#include "integrator/integrator.h"

#include "density/gather.h"
#include "walk/connect.h"
#include "walk/dimension.h"
#include "walk/eye.h"
#include "walk/photons.h"

#include <string.h>

// Few points see few cells; then photons elsewhere are not worth sorting.
enum { FEW_POINTS = 16 };

struct probabilistic {
  const struct measurement *measure;
  struct arena *arena;
  struct walk *walk;
  struct eye_point *point;
  uint64_t run;
  bool points_are_fixed, points_are_traced;
  struct photons photons;
  struct grid grid;
  struct gather gather;
  struct grid_seen seen;
  struct vec seen_point[FEW_POINTS];
  struct disc *disc;
  double *direct; // next-event estimation only
};

static void *probabilistic_new(const struct measurement *measure, struct arena *arena) {
  struct probabilistic *state = arena_new(arena, struct probabilistic, 1);
  state->measure = measure;
  state->arena = arena;
  state->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  state->point = arena_new(arena, struct eye_point, measure->n_points);
  state->disc = arena_new(arena, struct disc, measure->n_estimators);
  state->points_are_fixed = !measure->footprint && !measure->features.random_eye &&
                            !(measure->skip_off & SKIP_STATIC_EYE);
  if (measure->nee)
    state->direct =
        arena_new(arena, double, (long)measure->n_points * measure->features.n_channels);
  return state;
}

static void probabilistic_begin(void *data, uint64_t run) {
  struct probabilistic *state = data;
  state->run = run;
}

static void trace_eye(struct probabilistic *state) {
  const struct measurement *measure = state->measure;
  if (state->points_are_fixed && state->points_are_traced) return;
  state->walk->key = rng_key(measure->seed, state->run, RNG_EYE);
  eye_trace(state->walk, measure->pixel, measure->n_points, measure->footprint, measure->depth,
            state->point);
  state->points_are_traced = true;
}

// Radii of this iteration; returns the largest.
static double set_discs(struct probabilistic *state, uint64_t i) {
  const struct measurement *measure = state->measure;
  double largest = 0;
  for (int e = 0; e < measure->n_estimators; e++) {
    const struct estimator *estimator = &measure->estimator[e];
    double r = law_radius(estimator->law, estimator->alpha, estimator->r1, 2, i);
    state->disc[e] = disc_of(estimator->kernel, r, measure->n_emitted);
    largest = largest < r ? r : largest;
  }
  return largest;
}

static void trace_photons(struct probabilistic *state, double r) {
  const struct measurement *measure = state->measure;
  struct photon_pass pass = {measure->n_emitted, measure->depth, measure->nee ? 1 : 0};
  struct photon_filter filter = {grid_seen_keep, &state->seen};
  bool few = measure->n_points <= FEW_POINTS && !(measure->skip_off & SKIP_UNSEEN);
  if (few) {
    int n = 0;
    for (int j = 0; j < measure->n_points; j++)
      if (state->point[j].hit) state->seen_point[n++] = state->point[j].p;
    grid_seen_mark(&state->seen, state->seen_point, n, r);
  }
  state->walk->key = rng_key(measure->seed, state->run, RNG_PHOTONS);
  photons_trace(state->walk, &pass, few ? &filter : NULL, &state->photons, state->arena);
  grid_build(&state->grid, &state->photons, r, state->arena);
}

static void gather(struct probabilistic *state, double *frame) {
  const struct measurement *measure = state->measure;
  int n_channels = measure->features.n_channels;
  long stride = (long)measure->n_points * n_channels;
  for (int j = 0; j < measure->n_points; j++) {
    const struct eye_point *point = &state->point[j];
    double *out = frame + (long)j * n_channels;
    if (point->bsdf.type)
      gather_point(&state->gather, &state->photons, &state->grid, point, measure->depth,
                   state->disc, measure->n_estimators, out, stride, state->arena);
    for (int e = 0; e < measure->n_estimators; e++)
      for (int c = 0; c < n_channels; c++) out[e * stride + c] += point->emitted[c];
  }
}

// Light samples of points first..first + n - 1; the eye pass drew nothing from these pairs.
static void connect_points(struct probabilistic *state, int first, int n) {
  const struct measurement *measure = state->measure;
  struct walk *walk = state->walk;
  walk->n = n;
  for (int j = 0; j < n; j++)
    walk->path[j] = eye_path(&walk->scene->camera, measure->pixel[first + j]);
  walk_random(walk, 2, pair_of_vertex(0, VERTEX_LIGHT));
  walk_random(walk, 3, pair_of_vertex(0, VERTEX_EMITTER));
  connect_begin(walk);
  for (int j = 0; j < n; j++) {
    const struct eye_point *point = &state->point[first + j];
    if (!point->bsdf.type || point->vertex >= measure->depth) continue;
    struct connection connection = {.bsdf = &point->bsdf,
                                    .p = point->p,
                                    .primitive = point->primitive,
                                    .wo = point->wo,
                                    .owner = first + j};
    memcpy(connection.weight, point->weight, sizeof connection.weight);
    double u[2] = {walk->u[3][0][j], walk->u[3][1][j]};
    connect_add(walk, &connection, walk->u[2][0][j], u, false);
  }
  connect_finish(walk, state->direct);
}

// Direct light by next-event estimation, the same for all estimators.
static void add_direct(struct probabilistic *state, double *frame) {
  const struct measurement *measure = state->measure;
  long stride = (long)measure->n_points * measure->features.n_channels;
  memset(state->direct, 0, (size_t)stride * sizeof *state->direct);
  state->walk->key = rng_key(measure->seed, state->run, RNG_EYE);
  for (int first = 0; first < measure->n_points; first += WALK_BATCH) {
    int left = measure->n_points - first;
    connect_points(state, first, left < WALK_BATCH ? left : WALK_BATCH);
  }
  for (int e = 0; e < measure->n_estimators; e++)
    for (long k = 0; k < stride; k++) frame[e * stride + k] += state->direct[k];
}

static void probabilistic_step(void *data, uint64_t i, double *frame) {
  struct probabilistic *state = data;
  const struct measurement *measure = state->measure;
  long size = (long)measure->n_estimators * measure->n_points * measure->features.n_channels;
  memset(frame, 0, (size_t)size * sizeof *frame);
  state->walk->iteration = i;
  trace_eye(state);
  trace_photons(state, set_discs(state, i));
  gather(state, frame);
  if (measure->nee && measure->depth > 0) add_direct(state, frame);
}

const struct integrator_type integrator_probabilistic = {
    .name = "probabilistic",
    .about = "independent photon maps, radius from a global law, any kernel",
    .source = "Knaus and Zwicker 2011",
    .photons = true,
    .independent = true,
    .create = probabilistic_new,
    .begin = probabilistic_begin,
    .step = probabilistic_step,
};
