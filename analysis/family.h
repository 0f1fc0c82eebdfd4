// A radius law as a one-parameter family: rho_i with the rate varied, for fitting the rate. The
// parameter `rate` is the exponent of the variance of the average: rho_i ~ i^-(1 - rate).
#ifndef ANALYSIS_FAMILY_H
#define ANALYSIS_FAMILY_H

#include "base/arena.h"
#include "density/law.h"

enum { FAMILY_NODES = 12 };

// ln rho_i at FAMILY_NODES values of alpha in [0, 1]; shared by all cells of one law and length.
struct family_table {
  const struct law *law; // NULL: the radius is constant
  uint64_t n;
  const double *log_rho; // [FAMILY_NODES][n]; NULL where alpha is not the rate: see family_ratio
};
struct family_table family_table_new(const struct law *, uint64_t n, struct arena *);

struct family {
  const struct family_table *table;
  uint64_t n;
  double theory;     // the rate theory expects
  const double *rho; // [n], exact, at the cell's own alpha
};
struct family family_new(const struct family_table *, double alpha, struct arena *);

// log_ratio[i - 1] = ln(rho_i at this rate / rho_i at theory's), and its derivative by the rate.
// Within [0, 1] the law itself (interpolated in alpha to 1e-9); beyond, its tangent, so that an
// estimate may fall on both sides of alpha = 0 or 1. A law without alpha is tilted by a power of i.
void family_ratio(const struct family *, double rate, double *log_ratio, double *slope);

#endif
