#include "tests/bench/measure.h"

#include "base/problem.h"

#include <unistd.h>

// Whether an iteration costs more, and holds more, after 10^5 of them. Few pixels and photons, so
// that so many take seconds.
enum { SIDE = 4, FEW_PHOTONS = 64, SOON = 1000, LATE = 100000, REPETITIONS = 10 };

static const char *const integrators[] = {"probabilistic", "sppm"};

static double resident(void) {
  long pages = 0;
  FILE *file = fopen("/proc/self/statm", "r");
  if (!file || fscanf(file, "%*d %ld", &pages) != 1) die("bench: /proc/self/statm is no use");
  fclose(file);
  return 1e-6 * (double)pages * (double)sysconf(_SC_PAGESIZE);
}

static struct measurement measure_few(const struct bench_scene *scene, struct arena *arena) {
  struct measurement measure = measure_of(scene, true);
  struct pixel *pixel = arena_new(arena, struct pixel, SIDE * SIDE);
  const struct camera *camera = &scene->scene.camera;
  for (int j = 0; j < SIDE * SIDE; j++)
    pixel[j] = (struct pixel){camera->width * (2 * (j % SIDE) + 1) / (2 * SIDE),
                              camera->height * (2 * (j / SIDE) + 1) / (2 * SIDE)};
  measure.pixel = pixel;
  measure.n_points = SIDE * SIDE;
  measure.n_emitted = FEW_PHOTONS;
  return measure;
}

static void add_resident(struct bench *bench, const char *integrator, const char *after) {
  bench_add(bench, "long",
            (struct row){.name = arena_format(bench->arena, "%s/resident-%s", integrator, after),
                         .kind = COUNT,
                         .unit = "MB",
                         .work = resident()});
}

static const char *add_cost(struct bench *bench, struct steps *steps, const char *after,
                            const char *base) {
  const char *name = arena_format(bench->arena, "%s/%s", steps->integrator->name, after);
  bench_add(bench, "long",
            (struct row){.name = name,
                         .kind = COST,
                         .unit = "s/iteration",
                         .work = steps->each,
                         .body = steps_run,
                         .data = steps,
                         .base = base,
                         .mean = true});
  return name;
}

static void add(struct bench *bench, const struct bench_scene *scene, const char *integrator) {
  struct measurement measure = measure_few(scene, bench->arena);
  struct steps *early = steps_new(integrator, measure, bench->arena),
               *late = steps_new(integrator, measure, bench->arena);
  steps_check(early, 2, integrator);
  early->each = SOON;
  steps_run(early, 0);
  late->each = SOON;
  steps_run(late, 0);
  bench_check(steps_hash(early) == steps_hash(late), "two runs differ", integrator);
  add_resident(bench, integrator, "1e3");
  while (late->next <= LATE) steps_run(late, 0);
  add_resident(bench, integrator, "1e5");
  const char *base = add_cost(bench, early, "after-1e3", NULL);
  add_cost(bench, late, "after-1e5", base);
}

static void rows(struct bench *bench) {
  for (size_t k = 0; k < sizeof integrators / sizeof integrators[0]; k++)
    if (bench_wants(bench, "long", integrators[k]))
      add(bench, bench_scene(bench, "box"), integrators[k]);
}

const struct part_type part_long = {
    "long", "a tenth of 10^5 iterations, the first and the one after them: 16 pixels, 64 photons",
    REPETITIONS, rows};
