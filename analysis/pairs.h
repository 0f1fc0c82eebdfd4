// Two photons of one path in one ball. Where a path scatters, its next collision is at distance s
// with the density a sigma / (4 pi s^2) (1 + O(sigma s)), a = sigma_s / sigma, sigma = sigma_t, in
// the mean over directions, whatever the phase function. Both are in a ball with a probability of
// order r^3 (sigma r) and add 1 / r^6:
//   2 int int k_r(y) k_r(y') q a sigma / (4 pi |y - y'|^2) dy dy' = 2 a sigma J q r^-2,
//   J = int int psi(u) psi(v) / (4 pi |u - v|^2) du dv.
// So in a medium the variance of an iteration is R q r^-3 (1 + 2 a sigma r J / R + O((sigma r)^2)),
// where theory 1.3 counts several hits of a path as O(1), which they are on surfaces: 1.5 a sigma r
// for the box. Exact as photons of one path count alike, in gray media of isotropic scattering.
#ifndef ANALYSIS_PAIRS_H
#define ANALYSIS_PAIRS_H

#include "density/kernel.h"

// J / R.
double pairs_constant(const struct kernel *);

#endif
