#include "analysis/resample.h"

#include "numeric/rng.h"

#include <math.h>
#include <stdlib.h>

void resample_runs(int b, int runs, double *count, double *normal) {
  enum { AT_ONCE = 64 };
  struct rng_key key = rng_key(rng_hash_name("bootstrap"), 0, RNG_RESAMPLE);
  uint64_t draw[AT_ONCE], last = (uint64_t)runs;
  double u0[AT_ONCE], u1[AT_ONCE];
  for (int k = 0; k < runs; k++) count[k] = 0;
  for (int from = 0; from < runs; from += AT_ONCE) {
    int n = runs - from < AT_ONCE ? runs - from : AT_ONCE;
    for (int j = 0; j < n; j++) draw[j] = (uint64_t)(from + j);
    rng_fill(key, (uint64_t)b, draw, n, 0, u0, u1);
    for (int j = 0; j < n; j++) count[(int)(u0[j] * runs)]++;
  }
  rng_fill(key, (uint64_t)b, &last, 1, 0, u0, u1);
  *normal = sqrt(-2 * log(1 - u0[0])) * cos(2 * 3.14159265358979323846 * u1[0]);
}

// The expectation of the squared deviations' mean is (1 - 1/K) of the runs' own, and so is that of
// theirs of the variance.
struct resampled resample_moments(int runs, const double *count, const double *x) {
  double sum = 0, squares = 0, n = runs;
  for (int k = 0; k < runs; k++) {
    sum += count[k] * x[k];
    squares += count[k] * x[k] * x[k];
  }
  double mean = sum / n, unbiased = n / (n - 1);
  return (struct resampled){mean, (squares / n - mean * mean) * unbiased * unbiased};
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

bool resample_spread(double *value, int runs, struct spread_of_resamples *spread) {
  enum { TAIL = (RESAMPLES + 1) / 40 }; // 2.5 %
  double sum = 0, squares = 0;
  for (int b = 0; b < RESAMPLES; b++) {
    if (!isfinite(value[b])) return false;
    sum += value[b];
  }
  for (int b = 0; b < RESAMPLES; b++)
    squares += (value[b] - sum / RESAMPLES) * (value[b] - sum / RESAMPLES);
  qsort(value, RESAMPLES, sizeof *value, ascending);
  double variance = squares / (RESAMPLES - 1) * runs / (runs - 1);
  *spread = (struct spread_of_resamples){sqrt(variance), value[TAIL - 1], value[RESAMPLES - TAIL]};
  return true;
}
