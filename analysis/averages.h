// The running averages at the log's checkpoints as sums of the iterations' model: ln S^2(N) and
// b(N), with the covariance of curves that share their past (theory 4.2, 4.4b). Biases are on the
// linear scale and keep their sign. Iterations before the first that is fitted stand as measured.
#ifndef ANALYSIS_AVERAGES_H
#define ANALYSIS_AVERAGES_H

#include "analysis/fit_variance.h"
#include "analysis/gls.h"
#include "analysis/prediction.h"

struct averages {
  const struct prediction *theory;
  bool logarithm;       // of a variance
  int n, n_terms;       // points; coefficients, of which the first one's shape knows the rate
  int *at;              // [n] each point's among the series' checkpoints
  uint64_t *checkpoint; // [n] N
  double *y, *omega;    // measured, [n]; their covariance, [n * n], the lower triangle
  double *offset;       // [n] of y: expected of a logarithm beyond its argument's; or 1 - first / N
  double *second;       // [n] sums of the second term over iterations 1..N
  double before;        // sum over iterations that are not fitted
  double *log_ratio, *slope; // scratch, [iterations]
  double *sum, *by_rate;     // scratch, [n]
  // Sums of the first term's shape over iterations 1..N, and their derivatives; false: there are
  // none at this rate. averages_shape, or a table of it.
  bool (*shape)(const struct averages *, double rate, double *sum, double *slope);
  void *table;
};

struct averages averages_of_variance(const struct prediction *, const struct series *,
                                     const double *weights, const double *dispersion,
                                     struct arena *);
struct averages averages_of_bias(const struct prediction *, const struct series *,
                                 const double *weights, struct arena *);

bool averages_shape(const struct averages *, double rate, double *sum, double *slope);

// The model over [n_terms] coefficients and the rate, for least squares with the root of omega that
// gls_factor leaves there.
struct gls_model averages_model(const struct averages *, struct arena *);

#endif
