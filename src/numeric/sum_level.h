// The bodies of sums.
#ifndef NUMERIC_SUM_LEVEL_H
#define NUMERIC_SUM_LEVEL_H

#include "base/simd.h"

struct sum_level {
  double (*products)(const double *a, const double *b, int n);
};
SIMD_TABLES(sum_level);

#endif
