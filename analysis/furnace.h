// Fog in a white furnace: a closed room of flat walls that all emit L_e and reflect rho diffusely,
// full of a medium that only scatters. Radiance is L = L_e / (1 - rho) everywhere in all
// directions, and so photons are uniform; what a ball lacks is what would be behind the wall that
// ends the ray, met at the cosine c at the distance D (see analysis/terms.h):
//   bias = -L sigma r / c e^(-sigma D) int_0^1 e^(x a) M(a) da,   x = sigma r / c,
// M(a) the share of a kernel beyond the distance a r. By parts, with the density of |u| in psi's
// marginal along an axis, the integral is
//   int_0^1 2 pi s psi(s) (e^(x s) - 1 - x s) / x^2 ds,   which tends to E|u_1| / 2.
// The wall itself is in uniform light: what is seen there has no bias while no other is near.
#ifndef ANALYSIS_FURNACE_H
#define ANALYSIS_FURNACE_H

#include "experiment/experiment.h"
#include "log/results.h"
#include "scene/scene.h"

struct furnace {
  double radiance; // L, luminance
  double sigma;    // sigma_t = sigma_s
  double distance; // D
  double cosine;   // c
};

// False: the scene is something else, or another wall is within `radius` of the ray.
bool furnace_find(const struct scene *, const struct cell *, const struct probe *, double radius,
                  struct arena scratch, struct furnace *);

// Of photon points.
double furnace_bias(const struct furnace *, const struct kernel *, double r);

#endif
