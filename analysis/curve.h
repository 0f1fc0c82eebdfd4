// The exact curves of an average of N iterations and of iteration N alone, N = 1..n (theory 3).
#ifndef ANALYSIS_CURVE_H
#define ANALYSIS_CURVE_H

#include "analysis/expansion.h"
#include "analysis/prediction.h"

struct curve_point {
  uint64_t n;
  double rho, radius;            // of iteration n; a radius of nothing is NAN
  double plus, minus;            // S+ and S-: sums of rho_i and 1 / rho_i over i <= n
  double variance_one, bias_one; // of iteration n alone
  double variance, bias, rmse;   // of the average of iterations 1..n
};

// At N = 1, 2, 3, 4, 5, 6, 8, 10, ..., ten a decade, and the last, as in log.csv. Where theory does
// not know the constants (`shape`), variance and bias are in units of their leading terms.
struct curve {
  struct curve_point *point;
  int n;
  bool shape;
};

struct curve curve_of_model(const struct model *, double radius, uint64_t n, struct arena *);
// For a cell of an experiment; the same law and radius as the prediction is made for.
struct curve curve_of_prediction(const struct prediction *, const struct cell *, struct arena *);

// Slope of an ordinary straight line through ln y against ln n, over the points from `from` on:
// what such a fit shows of the exact curve (theory 3.4). NAN for fewer than two points or a y of 0.
struct slopes {
  double variance, bias;
};
struct slopes curve_slopes(const struct curve *, uint64_t from);
// Between a point and the one before; NAN for the first.
struct slopes curve_local_slopes(const struct curve *, int point);

#endif
