// The variances of the iterations as a model of one or two coefficients and a rate, fitted to the
// measured ones by gamma quasi-likelihood (theory 4.4a).
#ifndef ANALYSIS_VARIANCE_MODEL_H
#define ANALYSIS_VARIANCE_MODEL_H

#include "analysis/prediction.h"
#include "analysis/solve.h"

// V_i = coefficient[0] (divergent / t [+ rest]) [+ coefficient[1] rest], t = rho(rate) /
// rho(theory).
struct variance_model {
  const struct prediction *theory;
  const double *measured, *dispersion; // S_i^2, phi_i
  int n_coefficients;                  // 1 in closed form
  double *log_ratio, *slope;           // scratch, [n]
};

struct variance_point {
  double coefficient[2], rate;
};

struct variance_row {
  double variance, by[3]; // V_i and its derivatives by the coefficients and the rate
};

// Row j at the rate of the last climb, fill or family_ratio.
struct variance_row variance_model_row(const struct variance_model *, const struct variance_point *,
                                       uint64_t j);

// The coefficient at theory's rate, closely.
struct variance_point variance_model_start(const struct variance_model *);

// Climbs from *at to the top, over the coefficients and, if asked, the rate; then *eq is the
// information there. False: it does not get there.
bool variance_model_climb(const struct variance_model *, bool free_rate, struct variance_point *at,
                          struct normal_equations *eq);

// V_i, [n]; iterations that are not fitted keep what was measured.
void variance_model_fill(const struct variance_model *, const struct variance_point *,
                         double *variance);

#endif
