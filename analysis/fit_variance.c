// The rate with the coefficients free, the coefficients with the rate held at theory; how far the
// measured variances scatter by themselves; whether the model fits them.
#include "analysis/fit_variance.h"

#include "analysis/special.h"
#include "analysis/variance_model.h"

#include <math.h>

// ---- kurtosis ----

// The fourth cumulant of K values, unbiased (k-statistic).
static double fourth_cumulant(struct moments m) {
  double n = m.n;
  return (n * (n + 1) * m.m4 - 3 * (n - 1) * m.m2 * m.m2) / ((n - 1) * (n - 2) * (n - 3));
}

// Excess kurtosis goes as one over the photons in the disc, as `divergent` does; its scale is taken
// from the fourth moments of all iterations, or with fewer than four runs from the scatter of the
// measured variances. Sums of rare photons have none below zero, so an estimate below is zero.
static double kurtosis_scale(const struct prediction *theory, const struct moments *iteration,
                             const double *variance) {
  double sum = 0, shape = 0, runs = iteration[0].n;
  for (uint64_t j = theory->first; j < theory->n; j++) {
    double v2 = variance[j] * variance[j];
    double scatter = moments_variance(iteration[j]) - variance[j];
    sum += runs >= 4 ? fourth_cumulant(iteration[j]) / v2
                     : runs * (scatter * scatter / v2 - 2 / (runs - 1));
    shape += theory->divergent[j];
  }
  return sum > 0 ? sum / shape : 0;
}

static void fill_dispersion(const struct prediction *theory, double runs, double kurtosis,
                            double *dispersion) {
  for (uint64_t j = 0; j < theory->n; j++) {
    double excess = theory->kurtosis ? theory->kurtosis[j] : kurtosis * theory->divergent[j];
    dispersion[j] = 2 / (runs - 1) + excess / runs;
  }
}

// ---- lack of fit ----

// A bin needs so many over its relative variance to move in proportion to the parameters, and so
// many photons, one over the excess kurtosis, to be taken as gamma distributed: without any, which
// a gamma never is, it is then once in e^20.
static const double enough_information = 5, enough_photons = 20;

static void fill_worth(double runs, const double *dispersion, uint64_t n, double *worth) {
  for (uint64_t j = 0; j < n; j++) {
    double excess = dispersion[j] - 2 / (runs - 1);
    worth[j] = fmin(1 / dispersion[j] / enough_information,
                    excess > 0 ? 1 / excess / enough_photons : INFINITY);
  }
}

static struct chi2 lack_of_fit(const struct variance_model *model, const struct variance_point *at,
                               bool free_rate, const double *worth, struct arena scratch) {
  uint64_t n = model->theory->n;
  int parameters = model->n_coefficients + free_rate;
  struct bins bins = bins_new(worth, model->theory->first, n, 1, &scratch);
  double *deviate = arena_new(&scratch, double, bins.n);
  double(*direction)[SOLVE_MAX] = arena_alloc(&scratch, bins.n, sizeof *direction, alignof(double));
  family_ratio(&model->theory->family, at->rate, model->log_ratio, model->slope);
  uint64_t j = model->theory->first;
  for (int b = 0; b < bins.n; b++) {
    double held = 0, ratio = 0;
    for (; j < bins.end[b]; j++) {
      struct variance_row row = variance_model_row(model, at, j);
      double information = 1 / model->dispersion[j];
      held += information;
      ratio += information * model->measured[j] / row.variance;
      for (int a = 0; a < parameters; a++)
        direction[b][a] += information * row.by[a] / row.variance;
    }
    for (int a = 0; a < parameters; a++) direction[b][a] /= sqrt(held);
    deviate[b] = special_gamma_deviate(ratio / held, 1 / held);
  }
  return bins_chi2(bins.n, deviate, direction, parameters, (double[SOLVE_MAX]){0});
}

// ---- all of it ----

static bool fit_rate(const struct variance_model *model, struct variance_fit *fit,
                     struct variance_point *best) {
  struct normal_equations eq;
  double unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX];
  if (!variance_model_climb(model, true, best, &eq) || !normal_solve(&eq, unused, covariance))
    return false;
  fit->rate = best->rate;
  fit->rate_se = sqrt(covariance[eq.n - 1][eq.n - 1]);
  variance_model_fill(model, best, fit->variance);
  return true;
}

static bool fit_coefficient(const struct variance_model *model, struct variance_fit *fit,
                            struct variance_point *held) {
  struct normal_equations eq;
  double unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX];
  if (!variance_model_climb(model, false, held, &eq) || !normal_solve(&eq, unused, covariance))
    return false;
  fit->coefficient = held->coefficient[0];
  fit->coefficient_se = sqrt(covariance[0][0]);
  variance_model_fill(model, held, fit->expected);
  return true;
}

static bool all_the_same(const struct moments *iteration, uint64_t first, uint64_t n) {
  for (uint64_t j = first; j < n; j++)
    if (iteration[j].m2 != 0) return false;
  return true;
}

static bool all_exact(const struct prediction *theory, const struct moments *iteration) {
  for (uint64_t j = theory->first; j < theory->n; j++)
    if (iteration[j].m2 != 0 || iteration[j].mean != theory->truth) return false;
  return true;
}

static bool is_dark(const struct prediction *theory) {
  for (uint64_t j = theory->first; j < theory->n; j++)
    if (theory->divergent[j] != 0) return false;
  return true;
}

static double information_of(const struct prediction *theory, const double *dispersion) {
  double sum = 0;
  for (uint64_t j = theory->first; j < theory->n; j++) sum += 1 / dispersion[j];
  return sum;
}

// Bounded by e^-(photons expected) where they are rare (a kurtosis is one over their number) and by
// e^-(K - 1)/2 an iteration where they are not.
static double silence(const struct prediction *theory, double runs) {
  if (!theory->closed_form || !theory->independent) return NAN;
  double information = 0;
  for (uint64_t j = theory->first; j < theory->n; j++)
    information += 1 / (2 / (runs - 1) + fmax(theory->kurtosis[j], 0) / runs);
  return exp(-information);
}

static const char *why_not(const struct prediction *theory, const struct moments *iteration,
                           double *improbable) {
  double runs = iteration[0].n;
  if (theory->why_not) return theory->why_not;
  if (theory->first == theory->n) return "no disc is clear of edges";
  if (runs < 2) return "one run";
  if (is_dark(theory)) {
    if (!all_exact(theory, iteration)) *improbable = 0;
    return "no light";
  }
  if (!all_the_same(iteration, theory->first, theory->n)) return NULL;
  *improbable = silence(theory, runs);
  return "all runs the same";
}

struct variance_fit fit_variance(const struct prediction *theory, const struct moments *iteration,
                                 struct arena *arena) {
  struct variance_fit fit = {.silence = NAN, .rate = NAN, .rate_se = INFINITY};
  ptrdiff_t n = (ptrdiff_t)theory->n;
  double runs = iteration[0].n;
  if ((fit.why = why_not(theory, iteration, &fit.silence))) return fit;
  fit.why = "the fit does not converge";
  double *measured = arena_new(arena, double, n);
  for (ptrdiff_t j = 0; j < n; j++) measured[j] = moments_variance(iteration[j]);
  fit.variance = arena_new(arena, double, n);
  fit.expected = arena_new(arena, double, n);
  fit.dispersion = arena_new(arena, double, n);
  fit.worth = arena_new(arena, double, n);
  struct variance_model model = {
      .theory = theory,
      .measured = measured,
      .dispersion = fit.dispersion,
      .n_coefficients = theory->closed_form || !theory->rest ? 1 : 2,
      .log_ratio = arena_new(arena, double, n),
      .slope = arena_new(arena, double, n),
  };
  fill_dispersion(theory, runs, 0, fit.dispersion);
  struct variance_point held = variance_model_start(&model);
  if (!fit_coefficient(&model, &fit, &held)) return fit;
  if (!theory->kurtosis) {
    fill_dispersion(theory, runs, kurtosis_scale(theory, iteration, fit.expected), fit.dispersion);
    if (!fit_coefficient(&model, &fit, &held)) return fit;
  }
  struct variance_point best = held;
  bool rate_found = fit_rate(&model, &fit, &best);
  if (!rate_found) {
    best = held;
    variance_model_fill(&model, &best, fit.variance);
  }
  fill_worth(runs, fit.dispersion, theory->n, fit.worth);
  fit.lack_of_fit = lack_of_fit(&model, &best, rate_found, fit.worth, *arena);
  fit.null_se = 1 / sqrt(information_of(theory, fit.dispersion));
  fit.dof = 2 / (fit.null_se * fit.null_se);
  fit.why = NULL;
  variance_fit_judge(&fit, theory);
  return fit;
}

void variance_fit_judge(struct variance_fit *fit, const struct prediction *theory) {
  double half = special_normal_quantile(0.025) * fit->rate_se;
  fit->rate_lo = fit->rate - half, fit->rate_hi = fit->rate + half;
  fit->rate_deviate = (fit->rate - theory->family.theory) / fit->rate_se;
  fit->coefficient_deviate = special_gamma_deviate(fit->coefficient, fit->null_se * fit->null_se);
  fit->deviate_dof = INFINITY;
}

// Both are sums of the same squares; the first has their products between iterations besides, each
// of variance V_i V_j / (K - 1). So the ratio's variance needs no kurtosis: it is chi-squared with
// K - 1 degrees of freedom over their number, and with few iterations less spread than that.
double fit_independence(const struct variance_fit *fit, const struct series *series,
                        double *ratio) {
  *ratio = NAN;
  if (fit->why || series->n_checkpoints < 1) return NAN;
  uint64_t n = series->checkpoint[series->n_checkpoints - 1];
  struct moments average = series->average[series->n_checkpoints - 1];
  double pooled = 0;
  for (uint64_t j = 0; j < n; j++) pooled += moments_variance(series->iteration[j]);
  if (n < 2 || !(average.n >= 2) || !(pooled > 0)) return NAN;
  *ratio = moments_variance(average) * (double)n * (double)n / pooled;
  return special_gamma_deviate(*ratio, 2 / (average.n - 1));
}
