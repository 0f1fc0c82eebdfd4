// The curves of the figures: averages after N iterations, and single iterations in bins between
// one N and the next, measured over runs and predicted.
#include "analysis/fit_rows.h"

#include "analysis/special.h"

#include <math.h>

// Over iterations first..n: S_i^2, V_i and V_i^2 as fitted, the excess of Var(S_i^2) over that of
// normal values, theory's variance, mean_i - truth, theory's bias.
struct sums {
  uint64_t first, n;
  double measured, variance, square, excess, expected, difference, bias;
};

static struct sums sum_over(uint64_t first, uint64_t n, const struct series *series,
                            const struct variance_fit *v, double truth, const double *bias) {
  struct sums sums = {.first = first, .n = n};
  double gaussian = 2 / (series->iteration[0].n - 1);
  for (uint64_t j = first - 1; j < n; j++) {
    double square = v->variance[j] * v->variance[j];
    sums.measured += moments_variance(series->iteration[j]);
    sums.variance += v->variance[j];
    sums.square += square;
    sums.excess += (v->dispersion[j] - gaussian) * square;
    sums.expected += v->expected[j];
    sums.difference += series->iteration[j].mean - truth;
    sums.bias += bias ? bias[j] : 0;
  }
  return sums;
}

static struct sums sums_joined(struct sums before, struct sums bin) {
  return (struct sums){1,
                       bin.n,
                       before.measured + bin.measured,
                       before.variance + bin.variance,
                       before.square + bin.square,
                       before.excess + bin.excess,
                       before.expected + bin.expected,
                       before.difference + bin.difference,
                       before.bias + bin.bias};
}

static double count(struct sums sums) { return (double)(sums.n - sums.first + 1); }

static struct fit_point *new_point(struct fit *fit, const struct fit_row *row,
                                   enum curve_series series, struct sums over) {
  struct fit_point *point = &fit->point[fit->n_points++];
  *point = (struct fit_point){row, series, over.first, over.n, NAN, NAN, NAN, NAN, NAN};
  return point;
}

// None where so little light is expected that an interval would not hold the estimate.
static void set_gamma_interval(struct fit_point *point, double relative_variance) {
  double lower = point->measured / special_gamma_quantile(0.975, relative_variance);
  if (!(lower <= point->measured)) return;
  point->lower = lower;
  point->upper = point->measured / special_gamma_quantile(0.025, relative_variance);
}

// The variance of one value is sums.variance / n^2, averaged or binned.
static void set_t_interval(struct fit_point *point, struct sums sums, double runs, double truth_se,
                           double dof) {
  double n = count(sums);
  double half =
      special_t_quantile(0.025, dof) * sqrt(sums.variance / (n * n) / runs + truth_se * truth_se);
  point->lower = point->measured - half;
  point->upper = point->measured + half;
}

static void average_variance(struct fit_point *point, struct sums sums, struct moments average,
                             double unit) {
  double n = count(sums);
  point->measured = moments_variance(average);
  if (sums.variance > 0) // else no photon yet, before the first iteration that is fitted
    set_gamma_interval(point, 2 / (average.n - 1) + sums.excess / (sums.variance * sums.variance));
  point->pooled = sums.measured / (n * n);
  point->predicted = sums.expected / unit / (n * n);
}

static void single_variance(struct fit_point *point, struct sums sums, double runs, double unit) {
  point->measured = sums.measured / count(sums);
  if (sums.variance > 0)
    set_gamma_interval(point, (2 / (runs - 1) * sums.square + sums.excess) /
                                  (sums.variance * sums.variance));
  if (sums.first >= point->row->first) point->predicted = sums.expected / unit / count(sums);
}

// Where theory knows its constants the curve is theory's own, else the fit with theory's exponent.
void fit_variance_points(const struct series *series, const struct variance_fit *v,
                         const struct fit_row *row, struct fit *fit) {
  struct sums all = {0};
  double unit = isfinite(row->coefficient_theory) ? v->coefficient : 1;
  for (int c = 0; !v->why && c < series->n_checkpoints; c++) {
    struct sums bin = sum_over(all.n + 1, series->checkpoint[c], series, v, 0, NULL);
    all = sums_joined(all, bin);
    single_variance(new_point(fit, row, CURVE_ITERATION, bin), bin, series->iteration[0].n, unit);
    average_variance(new_point(fit, row, CURVE_AVERAGE, all), all, series->average[c], unit);
  }
}

void fit_bias_points(const struct series *series, const struct prediction *theory,
                     const struct variance_fit *v, const struct bias_fit *b,
                     const struct fit_row *row, struct fit *fit) {
  struct sums all = {0};
  bool known = isfinite(row->coefficient_theory);
  const double *bias = !known ? b->expected : theory->unbiased ? NULL : theory->bias;
  for (int c = 0; b->measured && c < series->n_checkpoints; c++) {
    struct sums bin = sum_over(all.n + 1, series->checkpoint[c], series, v, theory->truth, bias);
    all = sums_joined(all, bin);
    struct fit_point *single = new_point(fit, row, CURVE_ITERATION, bin);
    single->measured = bin.difference / count(bin);
    set_t_interval(single, bin, series->iteration[0].n, theory->truth_se, v->dof);
    if (bin.first >= row->first) single->predicted = bin.bias / count(bin);

    struct fit_point *average = new_point(fit, row, CURVE_AVERAGE, all);
    average->measured = all.difference / count(all);
    set_t_interval(average, all, series->average[c].n, theory->truth_se, v->dof);
    average->predicted = all.bias / count(all);
  }
}
