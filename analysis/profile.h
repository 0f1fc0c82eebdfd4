// Exact moments of one photon path's contribution, where theory knows the light around a probe
// (theory 1.3, 5): E[Y^j] = g^j r^-d(j-1) times a function of r that stays finite, with g the
// luminance one photon carries. Where a path arrives at most once, as on a plane, the function is
// the integral of psi^j(u) p(x + r u) du, p the density of photons per emitted path.
#ifndef ANALYSIS_PROFILE_H
#define ANALYSIS_PROFILE_H

#include "analysis/ring_mean.h"
#include "base/arena.h"
#include "experiment/experiment.h"
#include "log/results.h"
#include "scene/scene.h"

enum { PROFILE_MOMENTS = 4 };

struct profile {
  int d;        // dimensions of what the kernel covers
  double exact; // E[Y] as r -> 0
  double flux;
  // In r^2, without the shadow: that function, for j = 1 less its limit.
  struct chebyshev moment[PROFILE_MOMENTS];
  struct half_shadow shadow; // of a half-plane, where the density of photons is this
  double density, spread;
  struct chebyshev beyond[PROFILE_MOMENTS]; // of a spread: shadow_beyond in sqrt(1 - distance)
  const struct kernel *kernel;
  double blind; // probability that an iteration looks where there is nothing
};
struct profile profile_new(const struct ring_mean *, const struct kernel *, double radius);

// Planes, under mirrors and shadows as well, the inside of a sphere (analysis/sphere.h), and fog
// (analysis/fog.h), there with `radius` that of the medium.
bool profile_find(const struct scene *, const struct cell *, const struct probe *, double radius,
                  struct arena scratch, struct profile *);

// What is random from iteration to iteration beside the photons: where in its pixel the probe is,
// or how far its ray gets. A view is a place, or many that are alike.
enum { PROFILE_NODES = 16, PROFILE_VIEWS = 2 * PROFILE_NODES + 2 };
struct profile_view {
  double weight;                  // they sum to 1
  double bias;                    // of E[Y] there, less its limit there
  double moment[PROFILE_MOMENTS]; // E[Y^j] there
};
int profile_views(const struct profile *, double r, struct profile_view[PROFILE_VIEWS]);

// At the probe itself: E[Y^j], j = 1..PROFILE_MOMENTS, radiance^j.
double profile_moment(const struct profile *, int j, double r);
// E[Y] at r less its limit, without their cancellation.
double profile_bias(const struct profile *, double r);
// Its terms: what r^2 and r^4 are multiplied by, near r = 0. False: at a shadow it has none.
bool profile_bias_terms(const struct profile *, double *second, double *fourth);
// The leading coefficient of E[Y^2]: its limit times r^2. Of a probe in the dark 0.
double profile_roughness(const struct profile *);

#endif
