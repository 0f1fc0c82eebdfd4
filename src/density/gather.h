// The density estimate at eye points, for all estimators of a group at once (theory 1.1):
//   L_r(x) = 1/n_emitted * sum over photons p of k_r(x_p - x) f(wo, wi_p) flux_p.
// A photon counts iff it is within the 3D distance r and the BSDF value at the eye point scatters its
// direction: from the side of the eye where only reflection is, from the other where light is
// transmitted. No other test. Where the shading normal is not the geometric one, the flux is
// corrected (bsdf_photon_factor), so that the limit is what an eye path measures.
#ifndef DENSITY_GATHER_H
#define DENSITY_GATHER_H

#include "density/grid.h"
#include "density/kernel.h"
#include "walk/eye.h"

// One estimator at one point and iteration.
struct disc {
  const struct kernel *kernel;
  double r;     // support
  double scale; // c / (r^2 n_emitted)
};

// c = psi(0), kernel->constants(2).c
static inline struct disc disc_of(const struct kernel *kernel, double c, double r,
                                  uint64_t n_emitted) {
  return (struct disc){kernel, r, c / (r * r * (double)n_emitted)};
}

// Scratch for queries on grids of up to `capacity` photons.
struct gather {
  int64_t capacity;
  uint32_t *photon;
  double *distance2, *t2, *weight, *value[3];
  unsigned left_out; // bits of enum light_path: photons of these count, but bring nothing
};

// Adds to out[disc * stride + c] the radiance towards the eye at `point`. The grid's r is at least
// every disc's. Sums have the shape of numeric/sum.h over the photons in the largest disc.
// depth: pbrt's maxdepth of the whole path. count: NULL, or the photons within each disc that the
// point scatters.
void gather_point(struct gather *, const struct photons *, const struct grid *,
                  const struct eye_point *, int depth, const struct disc *, int n_discs,
                  int64_t *count, double *out, long stride, struct arena *);

#endif
