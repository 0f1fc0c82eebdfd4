// What the curves of an average of N iterations tend to, and where variance and bias meet (theory
// 3.2, 3.3).
#ifndef ANALYSIS_RATES_H
#define ANALYSIS_RATES_H

#include "analysis/expansion.h"

// What is not known, or does not exist, is NAN.
struct rates {
  struct asymptote variance, bias; // ~ constant N^-exponent
  double best_alpha;      // with which the error of a fixed first radius falls fastest: 4 / (d + 4)
  double best_alpha_at_n; // with which it is least after n iterations
  double best_radius;     // in units of r1: with which it is least after n iterations
  double best_rmse;       // with that radius
  double penalty;         // best_rmse / the best that a constant radius can do; leading terms
  // bias^2 and variance change places for the last time at N = crossover, or never (0) up to 1e14.
  uint64_t crossover;
  bool bias_last; // bias^2 is the larger one from then on
  // Weights proportional to rho_i instead of equal ones (photons pooled): the average of n has its
  // variance and bias multiplied by these.
  double pooled_variance, pooled_bias;
};

struct rates rates_new(const struct model *, uint64_t n);

#endif
