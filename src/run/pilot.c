#include "run/pilot.h"

#include "run/block.h"
#include "run/series.h"

#include <math.h>
#include <stdio.h>

static void make_pilot(struct cell *cell) {
  cell->reference_integrator = cell_can_have_companion(cell) ? "richardson" : "none";
  cell->reference_se = cell->reference_share = 0;
  cell->runs = cell->runs < RUNS_PER_BLOCK ? cell->runs : RUNS_PER_BLOCK;
  cell->n_images = cell->n_singles = cell->n_discs = 0;
  cell->until_se = 0;
  cell->keeps_runs = false;
}

struct experiment pilot_of(const struct experiment *experiment, struct arena *arena) {
  struct experiment pilot = *experiment;
  pilot.cell = arena_new(arena, struct cell, pilot.n_cells);
  for (int c = 0; c < pilot.n_cells; c++) {
    pilot.cell[c] = experiment->cell[c];
    make_pilot(&pilot.cell[c]);
  }
  return pilot;
}

struct moments *pilot_run(const struct group_plan *group, struct arena *arena) {
  struct block block = block_new(group, 0, arena);
  struct progress silent = {.quiet = true};
  block_compute(group, 0, &block, &silent, 0, *arena);
  return block.moments;
}

// The bias of iteration 1 and its standard error, by least squares: an iteration's bias is as rho,
// its variance as 1 / rho.
struct bias {
  double value, se;
};

static struct bias first_bias(const struct cell *cell, const struct moments *difference) {
  double weighted = 0, variance = 0, total = 0;
  for (uint64_t i = 1; i <= cell->iterations; i++) {
    double rho = cell->law->rho(cell->alpha, i);
    weighted += rho * rho * difference[i - 1].mean;
    variance += rho * rho * rho * rho * moments_se2(difference[i - 1]);
    total += rho * rho * rho;
  }
  return (struct bias){fabs(weighted / total), sqrt(variance) / total};
}

static double smallest(const struct group_plan *group, int number, const struct cell *cell,
                       struct moments *moments) {
  double seen = INFINITY, bound = INFINITY;
  for (int p = 0; p < group->n_probes; p++) {
    struct series series = series_of(group, number, p, moments);
    struct bias bias = first_bias(cell, series.richardson);
    if (bias.value > 0 && bias.value >= 2 * bias.se) seen = seen < bias.value ? seen : bias.value;
    if (bias.se > 0) bound = bound < 2 * bias.se ? bound : 2 * bias.se;
  }
  double first = seen < INFINITY ? seen : bound;
  return first * cell->law->rho(cell->alpha, cell->iterations);
}

static bool asks(const struct group_plan *group, const struct experiment *experiment) {
  for (int c = 0; c < group->group->n_cells; c++)
    if (experiment->cell[group->group->cell[c]].reference_share > 0) return true;
  return false;
}

static bool settle_group(const struct group_plan *group, struct run_options options,
                         struct experiment *settled, struct arena scratch,
                         struct problem *problem) {
  struct moments *moments = pilot_run(group, &scratch);
  for (int c = 0; c < group->group->n_cells; c++) {
    struct cell *cell = &settled->cell[group->group->cell[c]];
    if (!(cell->reference_share > 0)) continue;
    double bias = smallest(group, c, cell, moments);
    if (!isfinite(bias))
      return problem_set(
          problem,
          "%s: a block of runs found no light at the probes, so that a share of their "
          "bias is no standard error; say a number",
          cell->scene_path);
    cell->reference_se = cell->reference_share * bias;
    if (!options.quiet)
      fprintf(stderr,
              "photonlab: cell %d: the smallest bias is about %.2g, its reference to %.2g\n",
              cell->number, bias, cell->reference_se);
  }
  return true;
}

bool pilot_settle(const struct experiment *experiment, struct run_options options,
                  struct experiment *settled, struct arena *arena, struct problem *problem) {
  bool any = false;
  *settled = *experiment;
  settled->cell = arena_new(arena, struct cell, settled->n_cells);
  for (int c = 0; c < settled->n_cells; c++) {
    settled->cell[c] = experiment->cell[c];
    any |= experiment->cell[c].reference_share > 0;
  }
  if (!any) return true;
  struct arena scratch = *arena;
  struct experiment pilot = pilot_of(experiment, &scratch);
  struct plan plan;
  if (!plan_make(&pilot, options, &scratch, &plan, problem)) return false;
  for (int g = 0; g < plan.n_groups; g++)
    if (asks(&plan.group[g], experiment) &&
        !settle_group(&plan.group[g], options, settled, scratch, problem))
      return false;
  return true;
}
