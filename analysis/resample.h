// Bootstrap: runs drawn with replacement, always whole ones, since their averages share iterations
// (theory 4.4c).
#ifndef ANALYSIS_RESAMPLE_H
#define ANALYSIS_RESAMPLE_H

#include <stdbool.h>

// With so many, percentiles are values themselves: 2.5 % is the 25th.
enum { RESAMPLES = 999 };
enum { RESAMPLE_LEAST_RUNS = 20 }; // theory 4.4c

// How often each of `runs` is drawn in resample b = 1..RESAMPLES, and a normal number of its own,
// for an error that the runs do not show. The same for all data of so many runs.
void resample_runs(int b, int runs, double *count, double *normal);

// Mean and variance of the runs drawn, x[run] as deviations from their mean. The variance is
// multiplied by what makes its expectation that of the runs.
struct resampled {
  double mean, variance;
};
struct resampled resample_moments(int runs, const double *count, const double *x);

// Of RESAMPLES estimates, which are sorted: percentiles 2.5 and 97.5, and the standard error: their
// standard deviation, but what is drawn from so many runs scatters (1 - 1 / runs) as much as runs
// do. False: one of them is none (NAN), so that where it belongs is not known.
struct spread_of_resamples {
  double se, lo, hi;
};
bool resample_spread(double *value, int runs, struct spread_of_resamples *);

#endif
