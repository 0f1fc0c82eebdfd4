// Bootstrap over runs (theory 4.4c): the fit of the running averages repeated on runs drawn with
// replacement. Only what is kept of each run can be drawn again, so it is that fit's variance and
// bias at the checkpoints (log/runs.h), not the sharper one of single iterations. Percentile
// intervals of 95 % cover about 91 % (variance) and 92 % (bias) at 50 runs (theory 4.5).
#include "analysis/averages.h"
#include "analysis/fit_methods.h"
#include "analysis/resample.h"

#include <math.h>

// ---- the model's sums, tabulated ----

// Sums over iterations are smooth in the rate: cubic between knots at which values and slopes are
// exact, each made when it is first asked for. The error is h^4 / 384 of the fourth derivative, at
// most (ln N)^4 of the sum itself: 2e-5 of it at N = 1e4. 0 and 1, where a law's family has a kink
// (family.h), are knots.
enum { KNOTS_PER_UNIT = 32, LEAST_RATE = -1, LARGEST_RATE = 2 };
enum { KNOTS = (LARGEST_RATE - LEAST_RATE) * KNOTS_PER_UNIT + 1 };

struct table {
  bool known[KNOTS];
  double *sum[KNOTS], *slope[KNOTS]; // [points]
};

static struct table *table_new(int n, struct arena *arena) {
  struct table *table = arena_new(arena, struct table, 1);
  for (int k = 0; k < KNOTS; k++) {
    table->sum[k] = arena_new(arena, double, n);
    table->slope[k] = arena_new(arena, double, n);
  }
  return table;
}

static void make_known(const struct averages *of, int knot) {
  struct table *table = of->table;
  if (table->known[knot]) return;
  averages_shape(of, LEAST_RATE + (double)knot / KNOTS_PER_UNIT, table->sum[knot],
                 table->slope[knot]);
  table->known[knot] = true;
}

static bool interpolated(const struct averages *of, double rate, double *sum, double *slope) {
  const struct table *table = of->table;
  double x = (rate - LEAST_RATE) * KNOTS_PER_UNIT, h = 1.0 / KNOTS_PER_UNIT;
  if (!(x >= 0 && x < KNOTS - 1)) return false;
  int knot = (int)x;
  double t = x - knot, s = 1 - t;
  make_known(of, knot);
  make_known(of, knot + 1);
  for (int k = 0; k < of->n; k++) {
    double f0 = table->sum[knot][k], f1 = table->sum[knot + 1][k];
    double d0 = h * table->slope[knot][k], d1 = h * table->slope[knot + 1][k];
    sum[k] = s * s * ((1 + 2 * t) * f0 + t * d0) + t * t * ((1 + 2 * s) * f1 - s * d1);
    slope[k] = (6 * t * s * (f1 - f0) + s * (1 - 3 * t) * d0 + t * (1 - 3 * s) * d1) / h;
  }
  return true;
}

// ---- resampling ----

struct estimates {
  double coefficient[RESAMPLES], rate[RESAMPLES];
};

// The averages of each run, of a point's checkpoint, as deviations from `mean`.
static double *deviations(const struct series *series, int checkpoint, int runs, double mean,
                          struct arena *arena) {
  double *x = arena_new(arena, double, runs);
  for (int k = 0; k < runs; k++) x[k] = series->run_average[checkpoint * runs + k] - mean;
  return x;
}

// What is measured at the points, in each resample.
struct measured {
  const struct averages *of;
  int runs;
  double **x;         // [points] deviations of the runs
  const double *base; // the same where the iterations that are fitted begin; NULL: with the first
  const double *y;    // [points] of all runs as they are
  double *count;      // [runs] scratch
};

static void measure_again(const struct measured *all, int b, double *y) {
  const struct averages *of = all->of;
  const struct prediction *theory = of->theory;
  double normal, before = 0;
  resample_runs(b, all->runs, all->count, &normal);
  if (all->base) before = resample_moments(all->runs, all->count, all->base).mean;
  for (int k = 0; k < of->n; k++) {
    struct resampled here = resample_moments(all->runs, all->count, all->x[k]);
    double fitted = of->offset[k], error = normal * theory->truth_se; // of the reference
    y[k] = of->logarithm ? log(here.variance) - of->offset[k]
                         : all->y[k] + here.mean - (1 - fitted) * before - fitted * error;
  }
}

static bool fit_rate(const struct gls_model *gls, const struct averages *of,
                     struct gls_solution *at) {
  return of->logarithm ? gls_descend(gls, of->n_terms + 1, at)
                       : gls_best(gls, LEAST_RATE, LARGEST_RATE, at);
}

// Fits each resample, starting where all runs as they are end. False: there is no such start.
static bool resample(struct averages *of, const struct series *series, double coefficient,
                     double rate, bool has_rate, struct estimates *out, struct arena scratch) {
  int runs = (int)series->iteration[0].n, rate_at = of->n_terms;
  struct measured all = {.of = of,
                         .runs = runs,
                         .x = arena_new(&scratch, double *, of->n),
                         .y = of->y,
                         .count = arena_new(&scratch, double, runs)};
  for (int k = 0; k < of->n; k++)
    all.x[k] = deviations(series, of->at[k], runs, series->average[of->at[k]].mean, &scratch);
  for (int c = 0; !of->logarithm && c < series->n_checkpoints; c++)
    if (series->checkpoint[c] == of->theory->first)
      all.base = deviations(series, c, runs, series->average[c].mean, &scratch);
  struct gls_solution held = {.x = {coefficient}}, best;
  held.x[rate_at] = rate;
  of->table = table_new(of->n, &scratch);
  of->shape = interpolated;
  if (!gls_factor(of->n, of->omega)) return false;
  struct gls_model gls = averages_model(of, &scratch);
  double *y = arena_new(&scratch, double, of->n);
  if (!gls_descend(&gls, rate_at, &held)) return false;
  best = held;
  has_rate = has_rate && fit_rate(&gls, of, &best);
  gls.y = y;
  for (int b = 0; b < RESAMPLES; b++) {
    struct gls_solution held_again = held, best_again = best;
    measure_again(&all, b + 1, y);
    bool found = gls_descend(&gls, rate_at, &held_again);
    out->coefficient[b] = found ? held_again.x[0] : NAN;
    found = has_rate && fit_rate(&gls, of, &best_again);
    out->rate[b] = found ? best_again.x[rate_at] : NAN;
  }
  return true;
}

// ---- what is said ----

static const char no_fit[] = "resampled runs have no fit";

// A variance's standard error goes by the squares of the runs' deviations. Such an estimate has
// the relative variance (kurtosis + 2) / K, and the excess kurtosis of a squared normal value is
// 12, of sums of them less: at least as well known as with K / 7 degrees of freedom.
static double variance_dof(double runs) { return runs / 7; }

static const char *variance(const struct prediction *theory, const struct series *series,
                            const double *weights, struct variance_fit *v, struct arena scratch) {
  const char *why = fit_gls_estimators.variance(theory, series, weights, v, scratch);
  if (why) return why;
  struct averages of = averages_of_variance(theory, series, weights, v->dispersion, &scratch);
  struct estimates *estimates = arena_new(&scratch, struct estimates, 1);
  struct spread_of_resamples spread;
  int runs = (int)series->iteration[0].n;
  if (!resample(&of, series, v->coefficient, theory->family.theory, isfinite(v->rate_se), estimates,
                scratch) ||
      !resample_spread(estimates->coefficient, runs, &spread))
    return no_fit;
  v->coefficient_se = spread.se;
  v->coefficient_deviate = log(v->coefficient) * v->coefficient / spread.se;
  v->deviate_dof = variance_dof(runs);
  if (!resample_spread(estimates->rate, runs, &spread))
    spread = (struct spread_of_resamples){INFINITY, NAN, NAN};
  v->rate_se = spread.se, v->rate_lo = spread.lo, v->rate_hi = spread.hi;
  v->rate_deviate = (v->rate - theory->family.theory) / spread.se;
  return NULL;
}

// The iterations that are not fitted end at a checkpoint: only there is anything kept of each run.
static struct prediction from_checkpoint(const struct prediction *theory,
                                         const struct series *series) {
  struct prediction from = *theory;
  for (int c = series->n_checkpoints - 1; theory->first > 0 && c >= 0; c--)
    if (series->checkpoint[c] >= theory->first) from.first = series->checkpoint[c];
  return from;
}

static void bias(const struct prediction *whole, const struct series *series, const double *weights,
                 const struct variance_fit *v, struct bias_fit *b, struct arena scratch) {
  struct prediction theory = from_checkpoint(whole, series);
  double rate = bias_theory_rate(&theory);
  int runs = (int)series->iteration[0].n;
  fit_gls_estimators.bias(&theory, series, weights, v, b, scratch);
  if (!b->measured) return;
  struct averages of = averages_of_bias(&theory, series, weights, &scratch);
  struct estimates *estimates = arena_new(&scratch, struct estimates, 1);
  struct spread_of_resamples spread;
  b->measured = resample(&of, series, b->coefficient, isnan(rate) ? 0 : rate, b->rate_found,
                         estimates, scratch) &&
                resample_spread(estimates->coefficient, runs, &spread);
  if (!b->measured) return;
  b->dof = runs - 1;
  b->coefficient_se = spread.se;
  b->snr = fabs(b->coefficient) / spread.se;
  b->rate_found = b->rate_found && resample_spread(estimates->rate, runs, &spread);
  if (!b->rate_found) return;
  b->rate_se = spread.se, b->rate_lo = spread.lo, b->rate_hi = spread.hi;
  b->rate_deviate = (b->rate - rate) / spread.se;
}

bool fit_can_bootstrap(const struct results *results, struct problem *problem) {
  for (int s = 0; s < results->n_series; s++) {
    const struct series *series = &results->series[s];
    const struct cell *cell = &results->experiment.cell[series->cell];
    if (!cell->quantities) continue;
    if (!series->run_average)
      return problem_set(problem,
                         "%s: cell %d keeps moments, and a bootstrap needs its runs: say `keep: "
                         "runs` in the experiment and run it again, or take --method gls",
                         results->directory, series->cell);
    if (series->iteration[0].n < RESAMPLE_LEAST_RUNS)
      return problem_set(problem,
                         "%s: cell %d has %g runs, and a bootstrap needs %d: raise `runs` in the "
                         "experiment and run it again, or take --method likelihood",
                         results->directory, series->cell, series->iteration[0].n,
                         RESAMPLE_LEAST_RUNS);
  }
  return true;
}

const struct fit_estimators fit_bootstrap_estimators = {variance, bias};

void fit_series_bootstrap(const struct results *results, const struct series *series,
                          const struct prediction *theory, struct arena scratch, struct fit *fit) {
  fit_series_by(&fit_bootstrap_estimators, results, series, theory, scratch, fit);
}
