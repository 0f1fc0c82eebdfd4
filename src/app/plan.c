// photonlab plan: how many runs an experiment needs for the standard errors that are wanted, and
// how long that takes on this machine, from theory where it is exact and from a block of runs where
// it is not.
#include "analysis/outlook.h"
#include "app/cli.h"
#include "numeric/elementary.h"
#include "run/pilot.h"
#include "run/run.h"
#include "run/series.h"

#include <math.h>
#include <stdio.h>

static const double usual_se = 0.004;

struct planner {
  const struct experiment *experiment; // as the file says
  struct plan plan;                    // of the pilot
  double wanted_se;
  double total_s, needed_s;
};

static void print_head(const struct planner *planner) {
  printf("standard errors of rates with the runs of the file, and what %g takes (s: on one thread; "
         "-: nothing was seen):\n"
         "more runs, or with those of the file about so many iterations or so large a radius, if "
         "its discs stay "
         "clear of edges\n\n",
         planner->wanted_se);
  printf("%4s  %-22s %-13s %7s %9s  %-9s %8s %9s %12s %9s  %-17s %12s\n", "cell", "scene",
         "integrator", "alpha", "probe", "quantity", "runs", "se", "runs needed", "s", "or",
         "reference se");
}

// Theory 4.7: an error of 3 % of the smallest bias moves a rate by half a hundredth.
static double reference_se(const struct outlook *outlook) { return 0.03 * outlook->bias; }

// What else reaches the error wanted. A variance's rate is known to ((K - 1) N)^-1/2; a bias's to
// the noise over the bias, r^(-d / 2) over r^q, while more iterations help it little (theory 4.4).
static void print_instead(const struct planner *planner, const struct cell *cell, double se,
                          double power, double radius, char text[32]) {
  double ratio = se / planner->wanted_se;
  if (!(ratio > 1) || !isfinite(ratio)) return;
  if (isnan(power))
    snprintf(text, 32, "iterations %.0f", ceil((double)cell->iterations * ratio * ratio));
  else if (power > 0 && cell_radius_is_known(cell))
    snprintf(text, 32, "radius %.3g", radius * num_pow(ratio, 1 / power));
}

// The power d / 2 + q of the radius that the bias over the noise goes with; 0: none.
static double bias_power(const struct prediction *theory) {
  double noise = theory->d / 2.0;
  switch (theory->bias_kind) {
  case BIAS_SMOOTH:
    return noise + 2;
  case BIAS_FOURTH:
    return noise + 4;
  case BIAS_SIDE:
    return noise + 1;
  case BIAS_EDGE:
    return noise;
  default:
    return 0;
  }
}

// What a row is of: a quantity's standard error of one run.
struct planned {
  const char *quantity;
  double one_run, power, radius; // power: NAN for a variance
  double reference;              // its standard error; NAN: no matter
};

static double print_row(const struct planner *planner, const struct cell *cell, struct pixel at,
                        struct planned planned, double run_s) {
  char probe[32], needed[32] = "-", seconds[32] = "-", known[32] = "-", instead[32] = "";
  double runs = outlook_runs(planned.one_run, planner->wanted_se),
         se = outlook_se(planned.one_run, (double)cell->runs);
  snprintf(probe, sizeof probe, "%d,%d", at.x, at.y);
  if (isfinite(se)) snprintf(known, sizeof known, "%.4f", se);
  if (isfinite(runs)) {
    snprintf(needed, sizeof needed, "%.0f", runs);
    snprintf(seconds, sizeof seconds, "%.3g", runs * run_s);
  }
  print_instead(planner, cell, se, planned.power, planned.radius, instead);
  printf("%4d  %-22s %-13s %7.4f %9s  %-9s %8.0f %9s %12s %9s  %-17s ", cell->number, cell->scene,
         cell->integrator->name, cell->alpha, probe, planned.quantity, (double)cell->runs, known,
         needed, seconds, instead);
  isfinite(planned.reference) ? printf("%12.2g\n", planned.reference) : printf("%12s\n", "");
  return isfinite(runs) ? runs : 0;
}

// Rows of one cell at one probe; returns the runs that both of them need.
static double print_series(const struct planner *planner, const struct group_plan *group,
                           const struct series *series, const struct prediction *theory,
                           double run_s, struct arena scratch) {
  const struct cell *cell = &planner->experiment->cell[series->cell];
  struct pixel at = group->probe_pixel[series->probe];
  struct outlook outlook = outlook_new(theory, series->iteration ? series : NULL, scratch);
  double most = 0;
  if (cell->quantities & QUANTITY_VARIANCE)
    most = print_row(planner, cell, at,
                     (struct planned){"variance", outlook.variance_se, NAN, NAN, NAN}, run_s);
  if (!(cell->quantities & QUANTITY_BIAS) || isnan(outlook.bias_se)) return most;
  double reference = theory->closed_form || theory->known_bias ? NAN : reference_se(&outlook);
  struct planned bias = {"bias", outlook.bias_se, bias_power(theory), theory->radius, reference};
  double runs = print_row(planner, cell, at, bias, run_s);
  return runs > most ? runs : most;
}

// Whether anything is asked for that no closed form says.
static bool needs_pilot(const struct planner *planner, const struct group_plan *group,
                        const struct prediction *theory) {
  for (int k = 0; k < group->group->n_cells * group->n_probes; k++) {
    int cell = group->group->cell[k / group->n_probes];
    if (!theory[k].closed_form && planner->experiment->cell[cell].quantities) return true;
  }
  return false;
}

static struct prediction *predict(const struct planner *planner, const struct group_plan *group,
                                  struct arena *arena) {
  int n_probes = group->n_probes;
  struct probe *probe = arena_new(arena, struct probe, n_probes);
  struct prediction *theory =
      arena_new(arena, struct prediction, (ptrdiff_t)group->group->n_cells * n_probes);
  plan_probes(group, probe, *arena);
  for (int c = 0; c < group->group->n_cells; c++) {
    const struct cell *cell = &planner->experiment->cell[group->group->cell[c]];
    const struct family *family = prediction_family(cell, arena);
    for (int p = 0; p < n_probes; p++)
      theory[c * n_probes + p] =
          prediction_new(&group->loaded->scene, cell, &probe[p], family, arena);
  }
  return theory;
}

static void plan_group_out(struct planner *planner, int g, struct arena scratch) {
  const struct group_plan *group = &planner->plan.group[g];
  int n_probes = group->n_probes, n = group->group->n_cells * n_probes;
  const struct prediction *theory = predict(planner, group, &scratch);
  double run_s = run_seconds(group, scratch), most = 0;
  struct moments *moments = NULL;
  if (needs_pilot(planner, group, theory)) {
    fprintf(stderr, "photonlab: a pilot of %s, about %.0f s\n", group->cell->scene,
            run_s * (double)group->runs);
    moments = pilot_run(group, &scratch);
  }
  for (int k = 0; k < n; k++) {
    struct series series = {.cell = group->group->cell[k / n_probes], .probe = k % n_probes};
    if (moments) series = series_of(group, k / n_probes, k % n_probes, moments);
    double runs = print_series(planner, group, &series, &theory[k], run_s, scratch);
    most = runs > most ? runs : most;
  }
  planner->total_s += run_s * (double)planner->experiment->cell[group->group->cell[0]].runs;
  planner->needed_s += run_s * most;
}

static bool wanted(const struct cli *cli, const struct experiment *experiment, double *se,
                   struct problem *problem) {
  const char *said = cli_setting_of(cli, "until");
  struct cell cell = {0};
  *se = usual_se;
  for (int c = 0; c < experiment->n_cells; c++)
    if (experiment->cell[c].until_se > 0) *se = experiment->cell[c].until_se;
  if (!said) return true;
  if (!cli_apply(cli, &cell, problem)) return false;
  *se = cell.until_se;
  return true;
}

static int plan(struct cli *cli, struct problem *problem) {
  struct experiment experiment;
  const char *quality = cli->quality ? cli->quality : "default";
  if (!experiment_read(cli->argument, quality, cli->arena, &experiment, problem)) return 1;
  struct experiment pilot = pilot_of(&experiment, cli->arena);
  struct planner planner = {.experiment = &experiment};
  if (!wanted(cli, &experiment, &planner.wanted_se, problem) ||
      !plan_make(&pilot, cli->options, cli->arena, &planner.plan, problem))
    return 1;
  print_head(&planner);
  for (int g = 0; g < planner.plan.n_groups; g++) plan_group_out(&planner, g, *cli->arena);
  int threads = plan_threads(&cli->options);
  printf("\nthe file as it is: %.3g s on %d threads; every rate that is seen to %g: %.3g s\n"
         "(without references; the machine as busy as it is now)\n",
         planner.total_s / threads, threads, planner.wanted_se, planner.needed_s / threads);
  return 0;
}

const struct command command_plan = {
    "plan", "EXPERIMENT", "runs needed for the standard errors wanted, and the time they take",
    "until quality threads lenient", plan};
