#include "estimate/photon_map.h"

#include "walk/connect.h"
#include "walk/dimension.h"

#include <string.h>

struct photon_map *photon_map_new(const struct measurement *measure, struct arena *arena) {
  struct photon_map *map = arena_new(arena, struct photon_map, 1);
  map->measure = measure;
  map->sets = 1;
  map->arena = arena;
  map->gather.left_out = measure->left_out;
  map->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  map->point = arena_new(arena, struct eye_point, measure->n_points);
  map->disc = arena_new(arena, struct disc, measure->n_estimators);
  map->c = arena_new(arena, double, measure->n_estimators);
  for (int e = 0; e < measure->n_estimators; e++)
    map->c[e] = measure->estimator[e].kernel->constants(2).c;
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

const struct photon_filter *photon_map_filter(struct photon_map *map, double r) {
  const struct measurement *measure = map->measure;
  if (measure->n_points > PHOTON_MAP_FEW || (measure->skip_off & SKIP_UNSEEN)) return NULL;
  int n = 0;
  for (int j = 0; j < measure->n_points; j++)
    if (map->point[j].hit) map->seen_point[n++] = map->point[j].p;
  grid_seen_mark(&map->seen, map->seen_point, n, r);
  map->filter = (struct photon_filter){grid_seen_keep, &map->seen};
  return &map->filter;
}

void photon_map_emit(struct photon_map *map, uint64_t i, double r) {
  const struct measurement *measure = map->measure;
  struct photon_pass pass = {measure->n_emitted, measure->depth, measure->nee ? 1 : 0, 0};
  // A tree depends on all photons, and so would its order on those left out.
  map->any_radius = r == INFINITY;
  const struct photon_filter *filter = map->any_radius ? NULL : photon_map_filter(map, r);
  map->walk->key = rng_key(measure->seed, map->run, RNG_PHOTONS);
  walk_begin(map->walk, measure->seed, map->run, i);
  struct photon_sinks sinks = {.surface = {&map->photons, filter}};
  photons_trace(map->walk, &pass, &sinks, map->arena);
  if (map->any_radius)
    knn_build(&map->tree, map->photons.position, map->photons.count, map->arena);
  else
    grid_build(&map->grid, &map->photons, r, map->arena);
}

void photon_map_gather(struct photon_map *map, int j, const double *r, int64_t *count,
                       double *frame) {
  const struct measurement *measure = map->measure;
  int n_channels = measure->features.n_channels;
  const struct eye_point *point = &map->point[j];
  if (count) memset(count, 0, (size_t)measure->n_estimators * sizeof *count);
  if (!point->bsdf.type) return;
  for (int e = 0; e < measure->n_estimators; e++)
    map->disc[e] = disc_of(measure->estimator[e].kernel, map->c[e], r[e], measure->n_emitted);
  double *out = frame + (long)j * n_channels;
  long stride = (long)measure->n_points * n_channels;
  if (map->any_radius)
    gather_point_in_tree(&map->gather, &map->photons, &map->tree, point, measure->depth, map->disc,
                         measure->n_estimators, count, out, stride, map->arena);
  else
    gather_point(&map->gather, &map->photons, &map->grid, point, measure->depth, map->disc,
                 measure->n_estimators, count, out, stride, map->arena);
}

void photon_map_nearest(struct photon_map *map, int j, const int *k, double *frame) {
  const struct measurement *measure = map->measure;
  int n_channels = measure->features.n_channels;
  if (!map->point[j].bsdf.type) return;
  for (int e = 0; e < measure->n_estimators; e++)
    map->disc[e] = disc_of(measure->estimator[e].kernel, map->c[e], 1, measure->n_emitted);
  gather_nearest(&map->gather, &map->photons, &map->tree, &map->point[j], measure->depth, map->disc,
                 k, measure->n_estimators, frame + (long)j * n_channels,
                 (long)measure->n_points * n_channels, map->arena);
}

int64_t photon_map_bytes(const struct photon_map *map) {
  return photons_bytes(&map->photons) + (map->any_radius
                                             ? map->tree.count * (int64_t)sizeof(struct knn_item)
                                             : grid_bytes(&map->grid));
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
