#include "run/run.h"

#include "base/file.h"
#include "run/block.h"
#include "run/interrupt.h"
#include "run/look.h"
#include "run/output.h"
#include "run/pilot.h"
#include "run/progress.h"
#include "run/reference.h"

#include <stdlib.h>
#include <string.h>

// One block of one group.
struct unit {
  int group;
  uint64_t block;
  double work; // seconds expected on one thread
  bool begun, refused;
};

struct units {
  struct unit *item;
  ptrdiff_t count, capacity;
  double total_s, left_s; // of the groups that have something left: all their blocks; those listed
};

double run_seconds(const struct group_plan *plan, struct arena scratch) {
  enum { PLACES = 5 };
  const struct measurement *measure = &plan->measure;
  const struct integrator_type *integrator = plan->cell->integrator;
  double *frame =
      arena_new(&scratch, double,
                (long)measure->n_estimators * measure->n_points * measure->features.n_channels);
  void *state = integrator->create(measure, &scratch);
  integrator->begin(state, 1);
  integrator->step(state, 1, frame); // warms up
  double started = progress_clock_s(), elapsed = 0;
  uint64_t steps = 0;
  for (; elapsed < 0.05; elapsed = progress_clock_s() - started, steps++) {
    uint64_t place = 2 * (steps + 1) % PLACES; // the middle first: slow scenes get no further
    integrator->step(state, 1 + (plan->cell->iterations - 1) * place / (PLACES - 1), frame);
  }
  return elapsed / (double)steps * (double)plan->cell->iterations;
}

static int unit_order(const void *a, const void *b) {
  const struct unit *left = a, *right = b;
  if (left->work != right->work) return left->work > right->work ? -1 : 1;
  if (left->group != right->group) return left->group < right->group ? -1 : 1;
  return left->block < right->block ? -1 : 1;
}

// The blocks of one group that no file holds.
static void add_missing(const struct plan *plan, int g, const char *folder, struct units *units,
                        struct arena *arena) {
  const struct group_plan *group = &plan->group[g];
  ptrdiff_t first = units->count;
  for (uint64_t b = 0; b < group->n_blocks; b++) {
    struct arena scratch = *arena;
    if (!block_times(group, b, folder, &scratch))
      *arena_push(arena, units) = (struct unit){.group = g, .block = b};
  }
  if (units->count == first) return;
  bool matters = plan->n_groups > 1 || !plan->options.quiet; // for their order, or to be said
  double run_s = matters ? run_seconds(group, *arena) : 0;
  units->total_s += run_s * (double)group->runs;
  for (ptrdiff_t k = first; k < units->count; k++) {
    units->item[k].work = run_s * block_runs(group, units->item[k].block);
    units->left_s += units->item[k].work;
  }
}

// What is still to be done, the largest first.
static struct units units_left(const struct plan *plan, const char *folder, struct arena *arena) {
  struct units units = {0};
  for (int g = 0; g < plan->n_groups && !interrupt_signal(); g++)
    add_missing(plan, g, folder, &units, arena);
  if (units.count) qsort(units.item, (size_t)units.count, sizeof *units.item, unit_order);
  return units;
}

// ---- all units on all threads ----
// Runs are taken in their order by whoever is free, so that a few of them keep all threads busy,
// and added to their block in that order. What waits for its turn is never more than a run.

// The block that runs are being added to.
struct open_block {
  struct arena arena, kept; // `kept`: where it begins
  struct block block;
  struct block_sum sum;
};

static void add_run(const struct plan *plan, const struct unit *unit, const struct worker *worker,
                    const char *folder, struct open_block *open) {
  const struct group_plan *group = &plan->group[unit->group];
  if ((worker->run - 1) % RUNS_PER_BLOCK == 0) {
    open->arena = open->kept;
    open->block = block_new(group, unit->block, &open->arena);
    open->sum = block_begin(group, unit->block, &open->block, &open->arena);
  }
  if (block_add(&open->sum, worker, &open->arena))
    block_write(group, unit->block, folder, &open->block, open->arena);
}

// Whether the unit is computed: an interrupted run finishes those it has begun.
static bool goes_on(struct unit *unit) {
  bool on;
#pragma omp critical(unit)
  {
    if (!unit->begun) unit->refused |= interrupt_signal() != 0;
    unit->begun = true;
    on = !unit->refused;
  }
  return on;
}

struct run_of_unit {
  struct unit *unit;
  uint64_t run;
};

static struct run_of_unit *runs_of(const struct plan *plan, const struct units *units,
                                   ptrdiff_t *count, struct arena *arena) {
  struct {
    struct run_of_unit *item;
    ptrdiff_t count, capacity;
  } runs = {0};
  for (ptrdiff_t k = 0; k < units->count; k++) {
    struct unit *unit = &units->item[k];
    int n = block_runs(&plan->group[unit->group], unit->block);
    for (int run = 1; run <= n; run++)
      *arena_push(arena, &runs) =
          (struct run_of_unit){unit, unit->block * RUNS_PER_BLOCK + (uint64_t)run};
  }
  *count = runs.count;
  return runs.item;
}

static void compute_all(const struct plan *plan, const char *folder, const struct units *units,
                        struct progress *progress, struct arena scratch) {
  ptrdiff_t n;
  const struct run_of_unit *runs = runs_of(plan, units, &n, &scratch);
  struct open_block open = {.kept = scratch};
#pragma omp parallel num_threads(plan_threads(&plan->options)) if (n > 1)
  {
    struct arena reserved = arena_reserve(), own = reserved;
    struct worker *worker = NULL; // of a group; made again for another
#pragma omp for schedule(dynamic, 1) ordered
    for (ptrdiff_t k = 0; k < n; k++) {
      struct unit *unit = runs[k].unit;
      const struct group_plan *group = &plan->group[unit->group];
      if (!goes_on(unit)) continue;
      if (!worker || worker->plan != group) {
        own = reserved;
        worker = worker_new(group, &own);
      }
      worker_run(worker, runs[k].run, progress, unit->work / block_runs(group, unit->block));
#pragma omp ordered
      add_run(plan, unit, worker, folder, &open);
    }
    arena_release(reserved);
  }
}

static char *references_of(const char *directory, struct arena *arena) {
  return arena_format(arena, "%s/../references", directory);
}

// Of all groups, by the first cell of each: cells that share paths rarely differ in their
// reference.
static double references_left_s(const struct plan *plan, const char *directory,
                                struct arena scratch) {
  double left_s = 0;
  for (int g = 0; g < plan->n_groups && !interrupt_signal(); g++)
    left_s +=
        reference_left_s(&plan->group[g], &plan->experiment->cell[plan->group[g].group->cell[0]],
                         references_of(directory, &scratch), scratch);
  return left_s;
}

// Probes of all cells, with references. False without a problem: interrupted.
static bool probes_make(const struct plan *plan, const char *directory, struct probe **probe,
                        struct arena *arena, struct problem *problem) {
  char *references = references_of(directory, arena);
  for (int g = 0; g < plan->n_groups; g++) {
    const struct group_plan *group = &plan->group[g];
    for (int e = 0; e < group->group->n_cells; e++) {
      int c = group->group->cell[e];
      probe[c] = arena_new(arena, struct probe, group->n_probes);
      plan_probes(group, probe[c], *arena);
      if (!reference_make(group, &plan->experiment->cell[c], &plan->options, references, probe[c],
                          *arena, problem))
        return false;
    }
  }
  return true;
}

static enum run_outcome interrupted(const char *directory) {
  fprintf(stderr,
          "photonlab: interrupted; what is finished is kept in %s. The same command goes on from "
          "there.\n",
          directory);
  return RUN_INTERRUPTED;
}

// "results/alpha/" -> "results/alpha".
static const char *without_slashes(const char *path, struct arena *arena) {
  ptrdiff_t length = (ptrdiff_t)strlen(path);
  while (length > 1 && path[length - 1] == '/') length--;
  return arena_string(arena, path, length);
}

// Says what is ahead.
static void announce(const struct plan *plan, const struct units *units, const char *directory,
                     struct arena scratch) {
  if (plan->options.quiet) return;
  int threads = plan_threads(&plan->options);
  double references_s = references_left_s(plan, directory, scratch);
  double total_s = units->left_s + references_s;
  fprintf(stderr,
          "%s: about %.0f s of computation (%.0f s of it references), %.0f s on %d threads\n",
          plan->experiment->name, total_s, references_s, total_s / threads, threads);
}

// The blocks that are missing. False: interrupted.
static bool make_blocks(const struct plan *plan, const struct units *units, const char *folder,
                        struct arena scratch) {
  struct progress progress = progress_begin(plan->experiment->name, units->total_s,
                                            units->total_s - units->left_s, plan->options.quiet);
  compute_all(plan, folder, units, &progress, scratch);
  progress_end(&progress);
  return !interrupt_signal();
}

// Blocks until every group has its runs: at once, or look by look. False without a problem:
// interrupted.
static bool make_runs(struct plan *plan, struct units units, struct probe *const *probe,
                      const char *folder, struct arena scratch, struct problem *problem) {
  for (struct arena own = scratch;;) {
    if (!make_blocks(plan, &units, folder, own)) return false;
    if (!look_again(plan, probe, folder, own, problem)) return !problem->text[0];
    own = scratch;
    units = units_left(plan, folder, &own);
  }
}

enum run_outcome run_experiment(const struct experiment *experiment, const char *path,
                                struct run_options options, struct arena *arena,
                                struct problem *problem) {
  struct plan plan;
  const char *directory = without_slashes(path, arena);
  if (!plan_make(experiment, options, arena, &plan, problem) || !output_check_names(&plan, problem))
    return RUN_FAILED;
  if (output_is_complete(&plan, directory, *arena)) {
    block_remove_all(&plan, directory, *arena); // if it was killed between its last two steps
    if (!options.quiet) fprintf(stderr, "photonlab: %s is up to date\n", directory);
    return RUN_DONE;
  }
  const char *folder = block_folder(&plan, directory, arena);
  if (!output_set_aside(&plan, directory, *arena, problem) || !file_make_directory(folder, problem))
    return RUN_FAILED;
  interrupt_install();
  struct experiment settled;
  if (!pilot_settle(experiment, options, &settled, arena, problem)) return RUN_FAILED;
  plan.experiment = &settled;
  struct units units = units_left(&plan, folder, arena);
  announce(&plan, &units, directory, *arena);
  struct probe **probe = arena_new(arena, struct probe *, experiment->n_cells);
  if (!probes_make(&plan, directory, probe, arena, problem))
    return problem->text[0] ? RUN_FAILED : interrupted(directory);
  if (!make_runs(&plan, units, probe, folder, *arena, problem))
    return problem->text[0] ? RUN_FAILED : interrupted(directory);
  look_end(&plan, arena);
  struct outputs outputs = {&plan, probe, directory};
  return output_write(&outputs, *arena, problem) ? RUN_DONE : RUN_FAILED;
}

enum run_outcome run_references(const struct experiment *experiment, const char *path,
                                struct run_options options, struct probe **probe, struct plan *plan,
                                struct arena *arena, struct problem *problem) {
  const char *directory = without_slashes(path, arena);
  if (!plan_make(experiment, options, arena, plan, problem)) return RUN_FAILED;
  interrupt_install();
  struct experiment *settled = arena_new(arena, struct experiment, 1);
  if (!pilot_settle(experiment, options, settled, arena, problem)) return RUN_FAILED;
  plan->experiment = settled;
  if (probes_make(plan, directory, probe, arena, problem)) return RUN_DONE;
  return problem->text[0] ? RUN_FAILED : interrupted(references_of(directory, arena));
}
