// How rates are found from a log: one row a method, as in `photonlab fit --method NAME`.
#ifndef ANALYSIS_FIT_METHODS_H
#define ANALYSIS_FIT_METHODS_H

#include "analysis/fit_rows.h"

struct fit_method {
  const char *name, *about;
  const char *caveat; // why its rows have no verdict; NULL: they have one
  // Whether the results have what it needs, or a problem; NULL: all have.
  bool (*accepts)(const struct results *, struct problem *);
  // Appends the series' rows and points to the fit, which has room for them.
  void (*series)(const struct results *, const struct series *, const struct prediction *,
                 struct arena scratch, struct fit *);
};
extern const struct fit_method fit_methods[]; // the first is the default
extern const int n_fit_methods;

const struct fit_method *fit_method_find(const char *name); // NULL: there is none

// Least squares on the running averages with their covariance (fit_gls.c).
extern const struct fit_estimators fit_gls_estimators;
void fit_series_gls(const struct results *, const struct series *, const struct prediction *,
                    struct arena scratch, struct fit *);
// The same fit with standard errors and intervals from runs drawn with replacement
// (fit_bootstrap.c).
extern const struct fit_estimators fit_bootstrap_estimators;
bool fit_can_bootstrap(const struct results *, struct problem *);
void fit_series_bootstrap(const struct results *, const struct series *, const struct prediction *,
                          struct arena scratch, struct fit *);
// A straight line through the logarithms (fit_ols.c). Its rate is minus the slope of the measured
// curve, and theory's is minus that of the exact one (theory 3.4).
void fit_series_ols(const struct results *, const struct series *, const struct prediction *,
                    struct arena scratch, struct fit *);

#endif
