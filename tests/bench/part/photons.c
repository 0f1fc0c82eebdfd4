#include "tests/bench/measure.h"

#include "walk/photons.h"

#include <string.h>

static const char *const scenes[] = {"box",          "torus",         "ball-1e5",
                                     "cornell-gray", "cornell-glass", "cornell-torus-glass"};

struct job {
  struct walk *walk;
  struct photons photons;
  struct arena *arena;
};

static void trace_part(struct job *job, uint64_t first, uint64_t end) {
  struct photon_pass pass = {.n_emitted = end, .depth = DEPTH, .first = first};
  struct photon_sinks sinks = {.surface = {&job->photons, NULL}};
  walk_begin(job->walk, 1, 1, 1);
  photons_trace(job->walk, &pass, &sinks, job->arena);
}

static void trace(void *data, int repetition) {
  (void)repetition;
  trace_part(data, 0, PHOTONS);
}

static uint64_t hash(const void *data) {
  const struct photons *photons = &((const struct job *)data)->photons;
  size_t n = (size_t)photons->count;
  return bench_hash(photons->position, n * sizeof *photons->position) +
         31 * bench_hash(photons->wi, n * sizeof *photons->wi) +
         37 * bench_hash(photons->flux[0], n * sizeof *photons->flux[0]);
}

static struct job *job_new(const struct bench_scene *scene, struct arena *arena) {
  struct job *job = arena_new(arena, struct job, 1);
  job->arena = arena_new(arena, struct arena, 1);
  *job->arena = arena_reserve();
  job->walk = walk_new(&scene->scene, scene->bvh, scene_features(&scene->scene), arena);
  job->walk->key = rng_key(1, 1, RNG_PHOTONS);
  return job;
}

// As threads share a pass out: in parts, put together again.
static void check_parts(const struct job *whole, struct job *other, const char *name) {
  struct job joined = *other;
  joined.photons = (struct photons){0};
  for (uint64_t first = 0; first < PHOTONS; first += PHOTONS / 4) {
    trace_part(other, first, first + PHOTONS / 4);
    photons_append(&joined.photons, &other->photons, joined.arena);
  }
  bench_check(joined.photons.count == whole->photons.count && hash(&joined) == hash(whole),
              "photons traced in parts and at once differ", name);
}

static void add(struct bench *bench, const struct bench_scene *scene) {
  struct job *job = job_new(scene, bench->arena);
  trace(job, 0);
  check_parts(job, job_new(scene, bench->arena), scene->name);
  bench_add(bench, "photons",
            (struct row){.name = arena_format(bench->arena, "%s/emitted", scene->name),
                         .kind = RATE,
                         .unit = "Mphotons/s",
                         .work = 1e-6 * PHOTONS,
                         .body = trace,
                         .data = job,
                         .hash = hash});
  bench_add(bench, "photons",
            (struct row){.name = arena_format(bench->arena, "%s/stored", scene->name),
                         .kind = COUNT,
                         .unit = "per emitted",
                         .work = (double)job->photons.count / PHOTONS});
}

static void rows(struct bench *bench) {
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++) {
    const struct bench_scene *scene =
        bench_wants(bench, "photons", scenes[s]) ? bench_scene(bench, scenes[s]) : NULL;
    if (scene) add(bench, scene);
  }
}

const struct part_type part_photons = {"photons", "photon paths traced and stored", 5, rows};
