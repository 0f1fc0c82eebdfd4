#include "tests/bench/measure.h"

#include "base/simd.h"
#include "estimate/photon_map.h"

#include <math.h>
#include <string.h>

static const char *const scenes[] = {"box", "torus", "cornell-gray", "cornell-torus-glass"};

enum { TEN = 10 };

struct job {
  struct measurement measure;
  struct photon_map *map;
  struct arena *arena;
  enum simd level;
  double *frame, r[TEN];
  int64_t *count; // [n_points][n_estimators] photons found
};

static void gather(void *data, int repetition) {
  struct job *job = data;
  enum simd chosen = simd_chosen();
  (void)repetition;
  simd_choose(job->level);
  memset(job->frame, 0, (size_t)photon_map_frame(&job->measure) * sizeof *job->frame);
  for (int j = 0; j < job->measure.n_points; j++)
    photon_map_gather(job->map, j, job->r, &job->count[j * job->measure.n_estimators], job->frame);
  simd_choose(chosen);
}

static uint64_t hash(const void *data) {
  const struct job *job = data;
  return bench_hash(job->frame, (size_t)photon_map_frame(&job->measure) * sizeof *job->frame);
}

static void build(void *data, int repetition) {
  struct job *job = data;
  struct photon_field *field = &job->map->field[ON_SURFACE];
  enum simd chosen = simd_chosen();
  (void)repetition;
  simd_choose(job->level);
  grid_build(&field->grid, &field->photons, job->r[0], job->arena);
  simd_choose(chosen);
}

static uint64_t hash_grid(const void *data) {
  const struct grid *grid = &((const struct job *)data)->map->field[ON_SURFACE].grid;
  return bench_hash(grid->photon, (size_t)grid->count * sizeof *grid->photon);
}

// grid: by it, else by the tree for any radius.
static struct job *job_new(const struct bench_scene *scene, bool grid, struct arena *arena) {
  struct job *job = arena_new(arena, struct job, 1);
  job->measure = measure_of(scene, false);
  job->measure.keep_points = true;
  for (int e = 0; e < TEN; e++) job->r[e] = 0.05 * (1 - 0.05 * (e / 2));
  job->level = simd_chosen();
  job->arena = arena_new(arena, struct arena, 1);
  *job->arena = arena_reserve();
  job->map = photon_map_new(&job->measure, job->arena);
  job->frame = arena_new(arena, double, photon_map_frame(&job->measure));
  job->count = arena_new(arena, int64_t, job->measure.n_points);
  const double r[POINT_KINDS] = {grid ? job->r[0] : INFINITY, grid ? job->r[0] : INFINITY};
  photon_map_see(job->map, 1);
  photon_map_emit(job->map, 1, r);
  gather(job, 0);
  return job;
}

// Theory 1.1 over all photons there are, channel 0 at point j.
static double brute_force(const struct job *job, int j) {
  const struct photons *photons = &job->map->field[ON_SURFACE].photons;
  const struct eye_point *point = &job->map->point[j];
  const struct estimator *estimator = &job->measure.estimator[0];
  double sum = 0, f[3], r2 = job->r[0] * job->r[0];
  for (int64_t k = 0; point->bsdf.type && k < photons->count; k++) {
    struct vec d = vec_sub(photons->position[k], point->p);
    double t2 = vec_dot(d, d) / r2;
    if (t2 >= 1 || photons->vertex[k] + point->vertex >= job->measure.depth) continue;
    bsdf_value(&point->bsdf, point->wo, photons->wi[k], TRANSPORT_RADIANCE, f);
    sum += kernel_value(estimator->kernel, 2, t2) * f[0] * photons->flux[0][k] *
           bsdf_photon_factor(&point->bsdf, photons->wi[k]);
  }
  return point->weight[0] * sum / (r2 * (double)job->measure.n_emitted);
}

static bool close_to(double a, double b) { return fabs(a - b) <= 1e-10 * fabs(b); }

static bool equals_brute_force(const struct job *job) {
  enum { POINTS = 64, FILM_MIDDLE = 128 };
  int n = job->measure.n_points, channels = job->measure.features.n_channels;
  for (int k = 0; k < POINTS; k++) {
    int j = (int)((long)n * k / POINTS) + FILM_MIDDLE;
    if (!close_to(job->frame[(long)j * channels], brute_force(job, j))) return false;
  }
  return true;
}

// The same photons in each disc, and the same sums up to their order.
static void check(const struct job *grid, const struct job *tree, const char *name) {
  bool same = true;
  for (int j = 0; j < grid->measure.n_points; j++) same &= grid->count[j] == tree->count[j];
  for (long k = 0; k < photon_map_frame(&grid->measure); k++)
    same &= close_to(grid->frame[k], tree->frame[k]);
  bench_check(same, "gathers by the grid and by the tree differ", name);
  bench_check(equals_brute_force(grid), "gathers and sums over all photons differ", name);
}

static double found(const struct job *job) {
  double n = 0;
  for (int j = 0; j < job->measure.n_points; j++) n += (double)job->count[j];
  return n / job->measure.n_points;
}

// The same by another level.
static struct job *at_level(const struct job *job, enum simd level, const char *name,
                            struct arena *arena) {
  struct job *other = arena_new(arena, struct job, 1);
  *other = *job;
  other->level = level;
  other->frame = arena_new(arena, double, photon_map_frame(&job->measure));
  gather(other, 0);
  bench_check(hash(other) == hash(job), "levels differ", name);
  return other;
}

// The same photons for five radii by two kernels; the first estimator is the job's.
static struct job *with_ten(const struct job *job, const char *name, struct arena *arena) {
  struct job *ten = arena_new(arena, struct job, 1);
  struct estimator *estimator = arena_new(arena, struct estimator, TEN);
  *ten = *job;
  for (int e = 0; e < TEN; e++) {
    estimator[e] = job->measure.estimator[0];
    if (e % 2) estimator[e].kernel = kernel_find("epanechnikov");
  }
  ten->measure.estimator = estimator;
  ten->measure.n_estimators = TEN;
  ten->map = photon_map_new(&ten->measure, ten->arena);
  ten->frame = arena_new(arena, double, photon_map_frame(&ten->measure));
  ten->count = arena_new(arena, int64_t, (ptrdiff_t)TEN * ten->measure.n_points);
  const double r[POINT_KINDS] = {ten->r[0], ten->r[0]};
  photon_map_see(ten->map, 1);
  photon_map_emit(ten->map, 1, r);
  gather(ten, 0);
  size_t size = (size_t)photon_map_frame(&job->measure) * sizeof *job->frame;
  bench_check(memcmp(ten->frame, job->frame, size) == 0, "one estimator and ten differ", name);
  return ten;
}

static void add_points(struct bench *bench, struct job *job, const char *name, const char *base) {
  bench_add(bench, "gather",
            (struct row){.name = name,
                         .kind = RATE,
                         .unit = "Mpoints/s",
                         .work = 1e-6 * job->measure.n_points,
                         .body = gather,
                         .data = job,
                         .hash = hash,
                         .base = base});
}

static void add_grid(struct bench *bench, struct job *job, const char *name, const char *base) {
  bench_add(bench, "gather",
            (struct row){.name = name,
                         .kind = RATE,
                         .unit = "Mphotons/s",
                         .work = 1e-6 * (double)job->map->field[ON_SURFACE].photons.count,
                         .body = build,
                         .data = job,
                         .hash = hash_grid,
                         .base = base});
}

static void add(struct bench *bench, const struct bench_scene *scene) {
  struct arena *arena = bench->arena;
  struct job *job = job_new(scene, true, arena), *tree = job_new(scene, false, arena);
  check(job, tree, scene->name);
  const char *points = arena_format(arena, "%s/points", scene->name);
  const char *grid = arena_format(arena, "%s/grid", scene->name);
  bench_add(bench, "gather",
            (struct row){.name = arena_format(arena, "%s/photons", scene->name),
                         .kind = COUNT,
                         .unit = "per point",
                         .work = found(job)});
  add_points(bench, job, points, NULL);
  add_points(bench, with_ten(job, scene->name, arena), arena_format(arena, "%s/ten", points),
             points);
  add_grid(bench, job, grid, NULL);
  for (int level = (int)job->level - 1; level >= 0; level--) {
    struct job *other = at_level(job, (enum simd)level, scene->name, arena);
    add_points(bench, other, arena_format(arena, "%s/%s", points, simd_names[level]), points);
    add_grid(bench, other, arena_format(arena, "%s/%s", grid, simd_names[level]), grid);
  }
}

static void rows(struct bench *bench) {
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++) {
    const struct bench_scene *scene =
        bench_wants(bench, "gather", scenes[s]) ? bench_scene(bench, scenes[s]) : NULL;
    if (scene) add(bench, scene);
  }
}

const struct part_type part_gather = {
    "gather", "density estimates of radius 0.05 at a film's points; the photons' grid built", 5,
    rows};
