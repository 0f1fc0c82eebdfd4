// The p-values of a program's own tests. Each is held against a level where it arises; together
// they must be uniform between 0 and 1, which finds what no single one shows: standard errors that
// are too large everywhere, terms of a chi-squared that do not count, a small defect of all cases.
#ifndef TESTS_P_VALUES_H
#define TESTS_P_VALUES_H

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { P_VALUES_MOST = 8192 };

struct p_values {
  int n;
  double p[P_VALUES_MOST];
};

static inline void p_values_add(struct p_values *all, double p) {
  assert(all->n < P_VALUES_MOST && p >= 0 && p <= 1);
  all->p[all->n++] = p;
}

// Two-sided, of a standard normal deviate.
static inline double p_of_z(double z) { return erfc(fabs(z) * sqrt(0.5)); }

static inline int p_ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The largest distance between the values' distribution and the uniform one, times n^1/2; sorts.
static inline double p_kolmogorov(double *p, int n) {
  double largest = 0;
  qsort(p, (size_t)n, sizeof *p, p_ascending);
  for (int k = 0; k < n; k++) {
    double above = (k + 1.0) / n - p[k], below = p[k] - (double)k / n;
    largest = fmax(largest, fmax(above, below));
  }
  return largest * sqrt(n);
}

// 2 exp(-2 x^2) = 1e-5 (Kolmogorov, Smirnov): of n values a distance of 2.47 / n^1/2 is accepted,
// and one of 3.3 / n^1/2 found with probability 0.95.
static const double p_kolmogorov_limit = 2.47;

// Fewer than `least` values: a test that no longer reports.
#define assert_p_uniform(all, least)                                                               \
  do {                                                                                             \
    struct p_values *all_ = (all);                                                                 \
    assert_true(all_->n >= (least));                                                               \
    double distance_ = p_kolmogorov(all_->p, all_->n);                                             \
    print_message("p-values: %d, Kolmogorov's distance %.2f / n^1/2\n", all_->n, distance_);       \
    assert_true(distance_ < p_kolmogorov_limit);                                                   \
  } while (0)

#endif
