#include "tests/bench/clock.h"
#include "tests/bench/measure.h"
#include "tests/bench/trial.h"

#include "base/problem.h"

// Each skip has an experiment of its name, which tests/cli/skip.sh runs with it and without it,
// too; here it is of quality "paper", which is larger.
static struct trial *trial_of(struct bench *bench, const struct skip_row *skip, bool without) {
  struct trial *trial =
      trial_new(bench, arena_format(bench->arena, "tests/data/skips/%s.yaml", skip->name), "paper",
                arena_format(bench->arena, "skip-%s/%s", skip->name, without ? "without" : "with"));
  trial->options.threads = 1;
  if (without) trial->options.skip_off = skip->bit;
  return trial;
}

// ---- rows ----
// `name` as it is, and with --no-skip.
static void add(struct bench *bench, const char *name, double work, void (*body)(void *, int),
                void *with, void *without) {
  struct row row = {
      .name = name, .kind = COST, .unit = "s", .work = work, .body = body, .pair = true};
  row.data = with;
  bench_add(bench, "skip", row);
  row.name = arena_format(bench->arena, "%s/no-skip", name);
  row.base = name;
  row.data = without;
  bench_add(bench, "skip", row);
}

// Iterations that last for some 20 ms.
static int enough(const struct steps *steps) {
  struct arena arena = arena_reserve(), reserved = arena;
  struct steps *own = steps_new(steps->integrator->name, steps->measure, &arena);
  steps_run(own, 0);
  struct seconds begin = clock_now();
  int n = 0;
  for (; clock_since(begin).cpu < 0.02; n++) steps_run(own, 0);
  arena_release(reserved);
  return n;
}

static void add_group(struct bench *bench, const char *name, const struct group_plan *with,
                      const struct group_plan *without) {
  const char *integrator = with->cell->integrator->name;
  struct steps *steps[2] = {steps_new(integrator, with->measure, bench->arena),
                            steps_new(integrator, without->measure, bench->arena)};
  steps[0]->each = steps[1]->each = enough(steps[1]);
  add(bench, name, steps[0]->each, steps_run, steps[0], steps[1]);
}

// An iteration of each group of cells.
static void add_groups(struct bench *bench, const struct skip_row *skip,
                       struct trial *const trial[2]) {
  struct plan *plan = arena_new(bench->arena, struct plan, 2);
  struct problem problem = {{0}};
  for (int side = 0; side < 2; side++)
    if (!plan_make(&trial[side]->experiment, trial[side]->options, bench->arena, &plan[side],
                   &problem))
      die("%s", problem.text);
  for (int g = 0; g < plan[0].n_groups; g++) {
    const struct cell *cell = plan[0].group[g].cell;
    const char *name =
        arena_format(bench->arena, "%s/%s/%s", skip->name, cell->scene, cell->integrator->name);
    if (bench_wants(bench, "skip", name))
      add_group(bench, name, &plan[0].group[g], &plan[1].group[g]);
  }
}

static void rows(struct bench *bench) {
  for (int k = 0; k < n_skip_rows; k++) {
    const struct skip_row *skip = &skip_rows[k];
    if (!bench_wants(bench, "skip", skip->name)) continue;
    struct trial *trial[2] = {trial_of(bench, skip, false), trial_of(bench, skip, true)};
    trial_check_same(trial[0], trial[1], skip->bit == SKIP_RUNS);
    if (skip->bit & (SKIP_RUNS | SKIP_REFERENCES))
      add(bench,
          arena_format(bench->arena, "%s/%s/run", skip->name, trial[0]->experiment.cell[0].scene),
          1, trial_run, trial[0], trial[1]);
    else
      add_groups(bench, skip, trial);
  }
}

const struct part_type part_skip = {
    "skip", "what skipping saves, of an iteration (run: of a whole experiment)", 7, rows};
