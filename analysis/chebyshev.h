// Smooth functions as Chebyshev series.
#ifndef ANALYSIS_CHEBYSHEV_H
#define ANALYSIS_CHEBYSHEV_H

#include <stdbool.h>

enum { CHEBYSHEV_TERMS = 48 };

// Coefficients on [0, hi].
struct chebyshev {
  double hi, coefficient[CHEBYSHEV_TERMS];
};

// Where the values for a fit are taken, k = 0..CHEBYSHEV_TERMS - 1.
double chebyshev_node(double hi, int k);
struct chebyshev chebyshev_fit(double hi, const double value[CHEBYSHEV_TERMS]);
double chebyshev_value(const struct chebyshev *, double x);
// The integral from 0, the term past the last one left out.
struct chebyshev chebyshev_integral(const struct chebyshev *);
// Whether the last coefficients are rounding: CHEBYSHEV_TERMS terms of 1e-16 each.
bool chebyshev_converged(const struct chebyshev *);

#endif
