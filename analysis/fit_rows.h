// From fits to rows: the tests of one series, and its points for the figure.
#ifndef ANALYSIS_FIT_ROWS_H
#define ANALYSIS_FIT_ROWS_H

#include "analysis/fit.h"

// A bias is detected from here (theory 4.6); its rate is resolved if it is known to `0.1`, within
// an interval of 0.3.
static const double fit_detection_snr = 3;

extern const char fit_no_reference[];    // why a bias has no fit
extern const char fit_dark_reference[];
extern const char fit_noisy_reference[]; // or no rate
extern const char fit_large_discs[];

// What is said of rate and coefficient instead of what the fits of the iterations say, whose
// `weights`, [n] variances of one iteration, the data have.
struct fit_estimators {
  // Why there is no estimate, or NULL.
  const char *(*variance)(const struct prediction *, const struct series *, const double *weights,
                          struct variance_fit *, struct arena scratch);
  void (*bias)(const struct prediction *, const struct series *, const double *weights,
               const struct variance_fit *, struct bias_fit *, struct arena scratch);
};

// Appends the series' rows and points to the fit, which has room for them. The points are those of
// the iterations' fits whatever the rows say.
void fit_series_by(const struct fit_estimators *, const struct results *, const struct series *,
                   const struct prediction *, struct arena scratch, struct fit *);
// By likelihood, iteration by iteration.
void fit_series(const struct results *, const struct series *, const struct prediction *,
                struct arena scratch, struct fit *);

// The keys of a cell as fields of a table, each with a comma after it.
void fit_print_keys(FILE *, const struct cell *);

// Points of one row (fit_points.c).
void fit_variance_points(const struct series *, const struct variance_fit *, const struct fit_row *,
                         struct fit *);
void fit_bias_points(const struct series *, const struct prediction *, const struct variance_fit *,
                     const struct bias_fit *, const struct fit_row *, struct fit *);

#endif
