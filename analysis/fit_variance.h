// The variance of one cell at one probe: rate and coefficient from the variances over runs of every
// iteration (theory 4.4a), and whether the iterations are independent (theory 4.1).
#ifndef ANALYSIS_FIT_VARIANCE_H
#define ANALYSIS_FIT_VARIANCE_H

#include "analysis/bins.h"
#include "analysis/prediction.h"

struct variance_fit {
  const char *why; // there is no fit; NULL: there is, else nothing below `silence` is meant
  // Where a closed form says that values vary and they do not, or that there is no light and some
  // is found: how probable that is. Else NAN.
  double silence;
  double rate, rate_se;               // where none is found, as from one iteration: NAN, infinite
  double rate_lo, rate_hi;            // 95 % interval
  double coefficient, coefficient_se; // of prediction.divergent, with the rate held at theory
  double null_se; // relative standard error of the coefficient if theory is right
  double dof;     // of a chi-squared with this relative variance
  // Against theory: Student's t, of so many degrees of freedom; infinitely many: normal.
  double rate_deviate, coefficient_deviate, deviate_dof;
  struct chi2 lack_of_fit;
  double *variance;   // [n] fitted, rate free where it was found
  double *expected;   // [n] fitted, rate at theory; theory itself in closed form
  double *dispersion; // [n] relative variance of the measured variance of one iteration
  double *worth;      // [n] of one iteration in a bin; a bin needs 1
};

struct variance_fit fit_variance(const struct prediction *, const struct moments *iteration,
                                 struct arena *);

// Interval and deviates from the estimates and their standard errors, taken as known.
void variance_fit_judge(struct variance_fit *, const struct prediction *);

// Deviate of (variance of the average) / (the mean of the iterations' variances / N), which are
// equal iff iterations are uncorrelated. NAN where there is nothing to compare.
double fit_independence(const struct variance_fit *, const struct series *, double *ratio);

#endif
