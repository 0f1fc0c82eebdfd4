// The running averages at the log's checkpoints: ln S^2(N) and b(N) as sums of the same model over
// iterations, with the covariance of curves that share their past (theory 4.2, 4.4b). Biases are on
// the linear scale and keep their sign. Iterations before the first that is fitted stand as
// measured.
#include "analysis/fit_methods.h"

#include "analysis/bias_family.h"
#include "analysis/gls.h"
#include "analysis/special.h"
#include "analysis/variance_model.h"

#include <math.h>

// ---- variance ----

// The logarithm of a variance is nearly normal from so many runs, and from so many photons in the
// average (a kurtosis is one over their number).
static const double least_runs = 10, least_photons = 20;

struct of_variance {
  struct variance_model *model;
  const uint64_t *checkpoint;
  int n;
  double before; // sum of the variances of the iterations that are not fitted
};

// ln Var(N), Var(N) = N^-2 sum of V_i: with one coefficient A S-(N) / N^2 and what stays constant.
static bool variance_at(const void *of, const double *x, double *f, double *by) {
  const struct of_variance *v = of;
  const struct prediction *theory = v->model->theory;
  int coefficients = v->model->n_coefficients;
  struct variance_point at = {.coefficient = {x[0], coefficients == 2 ? x[1] : 0},
                              .rate = x[coefficients]};
  double sum = v->before, slope[SOLVE_MAX] = {0};
  uint64_t j = theory->first;
  family_ratio(&theory->family, at.rate, v->model->log_ratio, v->model->slope);
  for (int c = 0; c < v->n; c++) {
    for (; j < v->checkpoint[c]; j++) {
      struct variance_row row = variance_model_row(v->model, &at, j);
      if (!(row.variance > 0)) return false;
      sum += row.variance;
      for (int a = 0; a <= coefficients; a++) slope[a] += row.by[a];
    }
    f[c] = log(sum) - 2 * log((double)v->checkpoint[c]);
    for (int a = 0; a <= coefficients; a++) by[a * v->n + c] = slope[a] / sum;
  }
  return true;
}

// Sums over iterations 1..N: V_i, and the excess of Var(S_i^2) over that of normal values.
struct spread {
  double variance, excess;
};

static struct spread spread_of(const double *weights, const double *dispersion, double runs,
                               uint64_t n) {
  struct spread spread = {0};
  for (uint64_t j = 0; j < n; j++) {
    spread.variance += weights[j];
    spread.excess += (dispersion[j] - 2 / (runs - 1)) * weights[j] * weights[j];
  }
  return spread;
}

// Of the logarithms of two variances of normal values with this squared correlation, K = 2 shape +
// 1: sum over k of r^k (k - 1)! Gamma(shape) / (k Gamma(shape + k)), by the expansion of their
// joint density in Laguerre's polynomials (Kibble 1941). Its first term is theory 4.2's.
static double log_covariance(double shape, double r) {
  double sum = 0, term = r / shape;
  for (double k = 1; term > 1e-17 * sum; k++) {
    sum += term / k;
    term *= r * k / (shape + k);
  }
  return sum;
}

static double covariance_of(struct spread before, struct spread after, double runs) {
  double shape = (runs - 1) / 2, r = before.variance / after.variance;
  double normal = r < 1 ? log_covariance(shape, r) : special_trigamma(shape);
  return normal + before.excess / (before.variance * after.variance);
}

// The mean of the logarithm of a variance, less that of the variance itself.
static double log_offset(struct spread spread, double runs) {
  double shape = (runs - 1) / 2;
  return special_digamma(shape) - log(shape) -
         spread.excess / (spread.variance * spread.variance) / 2;
}

struct points {
  int n;
  uint64_t *checkpoint;
  double *y, *omega;
};

static struct points variance_points(const struct prediction *theory, const struct series *series,
                                     const double *weights, const double *dispersion,
                                     struct arena *arena) {
  int most = series->n_checkpoints;
  double runs = series->iteration[0].n;
  struct points points = {0, arena_new(arena, uint64_t, most), arena_new(arena, double, most),
                          arena_new(arena, double, (ptrdiff_t)most *most)};
  struct spread *spread = arena_new(arena, struct spread, most);
  for (int c = 0; c < most; c++) {
    struct spread here = spread_of(weights, dispersion, runs, series->checkpoint[c]);
    double kurtosis = runs * here.excess / (here.variance * here.variance);
    if (series->checkpoint[c] <= theory->first || kurtosis * least_photons > 1) continue;
    int k = points.n++;
    spread[k] = here;
    points.checkpoint[k] = series->checkpoint[c];
    points.y[k] = log(moments_variance(series->average[c])) - log_offset(here, runs);
  }
  for (int a = 0; a < points.n; a++)
    for (int b = 0; b <= a; b++)
      points.omega[a * points.n + b] = covariance_of(spread[b], spread[a], runs);
  return points;
}

static struct gls_model gls_new(const struct points *points, int n_parameters,
                                bool (*at)(const void *, const double *, double *, double *),
                                const void *of, struct arena *arena) {
  return (struct gls_model){
      .n = points->n,
      .n_parameters = n_parameters,
      .y = points->y,
      .root = points->omega,
      .at = at,
      .of = of,
      .f = arena_new(arena, double, points->n),
      .by = arena_new(arena, double, (ptrdiff_t)n_parameters * points->n),
  };
}

static const char *variance(const struct prediction *theory, const struct series *series,
                            const double *weights, struct variance_fit *v, struct arena scratch) {
  ptrdiff_t n = (ptrdiff_t)theory->n;
  if (series->iteration[0].n < least_runs) return "fewer than 10 runs: ln S^2 is not normal";
  struct variance_model model = {
      .theory = theory,
      .n_coefficients = theory->closed_form || !theory->rest ? 1 : 2,
      .log_ratio = arena_new(&scratch, double, n),
      .slope = arena_new(&scratch, double, n),
  };
  struct points points = variance_points(theory, series, weights, v->dispersion, &scratch);
  int coefficients = model.n_coefficients;
  if (points.n <= coefficients) return "too few averages with 20 photons";
  if (!gls_factor(points.n, points.omega)) return "averages tell nothing apart";
  struct of_variance of = {&model, points.checkpoint, points.n, 0};
  for (uint64_t j = 0; j < theory->first; j++) of.before += weights[j];
  struct gls_model gls = gls_new(&points, coefficients + 1, variance_at, &of, &scratch);
  struct gls_solution held = {.x = {v->coefficient}};
  held.x[coefficients] = theory->family.theory;
  if (!gls_descend(&gls, coefficients, &held)) return "the fit does not converge";
  v->coefficient = held.x[0];
  v->coefficient_se = sqrt(held.covariance[0][0]);
  v->null_se = v->coefficient_se / v->coefficient;
  v->rate = NAN, v->rate_se = INFINITY;
  // Logarithms of variances are too skewed for their chi-squared to be one.
  v->lack_of_fit = (struct chi2){0, 0};
  struct gls_solution best = held;
  if (!gls_descend(&gls, coefficients + 1, &best)) return NULL;
  v->rate = best.x[coefficients];
  v->rate_se = sqrt(best.covariance[coefficients][coefficients]);
  return NULL;
}

// ---- bias ----

struct of_bias {
  const struct prediction *theory;
  const uint64_t *checkpoint;
  int n, n_terms;
  double *shape, *slope; // scratch, [iterations]
};

// b(N) = b_1 T(N) / N, and a second term that stays at theory's radii.
static bool bias_at(const void *of, const double *x, double *f, double *by) {
  const struct of_bias *b = of;
  int terms = b->n_terms;
  double shape = 0, second = 0, slope = 0;
  uint64_t j = b->theory->first;
  bias_family(b->theory, x[terms], b->shape, b->slope);
  for (int c = 0; c < b->n; c++) {
    double count = (double)b->checkpoint[c];
    for (; j < b->checkpoint[c]; j++) {
      shape += b->shape[j], slope += b->slope[j];
      if (terms == 2) second += b->theory->bias2[j];
    }
    by[c] = shape / count;
    if (terms == 2) by[b->n + c] = second / count;
    by[terms * b->n + c] = x[0] * slope / count;
    f[c] = x[0] * by[c] + (terms == 2 ? x[1] * by[b->n + c] : 0);
  }
  return true;
}

static struct points bias_points(const struct prediction *theory, const struct series *series,
                                 const double *weights, struct arena *arena) {
  int most = series->n_checkpoints;
  double runs = series->iteration[0].n, before = 0, variance = 0;
  struct points points = {0, arena_new(arena, uint64_t, most), arena_new(arena, double, most),
                          arena_new(arena, double, (ptrdiff_t)most *most)};
  double *of_mean = arena_new(arena, double, most), *offset = arena_new(arena, double, most);
  uint64_t j = theory->first;
  for (uint64_t i = 0; i < j; i++) before += series->iteration[i].mean;
  for (int c = 0; c < most; c++) {
    double count = (double)series->checkpoint[c];
    if (series->checkpoint[c] <= theory->first) continue;
    for (; j < series->checkpoint[c]; j++) variance += weights[j];
    int k = points.n++;
    points.checkpoint[k] = series->checkpoint[c];
    offset[k] = 1 - (double)theory->first / count;
    points.y[k] = series->average[c].mean - before / count - offset[k] * theory->truth;
    of_mean[k] = variance / runs / count; // times 1 / N of the later one: (m / M) Var(m) / K
  }
  for (int a = 0; a < points.n; a++)
    for (int b = 0; b <= a; b++)
      points.omega[a * points.n + b] = of_mean[b] / (double)points.checkpoint[a] +
                                       theory->truth_se * theory->truth_se * offset[a] * offset[b];
  return points;
}

static const double least_rate = -1, largest_rate = 2; // that are searched

// The model is linear in all but the rate: one step is enough.
static double profile(const struct gls_model *gls, const struct gls_solution *from, double rate) {
  int n_free = gls->n_parameters - 1;
  struct gls_solution here = *from;
  struct normal_equations eq;
  double step[SOLVE_MAX];
  here.x[n_free] = rate;
  if (!gls_evaluate(gls, n_free, here.x, &eq, &here.chi2) || !normal_solve(&eq, step, NULL))
    return INFINITY;
  for (int a = 0; a < n_free; a++) here.chi2 -= step[a] * eq.g[a];
  return here.chi2;
}

// Where the profile rises to `level` on the side of `step`; false: nowhere.
static bool find_end(const struct gls_model *gls, const struct gls_solution *best, double level,
                     double step, double *end) {
  double inside = best->x[gls->n_parameters - 1], outside = inside + step;
  while (profile(gls, best, outside) < level) {
    if (outside < least_rate || outside > largest_rate) return false;
    inside = outside, outside += step;
  }
  while (fabs(outside - inside) > 1e-6) {
    double middle = (inside + outside) / 2;
    *(profile(gls, best, middle) < level ? &inside : &outside) = middle;
  }
  *end = (inside + outside) / 2;
  return true;
}

static bool find_rate(const struct gls_model *gls, const struct gls_solution *held, double dof,
                      struct gls_solution *best, struct bias_fit *b) {
  int at = gls->n_parameters - 1;
  *best = *held;
  if (!gls_descend(gls, gls->n_parameters, best)) return false;
  double quantile = special_t_quantile(0.025, dof), level = best->chi2 + quantile * quantile;
  double se = sqrt(best->covariance[at][at]), gain = held->chi2 - best->chi2;
  if (!find_end(gls, best, level, -se, &b->rate_lo)) return false;
  if (!find_end(gls, best, level, se, &b->rate_hi)) return false;
  b->rate = best->x[at], b->rate_se = se;
  double deviate = gain > 0 ? sqrt(gain) : 0; // below zero by rounding only
  b->rate_deviate = b->rate > held->x[at] ? deviate : -deviate;
  return true;
}

// Standard error of the rate with the others at their best for theory's.
static double rate_se_at(const struct gls_model *gls, const struct gls_solution *held) {
  struct normal_equations eq;
  double unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX], chi2;
  return gls_evaluate(gls, gls->n_parameters, held->x, &eq, &chi2) &&
                 normal_solve(&eq, unused, covariance)
             ? sqrt(covariance[eq.n - 1][eq.n - 1])
             : INFINITY;
}

static void bias(const struct prediction *theory, const struct series *series,
                 const double *weights, const struct variance_fit *v, struct bias_fit *b,
                 struct arena scratch) {
  ptrdiff_t n = (ptrdiff_t)theory->n;
  struct points points = bias_points(theory, series, weights, &scratch);
  struct of_bias of = {theory,
                       points.checkpoint,
                       points.n,
                       theory->bias2 ? 2 : 1,
                       arena_new(&scratch, double, n),
                       arena_new(&scratch, double, n)};
  struct gls_model gls = gls_new(&points, of.n_terms + 1, bias_at, &of, &scratch);
  double rate = bias_theory_rate(theory);
  struct gls_solution held = {.x = {0}}, best;
  held.x[of.n_terms] = isnan(rate) ? 0 : rate;
  b->measured = points.n >= of.n_terms && gls_factor(points.n, points.omega) &&
                gls_descend(&gls, of.n_terms, &held);
  if (!b->measured) return;
  b->coefficient = held.x[0];
  b->coefficient_se = sqrt(held.covariance[0][0]);
  b->snr = fabs(b->coefficient) / b->coefficient_se;
  b->lack_of_fit = (struct chi2){held.chi2, points.n - of.n_terms};
  b->rate_found = false;
  if (theory->unbiased || isnan(rate)) return;
  b->rate_se_theory = rate_se_at(&gls, &held);
  b->rate_found = find_rate(&gls, &held, v->dof, &best, b);
  if (b->rate_found) b->lack_of_fit = (struct chi2){best.chi2, points.n - of.n_terms - 1};
}

void fit_series_gls(const struct results *results, const struct series *series,
                    const struct prediction *theory, struct arena scratch, struct fit *fit) {
  static const struct fit_estimators estimators = {variance, bias};
  fit_series_by(&estimators, results, series, theory, scratch, fit);
}
