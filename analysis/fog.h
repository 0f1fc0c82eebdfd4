// Light that fog scatters once out of parallel photons, seen along a ray that crosses them at a
// right angle (theory 5 v). With sigma = sigma_t the density of collisions falls as e^(-sigma z), z
// the distance the photons have flown, of which every ball's mean is exact: the mean over a sphere
// of radius t is that of its centre times sinh(sigma t) / (sigma t).
//
// Points (d = 3): the ray ends where it collides, all of whose places see the same density, and a
// photon collides once, so that Y is the kernel's value or 0. A wall ends the ray before, with
// probability e^(-sigma L): such an iteration sees nothing.
//
// Beams (d = 1): the ray takes in every photon that crosses it at most r beside it, at x with the
// weight e^(-sigma x): as x is independent of how far beside, with a photon's density per area D
//   E[Y^j] = (sigma_s f flux)^j e^(-sigma z) int_0^L e^(-j sigma x) dx int k_r^j D dy.
#ifndef ANALYSIS_FOG_H
#define ANALYSIS_FOG_H

#include "analysis/profile.h"

// `radius`: the largest of the kernel in the medium.
bool fog_find(const struct scene *, const struct cell *, const struct probe *, double radius,
              struct profile *);

// What the above is of, in numbers.
struct fog {
  double flux[3];          // W, of every photon
  double sigma_s, sigma_t; // 1 / scene unit
  double phase;            // its value for these directions, 1 / sr
  double depth;            // z, of the ray
  double length;           // L; INFINITY: no wall
};
// Points in photons whose density per area is `density` everywhere.
struct profile fog_of_points(const struct fog *, double density, const struct kernel *,
                             double radius);
// Beams: density[k] that of the distance beside the ray whose square is chebyshev_node(radius^2,
// k), the mean of both sides. `length` may be that of the photons instead of a wall's.
struct profile fog_of_beams(const struct fog *, const double density[CHEBYSHEV_TERMS],
                            const struct kernel *, double radius);

#endif
