// Small symmetric systems: the normal equations of the fits.
#ifndef ANALYSIS_SOLVE_H
#define ANALYSIS_SOLVE_H

#include <stdbool.h>

enum { SOLVE_MAX = 4 };

// h x = g over the unknowns; h is symmetric, its lower triangle is used.
struct normal_equations {
  int n;
  double h[SOLVE_MAX][SOLVE_MAX], g[SOLVE_MAX];
};

static inline void normal_add(struct normal_equations *eq, const double *row, double value,
                              double weight) {
  for (int a = 0; a < eq->n; a++) {
    eq->g[a] += weight * row[a] * value;
    for (int b = 0; b <= a; b++) eq->h[a][b] += weight * row[a] * row[b];
  }
}

// x, and the inverse of h (the covariance of x) unless NULL. False: h is not positive definite to
// working precision, so the data do not determine x.
bool normal_solve(const struct normal_equations *, double x[SOLVE_MAX],
                  double inverse[SOLVE_MAX][SOLVE_MAX]);

#endif
