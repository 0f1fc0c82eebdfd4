// The bias of one cell at one probe: coefficient and rate from the means over runs of every
// iteration, on the linear scale, with one shared offset for the error of the reference (theory
// 4.4a, 4.6, 4.7).
#ifndef ANALYSIS_FIT_BIAS_H
#define ANALYSIS_FIT_BIAS_H

#include "analysis/bias_family.h"
#include "analysis/bins.h"
#include "analysis/fit_variance.h"
#include "analysis/prediction.h"

struct bias_fit {
  bool measured;                      // else nothing below is meant
  double coefficient, coefficient_se; // of prediction.bias, the exponent held at theory
  double snr;                         // their ratio, positive
  double *expected;                   // [n] fitted bias, the exponent held at theory
  struct chi2 lack_of_fit;            // rate free where it was found, else held
  bool rate_found;                    // the profile closes on both sides within the range searched
  double rate, rate_se, rate_lo, rate_hi; // see bias_theory_rate; 95 % profile interval
  double rate_se_theory;                  // standard error of the rate if theory is right
  double rate_deviate;                    // signed root of the likelihood ratio against theory
  double dof; // of the variance that the standard errors rest on: deviates are Student's t
};

// With the variance's fit, and [n] its variances of one iteration that weigh the means.
struct bias_fit fit_bias(const struct prediction *, const struct moments *iteration,
                         const struct variance_fit *, const double *variance, struct arena *);

#endif
