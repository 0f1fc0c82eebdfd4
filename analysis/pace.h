// Errors of methods against the CPU time they take, over independent runs: what a method's error is
// at some time, which of two is ahead when, and where they change places.
#ifndef ANALYSIS_PACE_H
#define ANALYSIS_PACE_H

#include <stdbool.h>

// Of one method: [n_runs][n_points], all above 0, times of a run rising. Between its points a run's
// error is a power of its time.
struct pace {
  int n_runs, n_points; // at least 2 runs, for a spread; n_points may be 0: no error is known
  const double *time_s, *error;
};

// Where all runs have an error. False: nowhere.
struct pace_span {
  double from_s, to_s;
};
bool pace_span(const struct pace *, struct pace_span *);
bool pace_common(const struct pace *, const struct pace *, struct pace_span *);

// The mean over runs, and its standard error.
struct pace_error {
  double mean, se;
};
struct pace_error pace_at(const struct pace *, double time_s);

// From `from_s` to `to_s` one of the two, `ahead` (0 or 1), has the smaller error, by more than its
// spread explains: a two-sided t-test of the ratio of the means at each time, at 5 %.
struct pace_lead {
  int ahead;
  double from_s, to_s;
  double crossed_s; // when the means crossed before it, since the lead before; NAN: the first lead
};
enum { PACE_LEADS = 16 };

// The leads in the common span, each by another one than the lead before; returns how many. None:
// the two cannot be told apart. More than PACE_LEADS are not looked for.
int pace_leads(const struct pace *, const struct pace *, struct pace_lead lead[PACE_LEADS]);

#endif
