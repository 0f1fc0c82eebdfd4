// Weighted least squares: mean_i - truth = b_i(rate) + offset, weights K/V_i from the fitted
// variance, the offset with a Gaussian prior of the reference's standard error. Coefficients are
// linear; the rate is profiled.
#include "analysis/fit_bias.h"

#include "analysis/special.h"

#include <math.h>

// Columns of the linear part: the bias at the rate of the last bias_family, bias2, and 1 if the
// reference is uncertain. The second term stays at theory's radii: it is a correction, and if it
// moved with the rate it could pass for the first term at half the rate.
struct model {
  const struct prediction *theory;
  const double *difference, *weight; // [n]
  int n_terms, n_columns;
  double offset_precision;
  double *shape, *slope; // [n], of bias_family
};

struct solution {
  double chi2, x[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX];
};

static void columns(const struct model *model, uint64_t j, double column[SOLVE_MAX]) {
  int n = 0;
  column[n++] = model->shape[j];
  if (model->n_terms == 2) column[n++] = model->theory->bias2[j];
  if (model->offset_precision > 0) column[n++] = 1;
}

// d b_i / d rate.
static double rate_column(const struct model *model, uint64_t j, const double *x) {
  return x[0] * model->slope[j];
}

static struct normal_equations begin(const struct model *model, int n) {
  struct normal_equations eq = {.n = n};
  if (model->offset_precision > 0) {
    int offset = model->n_columns - 1;
    eq.h[offset][offset] = model->offset_precision;
  }
  return eq;
}

static void drop_second_term(struct normal_equations *eq) {
  for (int a = 0; a < eq->n; a++) eq->h[1][a] = eq->h[a][1] = 0;
  eq->h[1][1] = 1;
  eq->g[1] = 0;
}

static bool solve_linear(struct model *model, double rate, struct solution *solution) {
  bias_family(model->theory, rate, model->shape, model->slope);
  struct normal_equations eq = begin(model, model->n_columns);
  double total = 0, column[SOLVE_MAX];
  for (uint64_t j = model->theory->first; j < model->theory->n; j++) {
    columns(model, j, column);
    normal_add(&eq, column, model->difference[j], model->weight[j]);
    total += model->weight[j] * model->difference[j] * model->difference[j];
  }
  *solution = (struct solution){0};
  if (!normal_solve(&eq, solution->x, solution->covariance)) {
    if (model->n_terms < 2) return false;
    drop_second_term(&eq); // at the rate of a constant radius the two are one
    if (!normal_solve(&eq, solution->x, solution->covariance)) return false;
  }
  solution->chi2 = total;
  for (int a = 0; a < eq.n; a++) solution->chi2 -= solution->x[a] * eq.g[a];
  return true;
}

// ---- the profile over the rate ----

enum { SCAN = 24 }; // steps over the rates that are searched
static const double least_rate = -1, largest_rate = 2;

static double profile(struct model *model, double rate) {
  struct solution solution;
  return solve_linear(model, rate, &solution) ? solution.chi2 : INFINITY;
}

// Golden section, to 1e-9 of a rate.
static double lowest_between(struct model *model, double lo, double hi) {
  const double golden = 0.6180339887498949;
  double a = hi - golden * (hi - lo), b = lo + golden * (hi - lo);
  double at_a = profile(model, a), at_b = profile(model, b);
  while (hi - lo > 1e-7) {
    if (at_a < at_b) {
      hi = b, b = a, at_b = at_a;
      a = hi - golden * (hi - lo), at_a = profile(model, a);
    } else {
      lo = a, a = b, at_a = at_b;
      b = lo + golden * (hi - lo), at_b = profile(model, b);
    }
  }
  return (lo + hi) / 2;
}

// Where the profile crosses `level` between a rate below it and one above.
static double crossing(struct model *model, double below, double above, double level) {
  while (fabs(above - below) > 1e-6) {
    double middle = (below + above) / 2;
    *(profile(model, middle) < level ? &below : &above) = middle;
  }
  return (below + above) / 2;
}

struct scan {
  double rate[SCAN + 1], chi2[SCAN + 1];
  int lowest;
};

static struct scan scan_rates(struct model *model) {
  struct scan scan = {.lowest = 0};
  double lo = least_rate, hi = largest_rate;
  for (int k = 0; k <= SCAN; k++) {
    scan.rate[k] = lo + (hi - lo) * k / SCAN;
    scan.chi2[k] = profile(model, scan.rate[k]);
    if (scan.chi2[k] < scan.chi2[scan.lowest]) scan.lowest = k;
  }
  return scan;
}

// The ends of the interval in which the profile stays below `level`; false: it does not end.
static bool interval(struct model *model, const struct scan *scan, double best, double level,
                     double *lo, double *hi) {
  double inside = best;
  int k = scan->lowest;
  while (k >= 0 && (scan->rate[k] > best || scan->chi2[k] < level)) {
    if (scan->rate[k] < best) inside = scan->rate[k];
    k--;
  }
  if (k < 0) return false;
  *lo = crossing(model, inside, scan->rate[k], level);
  inside = best, k = scan->lowest;
  while (k <= SCAN && (scan->rate[k] < best || scan->chi2[k] < level)) {
    if (scan->rate[k] > best) inside = scan->rate[k];
    k++;
  }
  if (k > SCAN) return false;
  *hi = crossing(model, inside, scan->rate[k], level);
  return true;
}

// Standard error of the rate from the curvature at the best fit.
static double curvature_se(struct model *model, const struct solution *best) {
  struct normal_equations eq = begin(model, model->n_columns + 1);
  double row[SOLVE_MAX], unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX];
  for (uint64_t j = model->theory->first; j < model->theory->n; j++) {
    columns(model, j, row);
    row[model->n_columns] = rate_column(model, j, best->x);
    normal_add(&eq, row, 0, model->weight[j]);
  }
  if (!normal_solve(&eq, unused, covariance)) return INFINITY;
  return sqrt(covariance[eq.n - 1][eq.n - 1]);
}

// Leaves the model at the best rate, or at theory's where none is found.
static bool find_rate(struct model *model, const struct solution *theory, struct solution *best,
                      double variance_dof, struct bias_fit *fit) {
  double two_sided_95 = special_t_quantile(0.025, variance_dof);
  struct scan scan = scan_rates(model);
  if (scan.lowest == 0 || scan.lowest == SCAN) return false;
  double rate = lowest_between(model, scan.rate[scan.lowest - 1], scan.rate[scan.lowest + 1]), lo,
         hi;
  if (!solve_linear(model, rate, best)) return false;
  if (!interval(model, &scan, rate, best->chi2 + two_sided_95 * two_sided_95, &lo, &hi))
    return false;
  if (!solve_linear(model, rate, best)) return false;
  fit->rate = rate, fit->rate_lo = lo, fit->rate_hi = hi;
  fit->rate_se = curvature_se(model, best);
  double gain = theory->chi2 - best->chi2; // below zero by rounding only
  double deviate = gain > 0 ? sqrt(gain) : 0;
  fit->rate_deviate = rate > bias_theory_rate(model->theory) ? deviate : -deviate;
  return true;
}

// ---- lack of fit ----

static struct chi2 lack_of_fit(const struct model *model, const struct solution *at, bool free_rate,
                               const double *worth, struct arena scratch) {
  uint64_t n = model->theory->n, j = model->theory->first;
  int parameters = model->n_columns + free_rate;
  struct bins bins = bins_new(worth, model->theory->first, n, 1, &scratch);
  double *deviate = arena_new(&scratch, double, bins.n);
  double(*direction)[SOLVE_MAX] = arena_alloc(&scratch, bins.n, sizeof *direction, alignof(double));
  for (int b = 0; b < bins.n; b++) {
    double held = 0, sum = 0, row[SOLVE_MAX];
    for (; j < bins.end[b]; j++) {
      columns(model, j, row);
      double residual = model->difference[j];
      for (int a = 0; a < model->n_terms; a++) residual -= at->x[a] * row[a];
      if (free_rate) row[model->n_columns] = rate_column(model, j, at->x);
      held += model->weight[j];
      sum += model->weight[j] * residual;
      for (int a = 0; a < parameters; a++) direction[b][a] += model->weight[j] * row[a];
    }
    for (int a = 0; a < parameters; a++) direction[b][a] /= sqrt(held);
    deviate[b] = sum / sqrt(held);
  }
  double prior[SOLVE_MAX] = {0};
  if (model->offset_precision > 0) prior[model->n_columns - 1] = model->offset_precision;
  return bins_chi2(bins.n, deviate, direction, parameters, prior);
}

static void fill_expected(const struct model *model, const struct solution *at, double *expected) {
  for (uint64_t j = 0; j < model->theory->n; j++) {
    double column[SOLVE_MAX];
    columns(model, j, column);
    expected[j] = j < model->theory->first ? model->difference[j] : 0;
    if (j < model->theory->first) continue;
    for (int a = 0; a < model->n_terms; a++) expected[j] += at->x[a] * column[a];
  }
}

struct bias_fit fit_bias(const struct prediction *theory, const struct moments *iteration,
                         const struct variance_fit *v, const double *variance,
                         struct arena *arena) {
  struct bias_fit fit = {.dof = v->dof};
  ptrdiff_t n = (ptrdiff_t)theory->n;
  if (!isfinite(theory->truth) || !isfinite(theory->truth_se)) return fit;
  double *difference = arena_new(arena, double, n), *weight = arena_new(arena, double, n);
  for (ptrdiff_t j = 0; j < n; j++) {
    difference[j] = iteration[j].mean - theory->truth;
    weight[j] = iteration[j].n / variance[j];
  }
  struct model model = {
      .theory = theory,
      .difference = difference,
      .weight = weight,
      .n_terms = theory->bias2 ? 2 : 1,
      .shape = arena_new(arena, double, n),
      .slope = arena_new(arena, double, n),
  };
  if (theory->truth_se > 0) model.offset_precision = 1 / (theory->truth_se * theory->truth_se);
  model.n_columns = model.n_terms + (model.offset_precision > 0);

  struct solution held, best;
  double rate = bias_theory_rate(theory);
  if (!solve_linear(&model, rate, &held)) return fit;
  fit.measured = true;
  fit.coefficient = held.x[0];
  fit.coefficient_se = sqrt(held.covariance[0][0]);
  fit.snr = fabs(fit.coefficient) / fit.coefficient_se;
  fit.expected = arena_new(arena, double, n);
  fill_expected(&model, &held, fit.expected);
  fit.lack_of_fit = lack_of_fit(&model, &held, false, v->worth, *arena);
  if (theory->unbiased) return fit;
  if (isnan(rate)) return fit;
  fit.rate_se_theory = curvature_se(&model, &held);
  fit.rate_found = find_rate(&model, &held, &best, fit.dof, &fit);
  if (fit.rate_found) fit.lack_of_fit = lack_of_fit(&model, &best, true, v->worth, *arena);
  return fit;
}
