// Probabilistic progressive photon mapping (Knaus, Zwicker 2011): iterations are independent photon
// maps, each with its own radius r_i from a law that knows only i, times a reference radius of the
// point; the image is their average. No local statistics, any kernel. Points on surfaces and in
// media have a radius each, by the same law in r^2 and in r^3.
#include "estimate/reference_radius.h"
#include "integrator/integrator.h"

#include <string.h>

struct probabilistic {
  const struct measurement *measure;
  struct photon_map *map;
  bool points_are_fixed, points_are_traced;
  struct radii radii;
  double *r[POINT_KINDS]; // [n_estimators] of this iteration, in reference radii
};

static void *probabilistic_new(const struct measurement *measure, struct arena *arena) {
  struct probabilistic *state = arena_new(arena, struct probabilistic, 1);
  state->measure = measure;
  state->map = photon_map_new(measure, arena);
  for (int kind = 0; kind < measurement_kinds(measure); kind++)
    state->r[kind] = arena_new(arena, double, measure->n_estimators);
  state->radii = radii_new(state->map, arena);
  state->points_are_fixed = measurement_is_static(measure);
  return state;
}

static void probabilistic_begin(void *data, uint64_t run) {
  struct probabilistic *state = data;
  state->map->run = run;
}

// Radii of this iteration at points of one kind, in reference radii; returns the largest.
static double set_radii(struct probabilistic *state, enum point_kind kind, uint64_t i) {
  const struct measurement *measure = state->measure;
  double largest = 0, *r = state->r[kind];
  for (int e = 0; e < measure->n_estimators; e++) {
    const struct estimator *estimator = &measure->estimator[e];
    r[e] = law_radius(estimator->law, estimator->alpha, estimator_r1(estimator, kind),
                      point_dimension[kind], i);
    largest = largest < r[e] ? r[e] : largest;
  }
  return largest;
}

static void emit(struct probabilistic *state, uint64_t i) {
  double largest[POINT_KINDS] = {0};
  for (int kind = 0; kind < measurement_kinds(state->measure); kind++) {
    largest[kind] = set_radii(state, (enum point_kind)kind, i);
    if (!state->radii.global) largest[kind] = INFINITY;
  }
  photon_map_emit(state->map, i, largest);
}

static void probabilistic_step(void *data, uint64_t i, double *frame) {
  struct probabilistic *state = data;
  struct photon_map *map = state->map;
  memset(frame, 0, (size_t)photon_map_frame(state->measure) * sizeof *frame);
  bool sees = !state->points_are_fixed || !state->points_are_traced;
  if (sees) photon_map_see(map, i);
  emit(state, i);
  for (int first = 0; photon_map_tile(map, first); first += map->tile.n) {
    if (sees) radii_set(&state->radii);
    for (int j = first; j < first + map->tile.n; j++) {
      const double *r = state->r[eye_point_kind(tile_point(&map->tile, j))];
      photon_map_gather(map, j, radii_scale(&state->radii, j, r), NULL, frame);
    }
    photon_map_add_seen(map, i, frame);
  }
  state->points_are_traced = true;
}

static int64_t probabilistic_bytes(const void *data) {
  const struct probabilistic *state = data;
  return photon_map_bytes(state->map) + radii_bytes(&state->radii);
}

const struct integrator_type integrator_probabilistic = {
    .name = "probabilistic",
    .about = "independent photon maps, radius from a global law, any kernel",
    .source = "Knaus and Zwicker 2011",
    .photons = true,
    .independent = true,
    .takes_reference = true,
    .volume_dimension = 3,
    .create = probabilistic_new,
    .begin = probabilistic_begin,
    .step = probabilistic_step,
    .bytes = probabilistic_bytes,
};
