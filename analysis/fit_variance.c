// Fisher scoring of the gamma quasi-likelihood: S_i^2 has mean V_i and variance phi_i V_i^2 with
// phi_i = 2/(K-1) + kappa_i/K. Weights come from the fitted V_i, never from S_i^2 itself, which is
// small where it happens to be small (theory 4.4).
#include "analysis/fit_variance.h"

#include "analysis/special.h"

#include <math.h>

// V_i = coefficient[0] (divergent / t [+ rest]) [+ coefficient[1] rest], t = rho(rate) /
// rho(theory).
struct model {
  const struct prediction *theory;
  const double *measured, *dispersion; // S_i^2, phi_i
  int n_coefficients;                  // 1 in closed form
  double *log_ratio, *slope;           // scratch, [n]
};

struct point {
  double coefficient[2], rate;
};

struct row {
  double variance, by[3]; // V_i and its derivatives by the coefficients and the rate
};

static struct row model_row(const struct model *model, const struct point *at, uint64_t j) {
  const struct prediction *theory = model->theory;
  double divergent = theory->divergent[j] * exp(-model->log_ratio[j]);
  double rest = theory->rest ? theory->rest[j] : 0;
  struct row row;
  row.by[0] = theory->closed_form ? divergent + rest : divergent;
  row.by[1] = rest;
  row.variance = at->coefficient[0] * row.by[0];
  if (model->n_coefficients == 2) row.variance += at->coefficient[1] * rest;
  row.by[model->n_coefficients] = -at->coefficient[0] * divergent * model->slope[j];
  return row;
}

// Score, information and value of the quasi-likelihood; false where a variance is not positive.
static bool evaluate(const struct model *model, const struct point *at, bool free_rate,
                     struct normal_equations *eq, double *value) {
  *eq = (struct normal_equations){.n = model->n_coefficients + free_rate};
  *value = 0;
  family_ratio(&model->theory->family, at->rate, model->log_ratio, model->slope);
  for (uint64_t j = model->theory->first; j < model->theory->n; j++) {
    struct row row = model_row(model, at, j);
    if (!(row.variance > 0)) return false;
    double ratio = model->measured[j] / row.variance, weight = 1 / model->dispersion[j];
    for (int a = 0; a < eq->n; a++) row.by[a] /= row.variance;
    normal_add(eq, row.by, ratio - 1, weight);
    *value -= weight * (ratio + log(row.variance));
  }
  return true;
}

static struct point moved(const struct model *model, struct point from, const double *step,
                          double length, bool free_rate) {
  for (int a = 0; a < model->n_coefficients; a++) from.coefficient[a] += length * step[a];
  if (free_rate) from.rate += length * step[model->n_coefficients];
  return from;
}

// Halves the step until the quasi-likelihood rises. Within 1e-3 standard errors of the top its
// rise is lost in rounding, and the whole step is taken.
static bool climb_once(const struct model *model, bool free_rate, const double *step, bool near,
                       struct point *at, struct normal_equations *eq, double *value) {
  for (double length = 1; length > 0x1p-40; length /= 2) {
    struct point next = moved(model, *at, step, length, free_rate);
    struct normal_equations next_eq;
    double next_value;
    if (!evaluate(model, &next, free_rate, &next_eq, &next_value)) continue;
    if (!near && next_value < *value) continue;
    *at = next, *eq = next_eq, *value = next_value;
    return true;
  }
  return false;
}

// Climbs from *at to the top; then *eq is the information there. Done when the next step is worth
// less than 1e-6 standard errors.
static bool climb(const struct model *model, bool free_rate, struct point *at,
                  struct normal_equations *eq) {
  double value, step[SOLVE_MAX];
  if (!evaluate(model, at, free_rate, eq, &value)) return false;
  for (int round = 0; round < 100; round++) {
    if (!normal_solve(eq, step, NULL)) return false;
    double worth = 0;
    for (int a = 0; a < eq->n; a++) worth += step[a] * eq->g[a];
    if (worth < 1e-12) return true;
    if (!climb_once(model, free_rate, step, worth < 1e-6, at, eq, &value)) return false;
  }
  return false;
}

static struct point start(const struct model *model) {
  double sum = 0, weight = 0;
  for (uint64_t j = model->theory->first; j < model->theory->n; j++) {
    double shape = model->theory->divergent[j];
    if (model->theory->closed_form) shape += model->theory->rest[j];
    sum += model->measured[j] / shape / model->dispersion[j];
    weight += 1 / model->dispersion[j];
  }
  return (struct point){{sum / weight, 0}, model->theory->family.theory};
}

// Iterations that are not fitted keep what was measured.
static void fill_variance(const struct model *model, const struct point *at, double *variance) {
  family_ratio(&model->theory->family, at->rate, model->log_ratio, model->slope);
  for (uint64_t j = 0; j < model->theory->n; j++)
    variance[j] = j < model->theory->first ? model->measured[j] : model_row(model, at, j).variance;
}

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

static struct chi2 lack_of_fit(const struct model *model, const struct point *at, bool free_rate,
                               const double *worth, struct arena scratch) {
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
      struct row row = model_row(model, at, j);
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

static bool fit_rate(const struct model *model, struct variance_fit *fit, struct point *best) {
  struct normal_equations eq;
  double unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX];
  if (!climb(model, true, best, &eq) || !normal_solve(&eq, unused, covariance)) return false;
  fit->rate = best->rate;
  fit->rate_se = sqrt(covariance[eq.n - 1][eq.n - 1]);
  fill_variance(model, best, fit->variance);
  return true;
}

static bool fit_coefficient(const struct model *model, struct variance_fit *fit,
                            struct point *held) {
  struct normal_equations eq;
  double unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX];
  if (!climb(model, false, held, &eq) || !normal_solve(&eq, unused, covariance)) return false;
  fit->coefficient = held->coefficient[0];
  fit->coefficient_se = sqrt(covariance[0][0]);
  fill_variance(model, held, fit->expected);
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
  struct model model = {
      .theory = theory,
      .measured = measured,
      .dispersion = fit.dispersion,
      .n_coefficients = theory->closed_form || !theory->rest ? 1 : 2,
      .log_ratio = arena_new(arena, double, n),
      .slope = arena_new(arena, double, n),
  };
  fill_dispersion(theory, runs, 0, fit.dispersion);
  struct point held = start(&model);
  if (!fit_coefficient(&model, &fit, &held)) return fit;
  if (!theory->kurtosis) {
    fill_dispersion(theory, runs, kurtosis_scale(theory, iteration, fit.expected), fit.dispersion);
    if (!fit_coefficient(&model, &fit, &held)) return fit;
  }
  struct point best = held;
  bool rate_found = fit_rate(&model, &fit, &best);
  if (!rate_found) {
    best = held;
    fill_variance(&model, &best, fit.variance);
  }
  fill_worth(runs, fit.dispersion, theory->n, fit.worth);
  fit.lack_of_fit = lack_of_fit(&model, &best, rate_found, fit.worth, *arena);
  fit.null_se = 1 / sqrt(information_of(theory, fit.dispersion));
  fit.dof = 2 / (fit.null_se * fit.null_se);
  fit.why = NULL;
  return fit;
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
