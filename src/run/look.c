#include "run/look.h"

#include "run/block.h"
#include "run/series.h"

enum { FIRST_RUNS = 2 * RUNS_PER_BLOCK }; // of one block alone no variance is known well

static void set_runs(struct group_plan *group, uint64_t runs) {
  group->runs = runs < group->cell->runs ? runs : group->cell->runs;
  group->n_blocks = (group->runs + RUNS_PER_BLOCK - 1) / RUNS_PER_BLOCK;
}

void look_begin(struct plan *plan) {
  for (int g = 0; g < plan->n_groups; g++) {
    struct group_plan *group = &plan->group[g];
    group->looks = 1;
    bool until = group->cell->until_se > 0 && !(plan->options.skip_off & SKIP_RUNS);
    set_runs(group, until ? FIRST_RUNS : group->cell->runs);
  }
}

// Of the runs made so far.
static bool known_well(const struct plan *plan, const struct group_plan *group,
                       struct probe *const *probe, const char *folder, struct arena scratch,
                       struct problem *problem, bool *enough) {
  struct moments *moments = arena_new(&scratch, struct moments, group->width);
  struct results results = {.directory = "the runs made so far",
                            .experiment = *plan->experiment,
                            .probe = (struct probe **)probe};
  int n_cells = plan->experiment->n_cells;
  block_merge(group, folder, moments, scratch);
  results.scene_hash = arena_new(&scratch, uint64_t, n_cells);
  results.n_probes = arena_new(&scratch, int, n_cells);
  results.looks = arena_new(&scratch, int, n_cells);
  results.series =
      arena_new(&scratch, struct series, (ptrdiff_t)group->group->n_cells * group->n_probes);
  for (int c = 0; c < group->group->n_cells; c++) {
    int cell = group->group->cell[c];
    results.n_probes[cell] = group->n_probes;
    results.scene_hash[cell] = group->loaded->scene.hash;
    results.looks[cell] = group->looks;
    for (int p = 0; p < group->n_probes; p++)
      results.series[results.n_series++] = series_of(group, c, p, moments);
  }
  double se = plan->options.largest_rate_se(&results, scratch, problem);
  *enough = se <= group->cell->until_se;
  return !problem->text[0];
}

bool look_again(struct plan *plan, struct probe *const *probe, const char *folder,
                struct arena scratch, struct problem *problem) {
  bool again = false;
  for (int g = 0; g < plan->n_groups; g++) {
    struct group_plan *group = &plan->group[g];
    bool enough;
    if (group->enough || group->runs == group->cell->runs) continue;
    if (!known_well(plan, group, probe, folder, scratch, problem, &enough)) return false;
    group->enough = enough;
    if (enough) continue;
    group->looks++;
    set_runs(group, 2 * group->runs);
    again = true;
  }
  return again;
}

void look_end(struct plan *plan, struct arena *arena) {
  struct experiment *made = arena_new(arena, struct experiment, 1);
  *made = *plan->experiment;
  made->cell = arena_new(arena, struct cell, made->n_cells);
  for (int c = 0; c < made->n_cells; c++) made->cell[c] = plan->experiment->cell[c];
  for (int g = 0; g < plan->n_groups; g++)
    for (int c = 0; c < plan->group[g].group->n_cells; c++)
      made->cell[plan->group[g].group->cell[c]].runs = plan->group[g].runs;
  plan->experiment = made;
}
