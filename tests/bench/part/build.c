#include "tests/bench/embree.h"

#include "bvh/tree.h"

#include <string.h>

static const char *const scenes[] = {"torus", "ball-1e5", "ball-1e6"};

struct job {
  const struct scene *scene;
  const struct bvh *bvh;
  struct arena arena; // where each build begins
};

static const struct bvh *built(const struct job *job, int threads) {
  struct arena arena = job->arena;
  return bvh_build(job->scene, (struct bvh_options){.threads = threads}, &arena);
}

static void build(void *data, int repetition) {
  struct job *job = data;
  (void)repetition;
  job->bvh = built(job, 1);
}

static uint64_t hash(const void *data) {
  const struct bvh *bvh = ((const struct job *)data)->bvh;
  return bench_hash(bvh->node, bvh->n_nodes * sizeof *bvh->node) +
         31 * bench_hash(bvh->block, bvh->n_blocks * sizeof *bvh->block);
}

static void check_threads(struct job *job, const char *name) {
  build(job, 0);
  uint64_t one = hash(job);
  job->bvh = built(job, 2);
  bench_check(hash(job) == one, "trees by one and two threads differ", name);
  build(job, 0);
}

static void peer(void *data, int repetition) {
  struct job *job = data;
  struct arena arena = job->arena;
  (void)repetition;
  embree_release(embree_new(job->scene, false, &arena));
}

static void add_row(struct bench *bench, struct job *job, const char *scene, const char *who,
                    void (*body)(void *, int), const char *base) {
  bench_add(bench, "build",
            (struct row){.name = arena_format(bench->arena, "%s/%s", scene, who),
                         .kind = COST,
                         .unit = "s",
                         .work = 1,
                         .body = body,
                         .data = job,
                         .hash = body == build ? hash : NULL,
                         .base = base});
}

static void add(struct bench *bench, const struct bench_scene *scene) {
  struct job *job = arena_new(bench->arena, struct job, 1);
  *job = (struct job){.scene = &scene->scene, .arena = arena_reserve()};
  check_threads(job, scene->name);
  bool embree = embree_modes[0].name;
  if (embree) add_row(bench, job, scene->name, "embree", peer, NULL);
  add_row(bench, job, scene->name, "photonlab", build,
          embree ? arena_format(bench->arena, "%s/embree", scene->name) : NULL);
  bench_add(bench, "build",
            (struct row){.name = arena_format(bench->arena, "%s/bytes", scene->name),
                         .kind = COUNT,
                         .unit = "B/triangle",
                         .work = bvh_statistics(job->bvh).bytes_per_primitive});
}

static void rows(struct bench *bench) {
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++)
    if (bench_wants(bench, "build", scenes[s])) add(bench, bench_scene(bench, scenes[s]));
}

const struct part_type part_build = {
    "build", "trees built by one thread, the scene's own vertices not counted", 3, rows};
