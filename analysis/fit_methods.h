// How rates are found from a log: one row a method, as in `photonlab fit --method NAME`. A
// bootstrap over runs is none of them: the log keeps moments over runs, not the runs.
#ifndef ANALYSIS_FIT_METHODS_H
#define ANALYSIS_FIT_METHODS_H

#include "analysis/fit_rows.h"

struct fit_method {
  const char *name, *about;
  const char *caveat; // why its rows have no verdict; NULL: they have one
  // Appends the series' rows and points to the fit, which has room for them.
  void (*series)(const struct results *, const struct series *, const struct prediction *,
                 struct arena scratch, struct fit *);
};
extern const struct fit_method fit_methods[]; // the first is the default
extern const int n_fit_methods;

const struct fit_method *fit_method_find(const char *name); // NULL: there is none

// Least squares on the running averages with their covariance (fit_gls.c).
void fit_series_gls(const struct results *, const struct series *, const struct prediction *,
                    struct arena scratch, struct fit *);
// A straight line through the logarithms (fit_ols.c). Its rate is minus the slope of the measured
// curve, and theory's is minus that of the exact one (theory 3.4).
void fit_series_ols(const struct results *, const struct series *, const struct prediction *,
                    struct arena scratch, struct fit *);

#endif
