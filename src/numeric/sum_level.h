// The bodies of sums.
#ifndef NUMERIC_SUM_LEVEL_H
#define NUMERIC_SUM_LEVEL_H

#include "base/level.h"

struct sum_level {
  double (*products)(const double *a, const double *b, int n);
};
LEVEL_TABLES(sum_level);

#endif
