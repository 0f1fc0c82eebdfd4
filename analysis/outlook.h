// How well an experiment will know its rates, before it is run: the fit of what theory expects to be
// measured, or of what a few runs say is to be expected. Standard errors fall as K^-1/2, so they are
// given for one run.
#ifndef ANALYSIS_OUTLOOK_H
#define ANALYSIS_OUTLOOK_H

#include "analysis/prediction.h"
#include "log/results.h"

struct outlook {
  double variance_se; // of the rate, times the square root of the runs; infinite: cannot be known
  double bias_se;     // NAN: there is no bias; infinite: none was seen
  double bias;        // the smallest to be fitted, of the last iteration [radiance]; NAN: unknown
};

// `pilot`: some runs of the cell, with their biases by Richardson where there are any; not asked for
// in closed form. NULL: there are none.
struct outlook outlook_new(const struct prediction *, const struct series *pilot,
                           struct arena scratch);

// The standard error of a rate with so many runs, and the runs for a standard error.
double outlook_se(double one_run, double runs);
double outlook_runs(double one_run, double se);

#endif
