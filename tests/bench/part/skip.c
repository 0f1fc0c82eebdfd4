#define _GNU_SOURCE // nftw
#include "tests/bench/measure.h"

#include "analysis/fit.h"
#include "base/file.h"
#include "base/problem.h"
#include "run/run.h"
#include "tests/bench/clock.h"

#include <ftw.h>
#include <string.h>

// Each skip has an experiment of its name, which tests/cli/skip.sh runs with it and without it,
// too; here it is of quality "paper", which is larger.
struct job {
  struct experiment experiment;
  struct run_options options;
  const char *directory;
};

static const char *sides[] = {"with", "without"}; // the skip

static struct job job_new(struct bench *bench, const struct skip_row *skip, bool without) {
  struct job job = {
      .options = {.threads = 1, .quiet = true, .largest_rate_se = fit_largest_rate_se},
      .directory =
          arena_format(bench->arena, "%s/skips/%s/%s", bench->folder, skip->name, sides[without])};
  struct problem problem = {{0}};
  if (without) job.options.skip_off = skip->bit;
  if (!experiment_read(arena_format(bench->arena, "tests/data/skips/%s.yaml", skip->name), "paper",
                       bench->arena, &job.experiment, &problem))
    die("%s", problem.text);
  return job;
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *at) {
  (void)info, (void)type, (void)at;
  return remove(path);
}

static void run(void *data, int repetition) {
  const struct job *job = data;
  struct arena arena = arena_reserve(), reserved = arena;
  struct problem problem = {{0}};
  (void)repetition;
  nftw(job->directory, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  if (run_experiment(&job->experiment, job->directory, job->options, &arena, &problem) != RUN_DONE)
    die("%s", problem.text);
  arena_release(reserved);
}

// ---- what is measured is the same ----
static bool ends(const char *path, const char *with) {
  size_t n = strlen(path), m = strlen(with);
  return n >= m && strcmp(path + n - m, with) == 0;
}

static struct text read_text(const char *path, struct arena *arena) {
  struct text text;
  struct problem problem = {{0}};
  if (!file_read(path, arena, &text, &problem)) die("%s", problem.text);
  return text;
}

static const struct job *compared[2]; // nftw takes no data
static int n_compared;

static int compare(const char *path, const struct stat *info, int type, struct FTW *at) {
  (void)info, (void)at;
  bool runs = compared[1]->options.skip_off & SKIP_RUNS; // then those made are the first
  bool asked = ends(path, "runs.csv") || (!runs && (ends(path, "log.csv") || ends(path, ".exr")));
  if (type != FTW_F || !asked) return 0;
  struct arena arena = arena_reserve(), reserved = arena;
  const char *below = path + strlen(compared[0]->directory);
  struct text a = read_text(path, &arena);
  struct text b = read_text(arena_format(&arena, "%s%s", compared[1]->directory, below), &arena);
  bool same = (runs ? a.length < b.length : a.length == b.length) &&
              memcmp(a.data, b.data, (size_t)a.length) == 0;
  bench_check(same, "what is measured with it and without it differs", path);
  arena_release(reserved);
  n_compared++;
  return 0;
}

static void check_same(const struct job job[2], const char *skip) {
  n_compared = 0;
  for (int side = 0; side < 2; side++) {
    compared[side] = &job[side];
    run((void *)&job[side], 0);
  }
  nftw(job[0].directory, compare, 16, FTW_PHYS);
  bench_check(n_compared > 0, "nothing could be compared", skip);
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
static void add_groups(struct bench *bench, const struct skip_row *skip, const struct job job[2]) {
  struct plan *plan = arena_new(bench->arena, struct plan, 2);
  struct problem problem = {{0}};
  for (int side = 0; side < 2; side++)
    if (!plan_make(&job[side].experiment, job[side].options, bench->arena, &plan[side], &problem))
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
    struct job *job = arena_new(bench->arena, struct job, 2);
    for (int side = 0; side < 2; side++) job[side] = job_new(bench, skip, side);
    check_same(job, skip->name);
    if (!(skip->bit & (SKIP_RUNS | SKIP_SAMPLED))) {
      add_groups(bench, skip, job);
      continue;
    }
    const char *name =
        arena_format(bench->arena, "%s/%s/run", skip->name, job->experiment.cell[0].scene);
    add(bench, name, 1, run, &job[0], &job[1]);
  }
}

const struct part_type part_skip = {
    "skip", "what skipping saves, of an iteration (run: of a whole experiment)", 7, rows};
