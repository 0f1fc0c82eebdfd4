#include "estimate/local.h"

#include <omp.h>
#include <string.h>

enum { POINTS_AT_ONCE = 64 }; // that a thread gathers before it takes more

// What a thread has of its own.
struct local_worker {
  struct arena *arena;
  struct walk *walk;
  struct photons photons;
  struct gather gather;
  struct disc *disc; // [n_estimators]
  int64_t *found;    // [n_estimators]
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
    worker->gather.left_out = measure->left_out;
    worker->disc = arena_new(worker->arena, struct disc, measure->n_estimators);
    worker->found = arena_new(worker->arena, int64_t, measure->n_estimators);
  }
}

struct local *local_new(const struct measurement *measure, struct arena *arena) {
  struct local *local = arena_new(arena, struct local, 1);
  long size = (long)measure->n_points * measure->n_estimators;
  local->map = photon_map_new(measure, arena);
  local->r2 = arena_new(arena, double, size);
  local->n = arena_new(arena, double, size);
  local->level = arena_new(arena, unsigned char, measure->n_points);
  local->fixed = !measure->footprint && !measure->features.random_eye &&
                 !(measure->skip_off & SKIP_STATIC_EYE);
  workers_new(local, arena);
  return local;
}

void local_begin(struct local *local, uint64_t run) {
  const struct measurement *measure = local->map->measure;
  local->map->run = run;
  for (long k = 0; k < (long)measure->n_points * measure->n_estimators; k++) {
    double r1 = measure->estimator[k % measure->n_estimators].r1;
    local->r2[k] = r1 * r1;
    local->n[k] = 0;
  }
}

static void begin(const struct photon_map *map, struct walk *walk, enum rng_purpose purpose,
                  uint64_t i) {
  walk->key = rng_key(map->measure->seed, map->run, purpose);
  walk_begin(walk, map->measure->seed, map->run, i);
}

// Points first..first + n - 1, those of one set.
static void see_set(struct local *local, uint64_t i, int first, int n) {
  struct photon_map *map = local->map;
  const struct measurement *measure = map->measure;
#pragma omp parallel num_threads(local->n_workers)
  {
    struct walk *walk = local->worker[omp_get_thread_num()].walk;
    begin(map, walk, RNG_EYE, i);
#pragma omp for schedule(dynamic, 1)
    for (int at = first; at < first + n; at += WALK_BATCH) {
      int left = first + n - at;
      eye_trace(walk, measure->pixel + at, left < WALK_BATCH ? left : WALK_BATCH,
                measure->footprint, measure->depth, map->point + at);
    }
  }
}

void local_see(struct local *local, uint64_t i) {
  int sets = local->map->sets, n = local->map->measure->n_points / sets;
  if (local->fixed && local->seen) return;
  for (int s = 0; s < sets; s++) see_set(local, i + (uint64_t)s, s * n, n);
  local->seen = true;
}

static double largest_r1(const struct measurement *measure) {
  double r1 = 0;
  for (int e = 0; e < measure->n_estimators; e++)
    r1 = r1 < measure->estimator[e].r1 ? measure->estimator[e].r1 : r1;
  return r1;
}

static double largest_radius(const struct local *local, int point) {
  int n = local->map->measure->n_estimators;
  double r2 = 0;
  for (int e = 0; e < n; e++) {
    double own = local->r2[(long)point * n + e];
    r2 = r2 < own ? own : r2;
  }
  return sqrt(r2);
}

// The level of each point that scatters light; returns the largest of their radii, 0: there is
// none.
static double set_levels(struct local *local) {
  const struct measurement *measure = local->map->measure;
  double r1 = largest_r1(measure), largest = 0;
  memset(local->used, 0, sizeof local->used);
  for (int j = 0; j < measure->n_points; j++) {
    if (!local->map->point[j].bsdf.type) continue;
    double r = largest_radius(local, j), edge = r1;
    int level = 0;
    for (; level + 1 < LOCAL_LEVELS && 0.5 * edge >= r; level++) edge *= 0.5;
    local->level[j] = (unsigned char)level;
    local->used[level] = true;
    largest = largest < r ? r : largest;
  }
  return largest;
}

// Each thread traces a part of the pass; the parts put together are the pass.
static void emit(struct local *local, uint64_t i, double r) {
  struct photon_map *map = local->map;
  const struct measurement *measure = map->measure;
  const struct photon_filter *filter = photon_map_filter(map, r);
  uint64_t batches = (measure->n_emitted + WALK_BATCH - 1) / WALK_BATCH;
  uint64_t n = (uint64_t)local->n_workers;
#pragma omp parallel for schedule(static, 1) num_threads(local->n_workers)
  for (uint64_t t = 0; t < n; t++) {
    struct local_worker *worker = &local->worker[t];
    uint64_t end = (t + 1) * batches / n * WALK_BATCH;
    struct photon_pass pass = {.n_emitted = end < measure->n_emitted ? end : measure->n_emitted,
                               .depth = measure->depth,
                               .first_vertex = measure->nee ? 1 : 0,
                               .first = t * batches / n * WALK_BATCH};
    begin(map, worker->walk, RNG_PHOTONS, i);
    struct photon_sinks sinks = {.surface = {n == 1 ? &map->photons : &worker->photons, filter}};
    photons_trace(worker->walk, &pass, &sinks, worker->arena);
  }
  if (n == 1) return;
  map->photons.count = 0;
  for (int t = 0; t < local->n_workers; t++)
    photons_append(&map->photons, &local->worker[t].photons, map->arena);
}

static void build_grids(struct local *local) {
  double r1 = largest_r1(local->map->measure);
#pragma omp parallel for schedule(dynamic, 1) num_threads(local->n_workers)
  for (int level = 0; level < LOCAL_LEVELS; level++) {
    double edge = r1 / (double)(1 << level);
    if (!local->used[level]) continue;
    grid_build(&local->grid[level], &local->map->photons, edge,
               local->worker[omp_get_thread_num()].arena);
  }
}

static void gather(struct local *local, struct local_worker *worker, int point, double *frame) {
  struct photon_map *map = local->map;
  const struct measurement *measure = map->measure;
  int n = measure->n_estimators, n_channels = measure->features.n_channels;
  memset(worker->found, 0, (size_t)n * sizeof *worker->found);
  if (!map->point[point].bsdf.type) return;
  for (int e = 0; e < n; e++)
    worker->disc[e] = disc_of(measure->estimator[e].kernel, map->c[e],
                              sqrt(local->r2[(long)point * n + e]), measure->n_emitted);
  gather_point(&worker->gather, &map->photons, &local->grid[local->level[point]],
               &map->point[point], measure->depth, worker->disc, n, worker->found,
               frame + (long)point * n_channels, (long)measure->n_points * n_channels,
               worker->arena);
}

// The next pass' radius of each estimator at a point.
static void shrink(struct local *local, const int64_t *found, int point, uint64_t i) {
  const struct measurement *measure = local->map->measure;
  for (int e = 0; e < measure->n_estimators; e++) {
    const struct estimator *estimator = &measure->estimator[e];
    long k = (long)point * measure->n_estimators + e;
    double ratio;
    if (!estimator->law->count) {
      local->r2[k] = estimator->r1 * estimator->r1 * estimator->law->rho(estimator->alpha, i + 1);
      continue;
    }
    local->n[k] = estimator->law->count(estimator->alpha, local->n[k], (double)found[e], &ratio);
    local->r2[k] *= ratio;
  }
}

void local_pass(struct local *local, uint64_t i, double *frame) {
  const struct measurement *measure = local->map->measure;
  memset(frame, 0, (size_t)photon_map_frame(measure) * sizeof *frame);
  double r = set_levels(local);
  if (r > 0) emit(local, i, r);
  build_grids(local);
#pragma omp parallel for schedule(dynamic, POINTS_AT_ONCE) num_threads(local->n_workers)
  for (int j = 0; j < measure->n_points; j++) {
    struct local_worker *worker = &local->worker[omp_get_thread_num()];
    gather(local, worker, j, frame);
    shrink(local, worker->found, j, i);
  }
  photon_map_add_seen(local->map, i, frame);
}

int64_t local_bytes(const struct local *local) {
  int64_t bytes = photons_bytes(&local->map->photons);
  for (int level = 0; level < LOCAL_LEVELS; level++)
    if (local->used[level]) bytes += grid_bytes(&local->grid[level]);
  return bytes;
}
