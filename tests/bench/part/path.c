#include "tests/bench/count.h"
#include "tests/bench/measure.h"

#include <string.h>

static const char *const scenes[] = {"box", "cornell-gray"};

// Iteration 1 again and again.
static void again(void *data, int repetition) {
  struct steps *steps = data;
  steps->next = 1;
  steps_run(steps, repetition);
}

// The second half of the film alone gives what it gives as a part of all.
static void check_half(const struct steps *whole, struct bench *bench, const char *name) {
  struct measurement measure = whole->measure;
  measure.pixel += measure.n_points / 2;
  measure.n_points -= measure.n_points / 2;
  struct steps *half = steps_new("path", measure, bench->arena);
  steps_run(half, 0);
  bench_check(memcmp(half->frame, whole->frame + (whole->size - half->size),
                     (size_t)half->size * sizeof *half->frame) == 0,
              "half of the film and all of it differ", name);
}

static void add(struct bench *bench, const struct bench_scene *scene) {
  struct steps *steps = steps_new("path", measure_of(scene, false), bench->arena);
  count_rays();
  again(steps, 0);
  double rays = (double)count_rays() / scene->n_pixels;
  check_half(steps, bench, scene->name);
  bench_add(bench, "path",
            (struct row){.name = arena_format(bench->arena, "%s/paths", scene->name),
                         .kind = RATE,
                         .unit = "Mpaths/s",
                         .work = 1e-6 * scene->n_pixels,
                         .body = again,
                         .data = steps,
                         .hash = steps_hash});
  bench_add(bench, "path",
            (struct row){.name = arena_format(bench->arena, "%s/rays", scene->name),
                         .kind = COUNT,
                         .unit = "rays/path",
                         .work = rays});
}

static void rows(struct bench *bench) {
  for (size_t s = 0; s < sizeof scenes / sizeof scenes[0]; s++) {
    const struct bench_scene *scene =
        bench_wants(bench, "path", scenes[s]) ? bench_scene(bench, scenes[s]) : NULL;
    if (scene) add(bench, scene);
  }
}

const struct part_type part_path = {"path", "path tracing at depth 64; rays: shadow rays included",
                                    5, rows};
