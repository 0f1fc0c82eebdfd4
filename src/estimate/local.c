#include "estimate/local.h"

#include <omp.h>
#include <string.h>

enum {
  TILES_PER_WORKER = 4, // at least, where there are points enough
  FEW_POINTS = 64,      // that one thread gathers sooner than others are awake
};

// What a thread has of its own.
struct local_worker {
  struct arena *arena;
  struct walk *walk;
  struct photons photons[POINT_KINDS];
  struct tile tile;
  int64_t *found; // [n_estimators]
};

// An equal share of what is left of the arena for one of n.
static struct arena share(struct arena *arena, int n) {
  struct arena part = {arena->end - (arena->end - arena->next) / n, arena->end};
  arena->end = part.next;
  return part;
}

static void workers_new(struct local *local, struct arena *arena) {
  const struct measurement *measure = local->map->measure;
  local->n_workers = measure->threads > 1 ? measure->threads : 1;
  local->worker = arena_new(arena, struct local_worker, local->n_workers);
  for (int t = 0; t < local->n_workers; t++) {
    struct local_worker *worker = &local->worker[t];
    worker->arena = arena;
    worker->walk = local->map->walk;
    if (local->n_workers > 1) {
      worker->arena = arena_new(arena, struct arena, 1);
      *worker->arena = share(arena, local->n_workers - t + 1);
      worker->walk = walk_new(measure->scene, measure->bvh, measure->features, worker->arena);
    }
    worker->tile = tile_new(measure, worker->walk, worker->arena);
    worker->found = arena_new(worker->arena, int64_t, measure->n_estimators);
  }
}

struct local *local_new(const struct measurement *measure, struct arena *arena) {
  struct local *local = arena_new(arena, struct local, 1);
  long size = (long)measure->n_points * measure->n_estimators;
  local->map = photon_map_new(measure, arena);
  for (int kind = 0; kind < measurement_kinds(measure); kind++) {
    struct local_field *field = &local->field[kind];
    field->d = point_dimension[kind];
    field->rd = arena_new(arena, double, size);
    field->n = arena_new(arena, double, size);
  }
  local->kind = arena_new(arena, unsigned char, measure->n_points);
  local->fixed = measurement_is_static(measure);
  workers_new(local, arena);
  return local;
}

void local_begin(struct local *local, uint64_t run) {
  const struct measurement *measure = local->map->measure;
  local->map->run = run;
  for (int kind = 0; kind < measurement_kinds(measure); kind++) {
    struct local_field *field = &local->field[kind];
    for (long k = 0; k < (long)measure->n_points * measure->n_estimators; k++) {
      const struct estimator *estimator = &measure->estimator[k % measure->n_estimators];
      field->rd[k] = radius_power(estimator_r1(estimator, (enum point_kind)kind), field->d);
      field->n[k] = 0;
    }
  }
}

// Points first..first + n - 1, those of one set, to be kept.
static void see_set(struct local *local, uint64_t i, int first, int n) {
  struct photon_map *map = local->map;
  const struct measurement *measure = map->measure;
#pragma omp parallel num_threads(local->n_workers) if (n > WALK_BATCH)
  {
    struct tile *tile = &local->worker[omp_get_thread_num()].tile;
    tile_begin(tile, map->run, RNG_EYE, i);
#pragma omp for schedule(dynamic, 1)
    for (int at = first; at < first + n; at += WALK_BATCH) {
      int left = first + n - at;
      eye_trace(tile->walk, measure->pixel + at, left < WALK_BATCH ? left : WALK_BATCH,
                measure->footprint, measure->depth, map->point + at);
    }
  }
}

void local_see(struct local *local, uint64_t i) {
  int sets = local->map->sets, n = local->map->measure->n_points / sets;
  if (local->fixed && local->seen) return;
  local->map->seen = i;
  if (!local->map->point) return;
  for (int s = 0; s < sets; s++) see_set(local, i + (uint64_t)s, s * n, n);
  local->seen = true;
}

static double radius(const struct local *local, const struct local_field *field, int point,
                     int estimator) {
  return radius_root(field->rd[(long)point * local->map->measure->n_estimators + estimator],
                     field->d);
}

double local_radius(const struct local *local, int point, int estimator) {
  return radius(local, &local->field[local->kind[point]], point, estimator);
}

static double largest_r1(const struct measurement *measure, enum point_kind kind) {
  double r1 = 0;
  for (int e = 0; e < measure->n_estimators; e++) {
    double own = estimator_r1(&measure->estimator[e], kind);
    r1 = r1 < own ? own : r1;
  }
  return r1;
}

static double largest_radius(const struct local *local, const struct local_field *field,
                             int point) {
  double r = 0;
  for (int e = 0; e < local->map->measure->n_estimators; e++) {
    double own = radius(local, field, point, e);
    r = r < own ? own : r;
  }
  return r;
}

// Of the grids for points of radii up to r.
static int level_of(double r1, double r) {
  int level = 0;
  for (double edge = 0.5 * r1; level + 1 < LOCAL_LEVELS && edge >= r; edge *= 0.5) level++;
  return level;
}

// Whether this pass may see the point there; where they are kept it is known.
static bool may_scatter(const struct local *local, int point, enum point_kind kind) {
  const struct eye_point *kept = local->map->point;
  return !kept || (kept[point].bsdf.type && eye_point_kind(&kept[point]) == kind);
}

// The levels that this pass needs; largest[kind] of the points' radii, 0: there is none.
static void set_levels(struct local *local, double largest[POINT_KINDS]) {
  const struct measurement *measure = local->map->measure;
  largest[IN_VOLUME] = 0;
  for (int kind = 0; kind < measurement_kinds(measure); kind++) {
    struct local_field *field = &local->field[kind];
    double r1 = largest_r1(measure, (enum point_kind)kind);
    memset(field->used, 0, sizeof field->used);
    largest[kind] = 0;
    for (int j = 0; j < measure->n_points; j++) {
      if (!may_scatter(local, j, (enum point_kind)kind)) continue;
      double r = largest_radius(local, field, j);
      field->used[level_of(r1, r)] = true;
      largest[kind] = largest[kind] < r ? r : largest[kind];
    }
  }
}

// As the map's, into the photons of a thread where there are several.
static struct photon_sinks sinks_of(const struct local *local, struct local_worker *worker,
                                    struct photon_sinks sinks) {
  if (local->n_workers == 1) return sinks;
  sinks.surface.photons = &worker->photons[ON_SURFACE];
  if (sinks.volume.photons) sinks.volume.photons = &worker->photons[IN_VOLUME];
  return sinks;
}

// Each thread traces a part of the pass; the parts put together are the pass.
static void emit(struct local *local, uint64_t i, const double r[POINT_KINDS]) {
  struct photon_map *map = local->map;
  const struct measurement *measure = map->measure;
  struct photon_sinks shared = photon_map_sinks(map, r);
  uint64_t batches = (measure->n_emitted + WALK_BATCH - 1) / WALK_BATCH;
  uint64_t n = (uint64_t)local->n_workers;
#pragma omp parallel for schedule(static, 1) num_threads(local->n_workers) if (batches > 1)
  for (uint64_t t = 0; t < n; t++) {
    struct local_worker *worker = &local->worker[t];
    uint64_t end = (t + 1) * batches / n * WALK_BATCH;
    struct photon_pass pass = {.n_emitted = end < measure->n_emitted ? end : measure->n_emitted,
                               .depth = measure->depth,
                               .first_vertex = measure->nee ? 1 : 0,
                               .first = t * batches / n * WALK_BATCH,
                               .past_last = measure->skip_off & SKIP_LAST};
    tile_begin(&worker->tile, map->run, RNG_PHOTONS, i);
    struct photon_sinks sinks = sinks_of(local, worker, shared);
    photons_trace(worker->walk, &pass, &sinks, worker->arena);
  }
  if (n == 1) return;
  for (int kind = 0; kind < measurement_kinds(measure); kind++) {
    struct photons *photons = &map->field[kind].photons;
    photons->count = 0;
    for (int t = 0; t < local->n_workers; t++)
      photons_append(photons, &local->worker[t].photons[kind], map->arena);
  }
}

static void build_grids(struct local *local) {
  const struct measurement *measure = local->map->measure;
  bool many = measure->n_emitted > WALK_BATCH;
#pragma omp parallel for schedule(dynamic, 1) num_threads(local->n_workers) if (many)
  for (int k = 0; k < measurement_kinds(measure) * LOCAL_LEVELS; k++) {
    int kind = k / LOCAL_LEVELS, level = k % LOCAL_LEVELS;
    struct local_field *field = &local->field[kind];
    double edge = largest_r1(measure, (enum point_kind)kind) / (double)(1 << level);
    if (!field->used[level]) continue;
    grid_build(&field->grid[level], &local->map->field[kind].photons, edge,
               local->worker[omp_get_thread_num()].arena);
  }
}

static void gather(struct local *local, struct local_worker *worker, int j, double *frame) {
  struct photon_map *map = local->map;
  const struct measurement *measure = map->measure;
  int n = measure->n_estimators, n_channels = measure->features.n_channels;
  struct tile *tile = &worker->tile;
  const struct eye_point *point = tile_point(tile, j);
  enum point_kind kind = eye_point_kind(point);
  struct local_field *field = &local->field[kind];
  memset(worker->found, 0, (size_t)n * sizeof *worker->found);
  local->kind[j] = (unsigned char)kind;
  if (!point->bsdf.type) return;
  for (int e = 0; e < n; e++)
    tile->disc[e] = disc_of(measure->estimator[e].kernel, map->field[kind].c[e],
                            radius(local, field, j, e), field->d, measure->n_emitted);
  int level = level_of(largest_r1(measure, kind), largest_radius(local, field, j));
  gather_point(&tile->gather, &field->grid[level], point, measure->depth, tile->disc, n,
               worker->found, frame + (long)j * n_channels, (long)measure->n_points * n_channels,
               worker->arena);
}

// The next pass' r^d of each estimator at a point: a law without local statistics shrinks both
// kinds, one with them that which was seen.
static void shrink(struct local *local, const int64_t *found, int point, uint64_t i) {
  const struct measurement *measure = local->map->measure;
  for (int e = 0; e < measure->n_estimators; e++) {
    const struct estimator *estimator = &measure->estimator[e];
    const struct law *law = estimator->law;
    long k = (long)point * measure->n_estimators + e;
    for (int kind = 0; kind < measurement_kinds(measure) && !law->count; kind++) {
      struct local_field *field = &local->field[kind];
      double r1 = estimator_r1(estimator, (enum point_kind)kind);
      field->rd[k] = radius_power(r1, field->d) * law->rho(estimator->alpha, i + 1);
    }
    if (!law->count) continue;
    struct local_field *field = &local->field[local->kind[point]];
    double ratio;
    field->n[k] = law->count(estimator->alpha, field->n[k], (double)found[e], &ratio);
    field->rd[k] *= ratio;
  }
}

static void pass_tile(struct local *local, struct local_worker *worker, int first, int n,
                      uint64_t i, double *frame) {
  struct photon_map *map = local->map;
  struct tile *tile = &worker->tile;
  if (map->point)
    tile_take(tile, map->point + first, first, n);
  else
    tile_see(tile, map->run, map->seen, first, n);
  for (int j = first; j < first + n; j++) {
    gather(local, worker, j, frame);
    shrink(local, worker->found, j, i);
  }
  tile_add_seen(tile, map->run, i, map->sets, frame);
}

void local_pass(struct local *local, uint64_t i, double *frame) {
  const struct measurement *measure = local->map->measure;
  memset(frame, 0, (size_t)photon_map_frame(measure) * sizeof *frame);
  double largest[POINT_KINDS];
  set_levels(local, largest);
  if (largest[ON_SURFACE] > 0 || largest[IN_VOLUME] > 0) emit(local, i, largest);
  build_grids(local);
  int most = measure->n_points / (TILES_PER_WORKER * local->n_workers) + 1;
  if (most > TILE_POINTS) most = TILE_POINTS;
  bool many = measure->n_points > FEW_POINTS;
#pragma omp parallel for schedule(dynamic, 1) num_threads(local->n_workers) if (many)
  for (int first = 0; first < measure->n_points; first += most) {
    int left = measure->n_points - first, n = left < most ? left : most;
    pass_tile(local, &local->worker[omp_get_thread_num()], first, n, i, frame);
  }
}

int64_t local_bytes(const struct local *local) {
  int64_t bytes = 0;
  for (int kind = 0; kind < measurement_kinds(local->map->measure); kind++) {
    const struct local_field *field = &local->field[kind];
    bytes += photons_bytes(&local->map->field[kind].photons);
    for (int level = 0; level < LOCAL_LEVELS; level++)
      if (field->used[level]) bytes += grid_bytes(&field->grid[level]);
  }
  return bytes;
}
