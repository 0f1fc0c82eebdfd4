#include "estimate/photon_map.h"

#include "walk/connect.h"
#include "walk/dimension.h"

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
  map->gather.left_out = measure->left_out;
  map->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  map->point = arena_new(arena, struct eye_point, measure->n_points);
  map->disc = arena_new(arena, struct disc, measure->n_estimators);
  for (int kind = 0; kind < measurement_kinds(measure); kind++)
    field_begin(&map->field[kind], measure, point_dimension[kind], arena);
  if (measure->nee && !(measure->left_out & LIGHT_PATH_DIRECT))
    map->direct = arena_new(arena, double, (long)measure->n_points * measure->features.n_channels);
  return map;
}

void photon_map_see(struct photon_map *map, uint64_t i) {
  const struct measurement *measure = map->measure;
  map->walk->key = rng_key(measure->seed, map->run, RNG_EYE);
  walk_begin(map->walk, measure->seed, map->run, i);
  eye_trace(map->walk, measure->pixel, measure->n_points, measure->footprint, measure->depth,
            map->point);
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
  if (measure->n_points > PHOTON_MAP_FEW) return NULL;
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
  const struct eye_point *point = &map->point[j];
  const struct photon_field *field = &map->field[eye_point_kind(point)];
  if (count) memset(count, 0, (size_t)measure->n_estimators * sizeof *count);
  if (!point->bsdf.type) return;
  for (int e = 0; e < measure->n_estimators; e++)
    map->disc[e] =
        disc_of(measure->estimator[e].kernel, field->c[e], r[e], field->d, measure->n_emitted);
  double *out = frame + (long)j * n_channels;
  long stride = (long)measure->n_points * n_channels;
  if (map->any_radius)
    gather_point_in_tree(&map->gather, &field->photons, &field->tree, point, measure->depth,
                         map->disc, measure->n_estimators, count, out, stride, map->arena);
  else
    gather_point(&map->gather, &field->photons, &field->grid, point, measure->depth, map->disc,
                 measure->n_estimators, count, out, stride, map->arena);
}

void photon_map_nearest(struct photon_map *map, int j, const int *k, double *frame) {
  const struct measurement *measure = map->measure;
  const struct photon_field *field = &map->field[ON_SURFACE];
  int n_channels = measure->features.n_channels;
  if (!map->point[j].bsdf.type) return;
  assert(!map->point[j].volume); // refused where there are media
  for (int e = 0; e < measure->n_estimators; e++)
    map->disc[e] =
        disc_of(measure->estimator[e].kernel, field->c[e], 1, field->d, measure->n_emitted);
  gather_nearest(&map->gather, &field->photons, &field->tree, &map->point[j], measure->depth,
                 map->disc, k, measure->n_estimators, frame + (long)j * n_channels,
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

// Light samples of points first..first + n - 1; the eye pass drew nothing from these pairs.
static void connect_points(struct photon_map *map, int first, int n) {
  const struct measurement *measure = map->measure;
  struct walk *walk = map->walk;
  const struct camera *camera = &walk->scene->camera;
  uint64_t pixels = (uint64_t)camera->width * (uint64_t)camera->height;
  walk->n = n;
  walk->vertex = 0;
  for (int j = 0; j < n; j++) {
    uint64_t set = (uint64_t)((first + j) / (measure->n_points / map->sets));
    walk->path[j] = eye_path(camera, measure->pixel[first + j]) + set * pixels;
  }
  walk_random(walk, 2, pair_of_vertex(0, VERTEX_LIGHT));
  walk_random(walk, 3, pair_of_vertex(0, VERTEX_EMITTER));
  connect_begin(walk);
  for (int j = 0; j < n; j++) {
    const struct eye_point *point = &map->point[first + j];
    if (!point->bsdf.type || point->vertex >= measure->depth) continue;
    struct connection connection = {.bsdf = &point->bsdf,
                                    .p = point->p,
                                    .primitive = point->primitive,
                                    .medium = point->medium,
                                    .path = walk->path[j],
                                    .wo = point->wo,
                                    .owner = first + j};
    memcpy(connection.weight, point->weight, sizeof connection.weight);
    double u[2] = {walk->u[3][0][j], walk->u[3][1][j]};
    connect_add(walk, &connection, walk->u[2][0][j], u, false);
  }
  connect_finish(walk, map->direct);
}

// Direct light by next-event estimation, the same for all estimators.
static void add_direct(struct photon_map *map, uint64_t i, double *frame) {
  const struct measurement *measure = map->measure;
  long stride = (long)measure->n_points * measure->features.n_channels;
  memset(map->direct, 0, (size_t)stride * sizeof *map->direct);
  map->walk->key = rng_key(measure->seed, map->run, RNG_EYE);
  walk_begin(map->walk, measure->seed, map->run, i);
  for (int first = 0; first < measure->n_points; first += WALK_BATCH) {
    int left = measure->n_points - first;
    connect_points(map, first, left < WALK_BATCH ? left : WALK_BATCH);
  }
  for (int e = 0; e < measure->n_estimators; e++)
    for (long k = 0; k < stride; k++) frame[e * stride + k] += map->direct[k];
}

static void add_emitted(const struct photon_map *map, double *frame) {
  const struct measurement *measure = map->measure;
  int n_channels = measure->features.n_channels;
  for (int e = 0; e < measure->n_estimators; e++)
    for (int j = 0; j < measure->n_points; j++, frame += n_channels)
      for (int c = 0; c < n_channels; c++) frame[c] += map->point[j].emitted[c];
}

void photon_map_add_seen(struct photon_map *map, uint64_t i, double *frame) {
  const struct measurement *measure = map->measure;
  if (!(measure->left_out & LIGHT_PATH_EMITTED)) add_emitted(map, frame);
  if (map->direct && measure->depth > 0) add_direct(map, i, frame);
}
