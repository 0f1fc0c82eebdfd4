#include "analysis/resample.h"

#include "numeric/rng.h"

#include <math.h>
#include <stdlib.h>

void resample_runs(int b, int runs, double *count, double *normal) {
  struct rng_key key = rng_key(rng_hash_name("bootstrap"), 0, RNG_RESAMPLE);
  double u0, u1;
  for (int k = 0; k < runs; k++) count[k] = 0;
  for (uint64_t k = 0; k < (uint64_t)runs; k++) {
    rng_fill(key, (uint64_t)b, &k, 1, 0, &u0, &u1);
    count[(int)(u0 * runs)]++;
  }
  uint64_t last = (uint64_t)runs;
  rng_fill(key, (uint64_t)b, &last, 1, 0, &u0, &u1);
  *normal = sqrt(-2 * log(1 - u0)) * cos(2 * 3.14159265358979323846 * u1);
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
