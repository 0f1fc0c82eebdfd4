// Progressive photon beams (Jarosz, Nowrouzezahrai, Thomas, Sloan, Zwicker 2011): media are
// gathered from the lines that photons flew rather than from the points where they collided,
// blurred in one dimension, so that the law is in r and the bias of iteration i as r^2; iterations
// are independent, as of `probabilistic`, whose photons in discs are what surfaces are gathered
// from.
#include "density/beam_gather.h"
#include "estimate/photon_map.h"
#include "integrator/integrator.h"

#include <string.h>

enum { FEW = 64 }; // segments; then all beams are looked at rather than sorted into a tree

struct beam_map {
  struct measurement own; // whose points are kept: segments go by them
  const struct measurement *measure;
  struct arena *arena;
  struct photon_map *map; // its surfaces, and its walk
  bool points_are_traced;
  struct eye_segments segments;
  struct beams beams;
  struct beam_tree tree;
  struct beam_gather gather;
  double *c, *r;       // [n_estimators] psi(0) in one dimension; radii on surfaces
  struct strip *strip; // [n_estimators] in media
};

static void *beams_new(const struct measurement *measure, struct arena *arena) {
  struct beam_map *state = arena_new(arena, struct beam_map, 1);
  state->own = *measure;
  state->own.keep_points = true;
  state->measure = &state->own;
  state->arena = arena;
  state->map = photon_map_new(&state->own, arena);
  state->map->beams = &state->beams;
  state->gather.left_out = measure->left_out;
  state->c = arena_new(arena, double, measure->n_estimators);
  state->r = arena_new(arena, double, measure->n_estimators);
  state->strip = arena_new(arena, struct strip, measure->n_estimators);
  for (int e = 0; e < measure->n_estimators; e++)
    state->c[e] = measure->estimator[e].kernel->constants(1).c;
  return state;
}

static void beams_begin_run(void *data, uint64_t run) {
  struct beam_map *state = data;
  state->map->run = run;
}

static void see(struct beam_map *state, uint64_t i) {
  const struct measurement *measure = state->measure;
  struct photon_map *map = state->map;
  if (measurement_is_static(measure) && state->points_are_traced) return;
  map->walk->key = rng_key(measure->seed, map->run, RNG_EYE);
  walk_begin(map->walk, measure->seed, map->run, i);
  eye_segments_trace(&state->segments, map->walk, measure->pixel, measure->n_points,
                     measure->footprint, measure->depth, map->point, state->arena);
  tile_take(&map->tile, map->point, 0, measure->n_points);
  state->points_are_traced = true;
}

// Radii of this iteration: on surfaces in two dimensions, in media in one. Returns the largest on
// surfaces.
static double set_radii(struct beam_map *state, uint64_t i) {
  const struct measurement *measure = state->measure;
  double largest = 0;
  for (int e = 0; e < measure->n_estimators; e++) {
    const struct estimator *estimator = &measure->estimator[e];
    double r =
        law_radius(estimator->law, estimator->alpha, estimator_r1(estimator, IN_VOLUME), 1, i);
    state->strip[e] = strip_of(estimator->kernel, state->c[e], r, measure->n_emitted);
    state->r[e] =
        law_radius(estimator->law, estimator->alpha, estimator_r1(estimator, ON_SURFACE), 2, i);
    largest = largest < state->r[e] ? state->r[e] : largest;
  }
  return largest;
}

// Random transmittance has numbers of its own in each (run, pixel); in the pixel they go by beam
// and segment.
static struct rng_key crossings_key(const struct beam_map *state, int point) {
  const struct measurement *measure = state->measure;
  const struct camera *camera = &measure->scene->camera;
  uint64_t pixels = (uint64_t)camera->width * (uint64_t)camera->height;
  uint64_t pixel = eye_path(camera, measure->pixel[point]);
  return rng_key(measure->seed, state->map->run * pixels + pixel, RNG_CROSSINGS);
}

static void gather_media(struct beam_map *state, double *frame) {
  const struct measurement *measure = state->measure;
  const struct eye_segments *segments = &state->segments;
  int n_channels = measure->features.n_channels;
  bool few = segments->count <= FEW;
  if (!few) beam_tree_build(&state->tree, &state->beams, state->arena);
  for (int64_t k = 0; k < segments->count; k++) {
    const struct eye_segment *segment = &segments->segment[k];
    state->map->walk->key = crossings_key(state, segment->point);
    beam_gather_segment(&state->gather, state->map->walk, &state->beams, few ? NULL : &state->tree,
                        segment, measure->depth, state->strip, measure->n_estimators,
                        frame + (long)segment->point * n_channels,
                        (long)measure->n_points * n_channels, state->arena);
  }
}

static void beams_step(void *data, uint64_t i, double *frame) {
  struct beam_map *state = data;
  const struct measurement *measure = state->measure;
  memset(frame, 0, (size_t)photon_map_frame(measure) * sizeof *frame);
  see(state, i);
  double largest[POINT_KINDS] = {[ON_SURFACE] = set_radii(state, i)};
  photon_map_emit(state->map, i, largest);
  for (int j = 0; j < measure->n_points; j++)
    photon_map_gather(state->map, j, state->r, NULL, frame);
  gather_media(state, frame);
  photon_map_add_seen(state->map, i, frame);
}

static int64_t bytes(const void *data) {
  const struct beam_map *state = data;
  return photon_map_bytes(state->map) + beams_bytes(&state->beams) + beam_tree_bytes(&state->tree);
}

const struct integrator_type integrator_beams = {
    .name = "beams",
    .about = "media by photon beams, radius in one dimension; surfaces as `probabilistic`",
    .source = "Jarosz et al. 2011",
    .photons = true,
    .independent = true,
    .only_photons = true,
    .volume_dimension = 1,
    .create = beams_new,
    .begin = beams_begin_run,
    .step = beams_step,
    .bytes = bytes,
};
