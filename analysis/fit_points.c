// The curves of the figure: averages after N iterations, measured over runs and predicted.
#include "analysis/fit_rows.h"

#include "analysis/special.h"

#include <math.h>

static struct fit_point *new_point(struct fit *fit, const struct fit_row *row, uint64_t n) {
  struct fit_point *point = &fit->point[fit->n_points++];
  *point = (struct fit_point){row, n, NAN, NAN, NAN, NAN, NAN};
  return point;
}

// Running sums over iterations, carried from one checkpoint to the next.
struct sums {
  uint64_t n;
  double measured, variance, fourth, expected, bias;
};

static void advance_variance(struct sums *sums, uint64_t n, const struct series *series,
                             const struct variance_fit *v) {
  double gaussian = 2 / (series->iteration[0].n - 1);
  for (uint64_t j = sums->n; j < n; j++) {
    sums->measured += moments_variance(series->iteration[j]);
    sums->variance += v->variance[j];
    sums->fourth += (v->dispersion[j] - gaussian) * v->variance[j] * v->variance[j];
    sums->expected += v->expected[j];
  }
  sums->n = n;
}

// None where so little light is expected that an interval would not hold the estimate.
static void set_interval(struct fit_point *point, double relative_variance) {
  double lower = point->measured / special_gamma_quantile(0.975, relative_variance);
  if (!(lower <= point->measured)) return;
  point->lower = lower;
  point->upper = point->measured / special_gamma_quantile(0.025, relative_variance);
}

// Where theory knows its constants the curve is theory's own, else the fit with theory's exponent.
void fit_variance_points(const struct series *series, const struct variance_fit *v,
                         const struct fit_row *row, struct fit *fit) {
  struct sums sums = {0};
  double unit = isfinite(row->coefficient_theory) ? v->coefficient : 1;
  for (int c = 0; !v->why && c < series->n_checkpoints; c++) {
    double n = (double)series->checkpoint[c], runs = series->average[c].n;
    advance_variance(&sums, series->checkpoint[c], series, v);
    struct fit_point *point = new_point(fit, row, series->checkpoint[c]);
    point->measured = moments_variance(series->average[c]);
    if (sums.variance > 0) // else no photon yet, before the first iteration that is fitted
      set_interval(point, 2 / (runs - 1) + sums.fourth / (sums.variance * sums.variance));
    point->pooled = sums.measured / (n * n);
    point->predicted = sums.expected / unit / (n * n);
  }
}

void fit_bias_points(const struct series *series, const struct prediction *theory,
                     const struct variance_fit *v, const struct bias_fit *b,
                     const struct fit_row *row, struct fit *fit) {
  struct sums sums = {0};
  bool known = isfinite(row->coefficient_theory);
  for (int c = 0; b->measured && c < series->n_checkpoints; c++) {
    uint64_t j = sums.n, last = series->checkpoint[c];
    for (; j < last; j++)
      sums.bias += !known ? b->expected[j] : theory->unbiased ? 0 : theory->bias[j];
    advance_variance(&sums, last, series, v);
    double n = (double)last, runs = series->average[c].n;
    struct fit_point *point = new_point(fit, row, last);
    double se = sqrt(sums.variance / (n * n) / runs + theory->truth_se * theory->truth_se);
    point->measured = series->average[c].mean - theory->truth;
    double half = special_t_quantile(0.025, v->dof) * se;
    point->lower = point->measured - half;
    point->upper = point->measured + half;
    point->predicted = sums.bias / n;
  }
}
