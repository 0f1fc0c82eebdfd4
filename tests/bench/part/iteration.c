#include "tests/bench/measure.h"

#include <string.h>

// Repetitions of ten iterations each: 11 to 60 in all, after 1 to 10, which are not timed. Their
// mean is what peers were timed by; the quartiles show how it changes with the iteration. Ten cells
// and the dearest of them alone are for their ratio: iterations 3 to 12.
enum { EACH = 10, EACH_TEN_CELLS = 2, REPETITIONS = 5 };

static const struct {
  const char *scene, *integrator;
  bool nee;    // 65,536 photons emitted; else about as many stored, direct light by photons too
  bool alphas; // ten cells
} asked[] = {
    {"box", "probabilistic", true, false},
    {"cornell-gray", "probabilistic", true, false},
    {"cornell-gray", "sppm", true, false},
    {"cornell-gray", "sppm", false, false},
    {"cornell-gray", "probabilistic", true, true},
    {"cornell-glass", "sppm", true, false},
    {"cornell-torus-glass", "probabilistic", true, false},
    {"cornell-torus-glass", "sppm", true, false},
};

// Emitted photons of which about PHOTONS are stored.
static uint64_t emitted_for(const struct measurement *measure) {
  struct arena arena = arena_reserve(), start = arena;
  struct photon_map *map = photon_map_new(measure, &arena);
  const double r[POINT_KINDS] = {0.05, 0.05};
  photon_map_see(map, 1);
  photon_map_emit(map, 1, r);
  double each = (double)map->field[ON_SURFACE].photons.count / (double)measure->n_emitted;
  arena_release(start);
  return (uint64_t)(PHOTONS / each);
}

// Five alphas by two kernels; the dearest is the first: the largest radius and the dearer kernel.
static void ten_cells(struct measurement *measure, struct arena *arena) {
  static const double alpha[] = {0.9, 0.8, 2.0 / 3, 0.5, 0.3};
  struct estimator *cell = arena_new(arena, struct estimator, 10);
  for (int e = 0; e < 10; e++) {
    cell[e] = measure->estimator[0];
    cell[e].alpha = alpha[e % 5];
    cell[e].kernel = kernel_find(e < 5 ? "gaussian" : "epanechnikov");
  }
  measure->estimator = cell;
  measure->n_estimators = 10;
}

static const char *add_steps(struct bench *bench, const char *name, const char *integrator,
                             const struct measurement *measure, int each, const char *base) {
  if (!bench_wants(bench, "iteration", name)) return name;
  struct steps *steps = steps_new(integrator, *measure, bench->arena);
  steps_check(steps, 2, name);
  steps->each = each;
  bench_add(bench, "iteration",
            (struct row){.name = name,
                         .kind = COST,
                         .unit = "s/iteration",
                         .work = each,
                         .body = steps_run,
                         .data = steps,
                         .base = base,
                         .mean = true});
  return name;
}

static void add_ten(struct bench *bench, const char *name, const char *integrator,
                    struct measurement *measure) {
  ten_cells(measure, bench->arena);
  measure->n_estimators = 1;
  const char *one = add_steps(bench, arena_format(bench->arena, "%s-dearest-cell", name),
                              integrator, measure, EACH_TEN_CELLS, NULL);
  measure->n_estimators = 10;
  add_steps(bench, arena_format(bench->arena, "%s-ten-cells", name), integrator, measure,
            EACH_TEN_CELLS, one);
}

static void add_emitted(struct bench *bench, const char *name, const struct measurement *measure) {
  bench_add(bench, "iteration",
            (struct row){.name = arena_format(bench->arena, "%s-emitted", name),
                         .kind = COUNT,
                         .unit = "photons",
                         .work = (double)measure->n_emitted});
}

static void rows(struct bench *bench) {
  for (size_t k = 0; k < sizeof asked / sizeof asked[0]; k++) {
    const char *name = arena_format(bench->arena, "%s/%s%s", asked[k].scene, asked[k].integrator,
                                    asked[k].nee ? "" : "-stored");
    const struct bench_scene *scene =
        bench_wants(bench, "iteration", name) ? bench_scene(bench, asked[k].scene) : NULL;
    if (!scene) continue;
    struct measurement measure = measure_of(scene, asked[k].nee);
    if (!asked[k].nee) {
      measure.n_emitted = emitted_for(&measure);
      add_emitted(bench, name, &measure);
    }
    if (asked[k].alphas)
      add_ten(bench, name, asked[k].integrator, &measure);
    else
      add_steps(bench, name, asked[k].integrator, &measure, EACH, NULL);
  }
}

const struct part_type part_iteration = {
    "iteration",
    "whole iterations 11 to 60, 65,536 photons emitted and next-event estimation (or stored)",
    REPETITIONS, rows};
