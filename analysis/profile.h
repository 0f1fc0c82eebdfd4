// Exact moments of one photon path's contribution, where theory knows the irradiance around a probe
// (theory 1.3, 5): E[Y^j] = g^j r^-2(j-1) integral psi^j(u) p(x + r u) du, with g the luminance one
// photon carries, p the density of photons on the plane per emitted path. At most one hit per path.
#ifndef ANALYSIS_PROFILE_H
#define ANALYSIS_PROFILE_H

#include "base/arena.h"
#include "experiment/experiment.h"
#include "log/results.h"
#include "scene/scene.h"

enum { PROFILE_NODES = 48, PROFILE_MOMENTS = 4 };

// Chebyshev coefficients on [0, hi].
struct chebyshev {
  double hi, coefficient[PROFILE_NODES];
};
double chebyshev_value(const struct chebyshev *, double x);

// The density of photons around the probe, averaged over the angle, in the squared distance.
struct ring_mean {
  double flux; // luminance per photon
  struct chebyshev density;
};

// False: there is no closed form for this probe within `radius`.
bool ring_mean_find(const struct scene *, const struct cell *, const struct probe *, double radius,
                    struct arena scratch, struct ring_mean *);

struct profile {
  double exact; // E[Y] as r -> 0
  double flux;
  // In r^2: the integral of psi^j(u) p(x + r u) du, for j = 1 less its limit p(x).
  struct chebyshev moment[PROFILE_MOMENTS];
};
struct profile profile_new(const struct ring_mean *, const struct kernel *, double radius);

// E[Y^j], j = 1..PROFILE_MOMENTS, radiance^j.
double profile_moment(const struct profile *, int j, double r);
// E[Y] at r less its limit, without their cancellation.
double profile_bias(const struct profile *, double r);
// The leading coefficient of E[Y^2]: its limit times r^2.
double profile_roughness(const struct profile *);

#endif
