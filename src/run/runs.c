#include "run/runs.h"

#include "base/file.h"
#include "log/runs.h"
#include "run/block.h"

static void write_run(FILE *out, const struct group_plan *group, uint64_t run, const double *kept) {
  for (int c = 0; c < group->group->n_cells; c++)
    for (int p = 0; p < group->n_probes; p++) {
      struct series series = {.cell = group->group->cell[c],
                              .probe = p,
                              .n_checkpoints = group->n_checkpoints,
                              .checkpoint = group->checkpoint};
      const double *average = kept + plan_kept(group, c, p);
      runs_write(out, &series, "average", run, average);
      if (group->companion[c])
        runs_write(out, &series, "richardson", run, average + group->n_checkpoints);
    }
}

static void write_group(FILE *out, const struct group_plan *group, const char *folder,
                        struct arena scratch) {
  for (uint64_t b = 0; b < group->n_blocks; b++) {
    struct arena own = scratch; // given back after each block
    struct block block = block_must_read(group, b, folder, &own);
    for (int run = 0; run < block_runs(group, b); run++)
      write_run(out, group, b * RUNS_PER_BLOCK + (uint64_t)run + 1,
                block.kept + run * group->kept_width);
  }
}

bool runs_collect(const struct plan *plan, const char *directory, struct arena scratch,
                  struct problem *problem) {
  struct file_out out;
  if (!runs_are_kept(plan->experiment)) return true;
  if (!file_begin(&out, arena_format(&scratch, "%s/runs.csv", directory), problem)) return false;
  const char *folder = block_folder(plan, directory, &scratch);
  runs_write_header(out.stream);
  for (int g = 0; g < plan->n_groups; g++)
    if (plan->group[g].kept_width) write_group(out.stream, &plan->group[g], folder, scratch);
  return file_commit(&out, problem);
}
