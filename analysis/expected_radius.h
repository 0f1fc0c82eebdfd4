// The radii that a cell's local statistics are expected to have at a probe, where the light around
// it has a closed form on a plane (elsewhere a photon's path may arrive twice).
#ifndef ANALYSIS_EXPECTED_RADIUS_H
#define ANALYSIS_EXPECTED_RADIUS_H

#include "analysis/profile.h"

// moment[i - 1] = E[(r_i / r_1)^(2 power)], i = 1..n, power 1 or 2. False: no closed form within
// r1, or none needed, since the law does not count photons.
bool expected_radius(const struct scene *, const struct cell *, const struct probe *, double r1,
                     int power, uint64_t n, double *moment, struct arena scratch);

// Photons expected in the first disc; NAN: no closed form.
double expected_first_disc(const struct scene *, const struct cell *, const struct probe *,
                           double r1, struct arena scratch);

#endif
