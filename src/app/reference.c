// photonlab reference: what an experiment's bias is measured against, sampled ahead of it.
#include "app/cli.h"
#include "run/interrupt.h"
#include "run/run.h"

#include <math.h>
#include <stdio.h>

// Cells that share a reference say the same: one line for each.
static bool said_before(const struct plan *plan, struct probe *const *probe, int c) {
  const struct cell *mine = &plan->experiment->cell[c];
  for (int k = 0; k < c; k++)
    if (strcmp(plan->experiment->cell[k].scene_path, mine->scene_path) == 0 &&
        probe[k][0].x == probe[c][0].x && probe[k][0].y == probe[c][0].y &&
        probe[k][0].reference == probe[c][0].reference)
      return true;
  return false;
}

// Where there is light, and no sample met it, the standard error is not that of the reference.
static void print_probe(const char *scene, const struct probe *probe) {
  bool dark = probe->hit && probe->reference == probe->emitted && probe->reference_se == 0;
  printf("%-24s %6d %6d %14.8g %10.2g%s\n", scene, probe->x, probe->y, probe->reference,
         probe->reference_se, dark ? "  no light found" : "");
}

static void print_group(const struct plan *plan, const struct group_plan *group,
                        struct probe *const *probe) {
  for (int e = 0; e < group->group->n_cells; e++) {
    int c = group->group->cell[e];
    if (isnan(probe[c][0].reference) || said_before(plan, probe, c)) continue;
    for (int p = 0; p < group->n_probes; p++)
      print_probe(plan->experiment->cell[c].scene, &probe[c][p]);
  }
}

static void print_all(const struct plan *plan, struct probe *const *probe) {
  int sampled = 0;
  for (int c = 0; c < plan->experiment->n_cells; c++) sampled += !isnan(probe[c][0].reference);
  if (sampled == 0) {
    printf("no cell asks for a traced reference (reference: {integrator: path, se: ...})\n");
    return;
  }
  printf("%-24s %6s %6s %14s %10s\n", "scene", "x", "y", "reference", "se");
  for (int g = 0; g < plan->n_groups; g++) print_group(plan, &plan->group[g], probe);
}

static int reference(struct cli *cli, struct problem *problem) {
  struct experiment experiment;
  struct plan plan;
  const char *quality = cli->quality ? cli->quality : "default";
  if (!experiment_read(cli->argument, quality, cli->arena, &experiment, problem)) return 1;
  const char *directory =
      cli->output ? cli->output : arena_format(cli->arena, "results/%s", experiment.name);
  struct probe **probe = arena_new(cli->arena, struct probe *, experiment.n_cells);
  switch (run_references(&experiment, directory, cli->options, probe, &plan, cli->arena, problem)) {
  case RUN_DONE:
    print_all(&plan, probe);
    return 0;
  case RUN_INTERRUPTED:
    return 128 + interrupt_signal();
  default:
    return 1;
  }
}

const struct command command_reference = {
    "reference", "EXPERIMENT", "samples the references of an experiment that are not cached yet",
    "output quality threads quiet lenient no-skip", reference};
