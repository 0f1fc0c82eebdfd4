// Sums have one shape: item j goes to lane j mod 8, lanes are added by one fixed tree. The same
// bits in scalar and vector code.
#ifndef NUMERIC_SUM_H
#define NUMERIC_SUM_H

enum { SUM_LANES = 8 };

static inline double sum_lanes(const double lane[SUM_LANES]) {
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

static inline double sum_array(const double *x, int n) {
  double lane[SUM_LANES] = {0};
  for (int j = 0; j < n; j++) lane[j % SUM_LANES] += x[j];
  return sum_lanes(lane);
}

// Of a[j] * b[j].
double sum_products(const double *a, const double *b, int n);

#endif
