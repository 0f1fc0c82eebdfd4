#include "estimate/photon_map.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static void field_begin(struct photon_field *field, const struct measurement *measure, int d,
                        struct arena *arena) {
  field->d = d;
  field->c = arena_new(arena, double, measure->n_estimators);
  for (int e = 0; e < measure->n_estimators; e++)
    field->c[e] = measure->estimator[e].kernel->constants(d).c;
}

struct photon_map *photon_map_new(const struct measurement *measure, struct arena *arena) {
  struct photon_map *map = arena_new(arena, struct photon_map, 1);
  map->measure = measure;
  map->sets = 1;
  map->arena = arena;
  map->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  map->tile = tile_new(measure, map->walk, arena);
  if (!map->tile.room) map->point = arena_new(arena, struct eye_point, measure->n_points);
  for (int kind = 0; kind < measurement_kinds(measure); kind++)
    field_begin(&map->field[kind], measure, point_dimension[kind], arena);
  return map;
}

void photon_map_see(struct photon_map *map, uint64_t i) {
  const struct measurement *measure = map->measure;
  map->seen = i;
  if (!map->point) return;
  tile_begin(&map->tile, map->run, RNG_EYE, i);
  eye_trace(map->walk, measure->pixel, measure->n_points, measure->footprint, measure->depth,
            map->point);
  tile_take(&map->tile, map->point, 0, measure->n_points);
}

bool photon_map_tile(struct photon_map *map, int first) {
  int left = map->measure->n_points - first;
  if (left <= 0) return false;
  if (!map->point)
    tile_see(&map->tile, map->run, map->seen, first, left < TILE_POINTS ? left : TILE_POINTS);
  return true;
}

static bool keep_none(const void *data, struct vec p) {
  (void)data, (void)p;
  return false;
}

// NULL: all may be found.
static const struct photon_filter *filter_of(struct photon_map *map, enum point_kind kind,
                                             double r) {
  const struct measurement *measure = map->measure;
  struct photon_field *field = &map->field[kind];
  field->filter = (struct photon_filter){keep_none, NULL};
  if (measure->skip_off & SKIP_UNSEEN) return NULL;
  if (r == 0) return &field->filter;
  if (measure->n_points > PHOTON_MAP_FEW || !map->point) return NULL;
  int n = 0;
  for (int j = 0; j < measure->n_points; j++)
    if (map->point[j].hit && eye_point_kind(&map->point[j]) == kind)
      map->seen_point[n++] = map->point[j].p;
  grid_seen_mark(&field->seen, map->seen_point, n, r);
  field->filter = (struct photon_filter){grid_seen_keep, &field->seen};
  return &field->filter;
}

struct photon_sinks photon_map_sinks(struct photon_map *map, const double r[POINT_KINDS]) {
  struct photon_sinks sinks = {0};
  struct photon_sink *sink[POINT_KINDS] = {&sinks.surface, &sinks.volume};
  for (int kind = 0; kind < measurement_kinds(map->measure); kind++) {
    // A tree depends on all photons, and so would its order on those left out.
    const struct photon_filter *filter =
        r[kind] == INFINITY ? NULL : filter_of(map, (enum point_kind)kind, r[kind]);
    *sink[kind] = (struct photon_sink){&map->field[kind].photons, filter};
  }
  return sinks;
}

// For radii up to r; 0: nobody asks.
static void build(struct photon_field *field, double r, struct arena *arena) {
  if (r == INFINITY)
    knn_build(&field->tree, field->photons.position, field->photons.count, arena);
  else if (r > 0)
    grid_build(&field->grid, &field->photons, r, arena);
}

void photon_map_emit(struct photon_map *map, uint64_t i, const double r[POINT_KINDS]) {
  const struct measurement *measure = map->measure;
  struct photon_pass pass = {.n_emitted = measure->n_emitted,
                             .depth = measure->depth,
                             .first_vertex = measure->nee ? 1 : 0,
                             .past_last = measure->skip_off & SKIP_LAST};
  map->any_radius = r[ON_SURFACE] == INFINITY;
  struct photon_sinks sinks = photon_map_sinks(map, r);
  sinks.beams = map->beams;
  map->walk->key = rng_key(measure->seed, map->run, RNG_PHOTONS);
  walk_begin(map->walk, measure->seed, map->run, i);
  photons_trace(map->walk, &pass, &sinks, map->arena);
  for (int kind = 0; kind < measurement_kinds(measure); kind++)
    build(&map->field[kind], r[kind], map->arena);
}

void photon_map_gather(struct photon_map *map, int j, const double *r, int64_t *count,
                       double *frame) {
  const struct measurement *measure = map->measure;
  int n_channels = measure->features.n_channels;
  const struct eye_point *point = tile_point(&map->tile, j);
  const struct photon_field *field = &map->field[eye_point_kind(point)];
  if (count) memset(count, 0, (size_t)measure->n_estimators * sizeof *count);
  if (!point->bsdf.type) return;
  for (int e = 0; e < measure->n_estimators; e++)
    map->tile.disc[e] =
        disc_of(measure->estimator[e].kernel, field->c[e], r[e], field->d, measure->n_emitted);
  double *out = frame + (long)j * n_channels;
  long stride = (long)measure->n_points * n_channels;
  if (map->any_radius)
    gather_point_in_tree(&map->tile.gather, &field->photons, &field->tree, point, measure->depth,
                         map->tile.disc, measure->n_estimators, count, out, stride, map->arena);
  else
    gather_point(&map->tile.gather, &field->grid, point, measure->depth, map->tile.disc,
                 measure->n_estimators, count, out, stride, map->arena);
}

void photon_map_nearest(struct photon_map *map, int j, const int *k, double *frame) {
  const struct measurement *measure = map->measure;
  const struct photon_field *field = &map->field[ON_SURFACE];
  int n_channels = measure->features.n_channels;
  const struct eye_point *point = tile_point(&map->tile, j);
  if (!point->bsdf.type) return;
  assert(!point->volume); // refused where there are media
  for (int e = 0; e < measure->n_estimators; e++)
    map->tile.disc[e] =
        disc_of(measure->estimator[e].kernel, field->c[e], 1, field->d, measure->n_emitted);
  gather_nearest(&map->tile.gather, &field->photons, &field->tree, point, measure->depth,
                 map->tile.disc, k, measure->n_estimators, frame + (long)j * n_channels,
                 (long)measure->n_points * n_channels, map->arena);
}

int64_t photon_map_bytes(const struct photon_map *map) {
  int64_t bytes = 0;
  for (int kind = 0; kind < measurement_kinds(map->measure); kind++) {
    const struct photon_field *field = &map->field[kind];
    bytes += photons_bytes(&field->photons);
    bytes += map->any_radius ? field->tree.count * (int64_t)sizeof(struct knn_item)
                             : grid_bytes(&field->grid);
  }
  return bytes;
}

void photon_map_add_seen(struct photon_map *map, uint64_t i, double *frame) {
  tile_add_seen(&map->tile, map->run, i, map->sets, frame);
}
