// The radii of points with local statistics against what theory expects of them (theory 2.4): a
// curve for the figure, and a verdict at the last iteration, where fluctuations have done all that
// they do.
#ifndef ANALYSIS_FIT_RADII_H
#define ANALYSIS_FIT_RADII_H

#include "analysis/fit.h"

// Of one cell at one probe whose radius was logged. Radii are r^2 in units of r_1^2.
struct radius_row {
  const struct cell *cell;
  const struct probe *probe;
  const struct series *series;
  double first_disc; // photons expected in it in the first pass; NAN: no closed form
  double *rho;       // [n_iterations] of the law, which constant density and many photons give
  double *expected, *spread; // [n_iterations] E and deviation of r_i^2 with as many photons as
                             // there are; NULL: no closed form
  double mean, se, p; // at the last iteration, se by theory; p two-sided, NAN: nothing to test
  enum verdict verdict;
};

struct fit_radii {
  struct radius_row *item;
  ptrdiff_t count, capacity;
  double test_level; // each test's share of the run's 0.01
};

bool fit_radii(const struct results *, struct arena *, struct fit_radii *, struct problem *);

// A line per radius and checkpoint: the cell's keys, then
//   x,y          pixel of the probe
//   first_disc   photons expected in the first disc
//   i,runs       iteration, and how many runs the moments are of
//   mean,sd      of r_i^2 / r_1^2 over runs
//   rho          of the law
//   expected,spread   mean and deviation by theory, where there is a closed form
bool fit_radii_write(const struct fit_radii *, const char *path, struct problem *);

// Nothing if no radius was logged.
void fit_radii_print(const struct fit_radii *, FILE *);

#endif
