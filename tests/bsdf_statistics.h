// For the statistics of materials: draws named by test and case, means with their variance.
// A p-value fails below `level` over the number of tests; one try.
#ifndef TESTS_BSDF_STATISTICS_H
#define TESTS_BSDF_STATISTICS_H

#include "tests/material_cases.h"

#include <gsl/gsl_cdf.h>

static const double pi = 0x1.921fb54442d18p+1, level = 1e-6;

static inline struct draw draw_case(const char *test, int i) {
  char name[64];
  snprintf(name, sizeof name, "%s %d", test, i);
  return draw_named(name);
}

static inline bool draw_sample(struct draw *draw, const struct bsdf *bsdf, struct vec wo,
                               enum transport transport, struct bsdf_sample *sample) {
  double u[3], unused;
  draw_pair(draw, &u[0], &u[1]);
  draw_pair(draw, &u[2], &unused);
  return bsdf_sample(bsdf, wo, u, transport, sample);
}

struct mean {
  double n, sum, squares;
};

static inline void mean_add(struct mean *mean, double x) {
  mean->n += 1;
  mean->sum += x;
  mean->squares += x * x;
}

static inline double mean_of(const struct mean *mean) { return mean->sum / mean->n; }

static inline double variance_of_mean(const struct mean *mean) {
  double m = mean_of(mean);
  return (mean->squares / mean->n - m * m) / mean->n;
}

#endif
