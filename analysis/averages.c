#include "analysis/averages.h"

#include "analysis/bias_family.h"
#include "analysis/special.h"
#include "analysis/variance_model.h"

#include <math.h>

// A variance's logarithm is nearly normal from so many photons in the average (a kurtosis is one
// over their number).
static const double least_photons = 20;

static struct averages averages_new(const struct prediction *theory, int most, int n_terms,
                                    struct arena *arena) {
  ptrdiff_t n = (ptrdiff_t)theory->n;
  return (struct averages){
      .theory = theory,
      .n_terms = n_terms,
      .at = arena_new(arena, int, most),
      .checkpoint = arena_new(arena, uint64_t, most),
      .y = arena_new(arena, double, most),
      .omega = arena_new(arena, double, (ptrdiff_t)most *most),
      .offset = arena_new(arena, double, most),
      .second = arena_new(arena, double, most),
      .log_ratio = arena_new(arena, double, n),
      .slope = arena_new(arena, double, n),
      .sum = arena_new(arena, double, most),
      .by_rate = arena_new(arena, double, most),
      .shape = averages_shape,
  };
}

static void fill_second(struct averages *of, const double *term) {
  double sum = 0;
  uint64_t j = of->theory->first;
  for (int k = 0; k < of->n; k++) {
    for (; j < of->checkpoint[k]; j++) sum += term[j];
    of->second[k] = sum;
  }
}

// ---- variance ----

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

struct averages averages_of_variance(const struct prediction *theory, const struct series *series,
                                     const double *weights, const double *dispersion,
                                     struct arena *arena) {
  int most = series->n_checkpoints, n_terms = theory->closed_form || !theory->rest ? 1 : 2;
  double runs = series->iteration[0].n;
  struct averages of = averages_new(theory, most, n_terms, arena);
  struct spread *spread = arena_new(arena, struct spread, most);
  of.logarithm = true;
  for (int c = 0; c < most; c++) {
    struct spread here = spread_of(weights, dispersion, runs, series->checkpoint[c]);
    double kurtosis = runs * here.excess / (here.variance * here.variance);
    if (series->checkpoint[c] <= theory->first || kurtosis * least_photons > 1) continue;
    int k = of.n++;
    spread[k] = here;
    of.at[k] = c;
    of.checkpoint[k] = series->checkpoint[c];
    of.offset[k] = log_offset(here, runs);
    of.y[k] = log(moments_variance(series->average[c])) - of.offset[k];
  }
  for (int a = 0; a < of.n; a++)
    for (int b = 0; b <= a; b++) of.omega[a * of.n + b] = covariance_of(spread[b], spread[a], runs);
  for (uint64_t j = 0; j < theory->first; j++) of.before += weights[j];
  if (n_terms == 2) fill_second(&of, theory->rest);
  return of;
}

// ---- bias ----

struct averages averages_of_bias(const struct prediction *theory, const struct series *series,
                                 const double *weights, struct arena *arena) {
  int most = series->n_checkpoints;
  double runs = series->iteration[0].n, before = 0, variance = 0;
  struct averages of = averages_new(theory, most, theory->bias2 ? 2 : 1, arena);
  double *of_mean = arena_new(arena, double, most);
  uint64_t j = theory->first;
  for (uint64_t i = 0; i < j; i++) before += series->iteration[i].mean;
  for (int c = 0; c < most; c++) {
    double count = (double)series->checkpoint[c];
    if (series->checkpoint[c] <= theory->first) continue;
    for (; j < series->checkpoint[c]; j++) variance += weights[j];
    int k = of.n++;
    of.at[k] = c;
    of.checkpoint[k] = series->checkpoint[c];
    of.offset[k] = 1 - (double)theory->first / count;
    of.y[k] = series->average[c].mean - before / count - of.offset[k] * theory->truth;
    of_mean[k] = variance / runs / count; // times 1 / N of the later one: (m / M) Var(m) / K
  }
  for (int a = 0; a < of.n; a++)
    for (int b = 0; b <= a; b++)
      of.omega[a * of.n + b] = of_mean[b] / (double)of.checkpoint[a] +
                               theory->truth_se * theory->truth_se * of.offset[a] * of.offset[b];
  if (theory->bias2) fill_second(&of, theory->bias2); // stays at theory's radii
  return of;
}

// ---- the model ----

// Of one iteration, with a coefficient of one.
static void shape_of_variance(const struct averages *of, uint64_t j, double *shape, double *slope) {
  const struct variance_model model = {
      .theory = of->theory, .n_coefficients = 1, .log_ratio = of->log_ratio, .slope = of->slope};
  const struct variance_point one = {.coefficient = {1}};
  struct variance_row row = variance_model_row(&model, &one, j);
  *shape = row.by[0];
  *slope = row.by[1];
}

bool averages_shape(const struct averages *of, double rate, double *sum, double *slope) {
  double shapes = 0, slopes = 0;
  uint64_t j = of->theory->first;
  if (of->logarithm)
    family_ratio(&of->theory->family, rate, of->log_ratio, of->slope);
  else
    bias_family(of->theory, rate, of->log_ratio, of->slope);
  for (int k = 0; k < of->n; k++) {
    for (; j < of->checkpoint[k]; j++) {
      double shape = of->log_ratio[j], by_rate = of->slope[j];
      if (of->logarithm) shape_of_variance(of, j, &shape, &by_rate);
      shapes += shape, slopes += by_rate;
    }
    sum[k] = shapes;
    slope[k] = slopes;
  }
  return true;
}

// ln Var(N), Var(N) = N^-2 sum of V_i, with one coefficient A S-(N) / N^2 and what stays constant;
// or b(N) = N^-1 sum of b_i.
static bool model_at(const void *averages, const double *x, double *f, double *by) {
  const struct averages *of = averages;
  int n = of->n, terms = of->n_terms;
  if (!of->shape(of, x[terms], of->sum, of->by_rate)) return false;
  for (int k = 0; k < n; k++) {
    double count = (double)of->checkpoint[k], sum = x[0] * of->sum[k];
    if (terms == 2) sum += x[1] * of->second[k];
    if (of->logarithm) sum += of->before;
    if (of->logarithm && !(sum > 0)) return false;
    double per = of->logarithm ? 1 / sum : 1 / count;
    f[k] = of->logarithm ? log(sum) - 2 * log(count) : sum * per;
    by[k] = of->sum[k] * per;
    if (terms == 2) by[n + k] = of->second[k] * per;
    by[terms * n + k] = x[0] * of->by_rate[k] * per;
  }
  return true;
}

struct gls_model averages_model(const struct averages *of, struct arena *arena) {
  return (struct gls_model){
      .n = of->n,
      .n_parameters = of->n_terms + 1,
      .y = of->y,
      .root = of->omega,
      .at = model_at,
      .of = of,
      .f = arena_new(arena, double, of->n),
      .by = arena_new(arena, double, (ptrdiff_t)(of->n_terms + 1) * of->n),
  };
}
