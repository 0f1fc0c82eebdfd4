// Iterations in groups that grow with i, for tests of fit: late iterations are many and alike,
// early ones are where a wrong start shows.
#ifndef ANALYSIS_BINS_H
#define ANALYSIS_BINS_H

#include "analysis/solve.h"
#include "base/arena.h"

#include <stdint.h>

struct bins {
  int n;
  uint64_t *end; // bin b holds iterations end[b - 1] + 1 .. end[b]; end[-1] is `first`
};

// Iterations first + 1 .. n. Each bin is as long as a quarter of what came before it, and long
// enough to have this information (the sum over its iterations).
struct bins bins_new(const double *information, uint64_t first, uint64_t n, double enough,
                     struct arena *);

// Chi-squared of the bins' normal deviates after the directions of the fitted parameters (row b of
// `direction`) are taken out; `prior` are precisions already known of them (0: none).
struct chi2 {
  double value, dof; // dof < 1: no test
};
struct chi2 bins_chi2(int n_bins, const double *deviate, const double (*direction)[SOLVE_MAX],
                      int n_parameters, const double prior[SOLVE_MAX]);

#endif
