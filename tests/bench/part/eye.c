#include "tests/bench/measure.h"

#include "estimate/photon_map.h"

#include <string.h>

static const char *const scenes[] = {"box", "torus", "cornell-gray", "cornell-torus-glass"};

struct job {
  struct measurement measure;
  struct photon_map *map;
  double *frame;
};

static void see(void *data, int repetition) {
  (void)repetition;
  photon_map_see(((struct job *)data)->map, 1);
}

static void direct(void *data, int repetition) {
  struct job *job = data;
  (void)repetition;
  memset(job->frame, 0, (size_t)photon_map_frame(&job->measure) * sizeof *job->frame);
  photon_map_add_seen(job->map, 1, job->frame);
}

// Places, directions and weights: of the point's bytes those that are always written.
static uint64_t hash_points(const void *data) {
  const struct job *job = data;
  uint64_t sum = 0;
  for (int j = 0; j < job->measure.n_points; j++) {
    const struct eye_point *point = &job->map->point[j];
    sum = 31 * sum + bench_hash(&point->p, sizeof point->p);
    sum = 31 * sum + bench_hash(&point->wo, sizeof point->wo);
    sum = 31 * sum + bench_hash(point->weight, sizeof point->weight);
    sum = 31 * sum + bench_hash(point->emitted, sizeof point->emitted);
  }
  return sum;
}

static uint64_t hash_frame(const void *data) {
  const struct job *job = data;
  return bench_hash(job->frame, (size_t)photon_map_frame(&job->measure) * sizeof *job->frame);
}

static struct job *job_new(struct measurement measure, struct arena *arena) {
  struct job *job = arena_new(arena, struct job, 1);
  job->measure = measure;
  job->measure.keep_points = true;
  job->map = photon_map_new(&job->measure, arena);
  job->frame = arena_new(arena, double, photon_map_frame(&measure));
  see(job, 0);
  direct(job, 0);
  return job;
}

static void check_half(const struct job *whole, struct arena *arena, const char *name) {
  struct measurement measure = whole->measure;
  measure.pixel += measure.n_points / 2;
  measure.n_points -= measure.n_points / 2;
  const struct job *half = job_new(measure, arena);
  long size = photon_map_frame(&measure), skipped = photon_map_frame(&whole->measure) - size;
  bench_check(memcmp(half->frame, whole->frame + skipped, (size_t)size * sizeof(double)) == 0,
              "half of the film and all of it differ", name);
}

static void add(struct bench *bench, const struct bench_scene *scene) {
  struct job *job = job_new(measure_of(scene, true), bench->arena);
  double work = 1e-6 * job->measure.n_points;
  check_half(job, bench->arena, scene->name);
  bench_add(bench, "eye",
            (struct row){.name = arena_format(bench->arena, "%s/points", scene->name),
                         .kind = RATE,
                         .unit = "Mpoints/s",
                         .work = work,
                         .body = see,
                         .data = job,
                         .hash = hash_points});
  bench_add(bench, "eye",
            (struct row){.name = arena_format(bench->arena, "%s/direct", scene->name),
                         .kind = RATE,
                         .unit = "Mpoints/s",
                         .work = work,
                         .body = direct,
                         .data = job,
                         .hash = hash_frame});
}

static void rows(struct bench *bench) {
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++) {
    const struct bench_scene *scene =
        bench_wants(bench, "eye", scenes[s]) ? bench_scene(bench, scenes[s]) : NULL;
    if (scene) add(bench, scene);
  }
}

const struct part_type part_eye = {
    "eye", "the eye pass at pixel footprints, and next-event estimation at its points", 5, rows};
