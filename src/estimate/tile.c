#include "estimate/tile.h"

#include "walk/connect.h"
#include "walk/dimension.h"

#include <string.h>

struct tile tile_new(const struct measurement *measure, struct walk *walk, struct arena *arena) {
  struct tile tile = {.measure = measure, .walk = walk};
  tile.gather.left_out = measure->left_out;
  tile.disc = arena_new(arena, struct disc, measure->n_estimators);
  if (!measurement_keeps_points(measure))
    tile.room = arena_new(arena, struct eye_point, TILE_POINTS);
  if (measure->nee && measure->depth > 0 && !(measure->left_out & LIGHT_PATH_DIRECT))
    tile.direct = arena_new(arena, double, (long)WALK_BATCH * measure->features.n_channels);
  return tile;
}

void tile_begin(struct tile *tile, uint64_t run, enum rng_purpose purpose, uint64_t i) {
  tile->walk->key = rng_key(tile->measure->seed, run, purpose);
  walk_begin(tile->walk, tile->measure->seed, run, i);
}

void tile_see(struct tile *tile, uint64_t run, uint64_t i, int first, int n) {
  const struct measurement *measure = tile->measure;
  tile_take(tile, tile->room, first, n);
  tile_begin(tile, run, RNG_EYE, i);
  eye_trace(tile->walk, measure->pixel + first, n, measure->footprint, measure->depth, tile->point);
}

void tile_take(struct tile *tile, struct eye_point *kept, int first, int n) {
  tile->point = kept;
  tile->first = first;
  tile->n = n;
}

// ---- direct light ----
// Light samples of points first..first + n - 1; the eye pass drew nothing from these pairs.
static void connect_points(struct tile *tile, int first, int n, int sets) {
  const struct measurement *measure = tile->measure;
  struct walk *walk = tile->walk;
  const struct camera *camera = &walk->scene->camera;
  uint64_t pixels = (uint64_t)camera->width * (uint64_t)camera->height;
  walk->n = n;
  walk->vertex = 0;
  for (int j = 0; j < n; j++) {
    uint64_t set = (uint64_t)((first + j) / (measure->n_points / sets));
    walk->path[j] = eye_path(camera, measure->pixel[first + j]) + set * pixels;
  }
  if (walk->scene->n_lights > 1) walk_random(walk, 2, pair_of_vertex(0, VERTEX_LIGHT));
  walk_random(walk, 3, pair_of_vertex(0, VERTEX_EMITTER));
  connect_begin(walk);
  for (int j = 0; j < n; j++) {
    const struct eye_point *point = tile_point(tile, first + j);
    if (!point->bsdf.type || point->vertex >= measure->depth) continue;
    struct connection connection = {.bsdf = &point->bsdf,
                                    .p = point->p,
                                    .primitive = point->primitive,
                                    .medium = point->medium,
                                    .path = walk->path[j],
                                    .wo = point->wo,
                                    .owner = j};
    memcpy(connection.weight, point->weight, sizeof connection.weight);
    double u[2] = {walk->u[3][0][j], walk->u[3][1][j]};
    connect_add(walk, &connection, walk->u[2][0][j], u, false);
  }
  memset(tile->direct, 0, (size_t)n * (size_t)walk->n_channels * sizeof *tile->direct);
  connect_finish(walk, tile->direct);
}

// value[n * n_channels] of points first... to all estimators.
static void add_to_all(const struct tile *tile, int first, int n, const double *value,
                       double *frame) {
  const struct measurement *measure = tile->measure;
  long n_channels = measure->features.n_channels, stride = measure->n_points * n_channels;
  for (int e = 0; e < measure->n_estimators; e++)
    for (long k = 0; k < n * n_channels; k++)
      frame[e * stride + first * n_channels + k] += value[k];
}

static void add_emitted(const struct tile *tile, double *frame) {
  for (int j = tile->first; j < tile->first + tile->n; j++)
    add_to_all(tile, j, 1, tile_point(tile, j)->emitted, frame);
}

void tile_add_seen(struct tile *tile, uint64_t run, uint64_t i, int sets, double *frame) {
  if (!(tile->measure->left_out & LIGHT_PATH_EMITTED)) add_emitted(tile, frame);
  if (!tile->direct) return;
  tile_begin(tile, run, RNG_EYE, i);
  for (int at = 0; at < tile->n; at += WALK_BATCH) {
    int n = tile->n - at < WALK_BATCH ? tile->n - at : WALK_BATCH;
    connect_points(tile, tile->first + at, n, sets);
    add_to_all(tile, tile->first + at, n, tile->direct, frame);
  }
}
