// Photon mapping (Jensen 1996): every iteration is one photon map, and its estimates are over a
// fixed radius or over the k nearest photons, whose farthest sets the radius and is not counted
// (density/gather.h). The average over iterations is what more maps give: the variance falls as 1 /
// N, the bias stays. Less of it needs a smaller radius and so more photons in one map, more memory.
#include "estimate/photon_map.h"
#include "integrator/integrator.h"

#include <string.h>

struct photonmap {
  struct photon_map *map;
  bool points_are_traced;
  double *r[POINT_KINDS]; // [n_estimators], 0 of those that take the nearest: no disc
  int *k;                 // [n_estimators], 0 of those that have a radius
  bool any_k;
};

static double *radii_of(const struct measurement *measure, enum point_kind kind,
                        struct arena *arena) {
  double *r = arena_new(arena, double, measure->n_estimators);
  for (int e = 0; e < measure->n_estimators; e++)
    r[e] = measure->estimator[e].k ? 0 : estimator_r1(&measure->estimator[e], kind);
  return r;
}

static void *photonmap_new(const struct measurement *measure, struct arena *arena) {
  struct photonmap *state = arena_new(arena, struct photonmap, 1);
  state->map = photon_map_new(measure, arena);
  state->k = arena_new(arena, int, measure->n_estimators);
  for (int kind = 0; kind < measurement_kinds(measure); kind++)
    state->r[kind] = radii_of(measure, (enum point_kind)kind, arena);
  for (int e = 0; e < measure->n_estimators; e++) {
    state->k[e] = measure->estimator[e].k;
    state->any_k |= state->k[e] > 0;
  }
  return state;
}

static void photonmap_begin(void *data, uint64_t run) {
  struct photonmap *state = data;
  state->map->run = run;
}

static void emit(struct photonmap *state, uint64_t i) {
  const struct measurement *measure = state->map->measure;
  double largest[POINT_KINDS] = {0};
  for (int kind = 0; kind < measurement_kinds(measure); kind++) {
    const double *r = state->r[kind];
    for (int e = 0; e < measure->n_estimators; e++)
      largest[kind] = largest[kind] < r[e] ? r[e] : largest[kind];
    if (state->any_k) largest[kind] = INFINITY;
  }
  photon_map_emit(state->map, i, largest);
}

static void photonmap_step(void *data, uint64_t i, double *frame) {
  struct photonmap *state = data;
  struct photon_map *map = state->map;
  const struct measurement *measure = map->measure;
  memset(frame, 0, (size_t)photon_map_frame(measure) * sizeof *frame);
  if (!measurement_is_static(measure) || !state->points_are_traced) photon_map_see(map, i);
  state->points_are_traced = true;
  emit(state, i);
  for (int first = 0; photon_map_tile(map, first); first += map->tile.n) {
    for (int j = first; j < first + map->tile.n; j++) {
      photon_map_gather(map, j, state->r[eye_point_kind(tile_point(&map->tile, j))], NULL, frame);
      if (state->any_k) photon_map_nearest(map, j, state->k, frame);
    }
    photon_map_add_seen(map, i, frame);
  }
}

static int64_t photonmap_bytes(const void *data) {
  return photon_map_bytes(((const struct photonmap *)data)->map);
}

const struct integrator_type integrator_photonmap = {
    .name = "photonmap",
    .about = "one photon map an iteration, over a fixed radius or the k nearest photons",
    .source = "Jensen 1996",
    .law = "fixed",
    .photons = true,
    .independent = true,
    .takes_k = true,
    .fixed = true,
    .volume_dimension = 3,
    .create = photonmap_new,
    .begin = photonmap_begin,
    .step = photonmap_step,
    .bytes = photonmap_bytes,
};
