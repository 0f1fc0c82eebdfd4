// Generalised least squares: a few numbers whose errors are correlated, a model of a few
// parameters.
#ifndef ANALYSIS_GLS_H
#define ANALYSIS_GLS_H

#include "analysis/solve.h"

// The model at x: values f[n] and their derivatives by parameter a, by[a * n + k]. False: there is
// none at this x.
struct gls_model {
  int n, n_parameters;
  const double *y;    // [n]
  const double *root; // [n * n], of gls_factor
  bool (*at)(const void *of, const double *x, double *f, double *by);
  const void *of;
  double *f, *by; // scratch, [n] and [n_parameters * n]
};

struct gls_solution {
  double x[SOLVE_MAX], chi2, covariance[SOLVE_MAX][SOLVE_MAX];
};

// Omega = root root^T, in place (the lower triangle). False: not positive definite.
bool gls_factor(int n, double *omega);

// Chi-squared at x, and the information and half the slope downwards of the first `n_free`
// parameters. False: there is no model at x.
bool gls_evaluate(const struct gls_model *, int n_free, const double *x, struct normal_equations *,
                  double *chi2);

// Descends from solution.x to the least chi-squared over the first `n_free` parameters; the others
// stay. False: it does not get there.
bool gls_descend(const struct gls_model *, int n_free, struct gls_solution *);

// Of a model that is linear in all parameters but its last: the least chi-squared where that one is
// `last`, infinite where there is none; and the least of all, by descent from solution.x or, where
// that does not get there, by a search over lo..hi.
double gls_profile(const struct gls_model *, const double *x, double last);
bool gls_best(const struct gls_model *, double lo, double hi, struct gls_solution *);

#endif
