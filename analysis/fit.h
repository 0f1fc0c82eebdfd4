// The statistics of an experiment: per cell, probe and quantity a rate, a coefficient, named tests
// and a verdict (theory 4.4-4.7).
#ifndef ANALYSIS_FIT_H
#define ANALYSIS_FIT_H

#include "analysis/fit_bias.h"
#include "analysis/fit_variance.h"
#include "analysis/prediction.h"
#include "log/results.h"

#include <stdio.h>

enum verdict {
  VERDICT_AGREE,
  VERDICT_DISAGREE,       // a test rejects theory at the level of the run
  VERDICT_NOT_DETECTED,   // bias: nothing found; upper_bound says how much there may be
  VERDICT_NOT_RESOLVABLE, // too little is known of the rate to judge it
  VERDICT_NONE,           // the method's standard errors support none
  N_VERDICTS
};
extern const char *const verdict_names[N_VERDICTS];

struct fit_test {
  const char *name; // "rate", "coefficient", "independence", "lack-of-fit", "zero-bias", "silence"
  double statistic, p;
  bool rejects;
};
enum { FIT_TESTS = 4 };

// Numbers that are not known are NAN, and so is a rate that no verdict stands on. Variance: rate a
// of Var(average of N) ~ N^-a, coefficient A [radiance^2], the variance of the first iteration
// without its part that stays constant. Bias: |bias of iteration i| ~ i^-rate, coefficient b_1
// [radiance], the bias of the first iteration (without a closed form: the part of it that is
// proportional to r^2). A method may mean slopes of curves by its rates (fit_methods.h).
struct fit_row {
  const struct cell *cell;
  const struct probe *probe;
  enum quantity quantity;
  bool closed_form;
  uint64_t first; // iteration fitted; the discs of earlier ones touch edges or other surfaces
  double rate_theory, rate, rate_se, rate_lo, rate_hi; // 95 % interval
  double coefficient_theory, coefficient, coefficient_se;
  double snr, expected_snr, upper_bound; // bias: |b_1| / SE, theory's b_1 / SE, 95 %
  struct fit_test test[FIT_TESTS];
  int n_tests;
  // The rate's deviate from theory and its p where the first discs are left out, of a rate without
  // closed form that differs from theory's; p NAN: not asked for. Where these do not reject, the
  // test says them.
  double later_deviate, later_p;
  int looks; // at the runs, each of which could have been the last
  bool resolved, detected;
  enum verdict verdict;
  const char *why; // there is no fit, or nothing is known of the rate; or NULL
};

// The measured curves beside the predicted ones: of the running average, and of single iterations,
// whose variances or biases are averaged in bins, the predicted ones over the same iterations.
enum curve_series { CURVE_ITERATION, CURVE_AVERAGE, N_CURVE_SERIES };
struct fit_point {
  const struct fit_row *row;
  enum curve_series series;
  uint64_t first, n;             // iterations first..n
  double measured, lower, upper; // over runs, 95 % interval
  double pooled;    // variance of the average only: from the iterations' variances; else NAN
  double predicted; // NAN: theory says nothing of some of these iterations
};

struct fit_method;
struct fit {
  const struct experiment *experiment;
  const struct fit_method *method;
  double level;      // family-wise: the chance that any test of the run rejects a true theory
  double test_level; // of one test (Sidak)
  struct fit_row *row;
  int n_rows;
  struct fit_point *point;
  int n_points;
  enum verdict verdict;
};

// Reads the scenes of the experiment for their closed forms; one that was changed since the run is
// a problem, and so is a value that is not finite.
bool fit_results(const struct results *, struct arena *, struct fit *, struct problem *);
bool fit_results_by(const struct fit_method *, const struct results *, struct arena *, struct fit *,
                    struct problem *);

// The same with predictions in hand, one per series (in results' order).
void fit_predicted(const struct results *, const struct prediction *, struct arena *, struct fit *);
void fit_predicted_by(const struct fit_method *, const struct results *, const struct prediction *,
                      struct arena *, struct fit *);

// The largest standard error of the rates that theory says there are (run_options).
double fit_largest_rate_se(const struct results *, struct arena scratch, struct problem *);

bool fit_write_json(const struct fit *, const char *path, struct problem *);
bool fit_write_curves(const struct fit *, const char *path, struct problem *);
// One line a row and the run's verdict; colour only on a terminal and without NO_COLOR.
void fit_print_table(const struct fit *, FILE *);

#endif
