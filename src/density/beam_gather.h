// The beam x beam estimate with blur in one dimension (Jarosz et al. 2011, "Progressive photon
// beams"): the radiance that photon beams scatter into an eye ray,
//   L_r = 1 / n_emitted * sum over crossings of T(t) sigma_s(x) f(wo, wi) flux k_r(u) / sin theta,
// x at distance t where the eye's ray is closest to the beam, u [scene units] their distance there,
// theta the angle between them, T the transmittance from the eye, sigma_s and the phase function f
// [1/sr] those of x, flux [W] the beam's, k_r(u) = psi(u / r) / r in one dimension [1 / scene
// unit]. The volume in which lines of one direction pass the ray is dt ds du sin theta, with u
// along the common perpendicular: so the mean is the integral over t of T sigma_s f times the
// fluence, blurred over u only, and nothing is lost or doubled at the ends of a piece. No clamp of
// 1 / sin theta: over the directions of space its mean and its square's mean are finite (sin theta
// of them pass, and sin theta dtheta have the angle), its cube's is not, so that no
// kurtosis converges.
#ifndef DENSITY_BEAM_GATHER_H
#define DENSITY_BEAM_GATHER_H

#include "density/beam_tree.h"
#include "density/kernel.h"

// One estimator in one iteration.
struct strip {
  const struct kernel *kernel;
  double r;     // support
  double scale; // c / (r n_emitted)
};

// c = psi(0), kernel->constants(1).c
static inline struct strip strip_of(const struct kernel *kernel, double c, double r,
                                    uint64_t n_emitted) {
  return (struct strip){kernel, r, c / (r * (double)n_emitted)};
}

// Scratch for up to `capacity` beams.
struct beam_gather {
  int64_t capacity;
  uint32_t *found;
  double *u2, *weight, *value[3];
  unsigned left_out; // bits of enum light_path: beams of these bring nothing
};

// Adds to out[strip * stride + c] the radiance in the pixel. tree: NULL: all beams are looked at,
// which changes no bit. depth: pbrt's maxdepth of the whole path. walk: its key and iteration are
// those of random transmittance (walk/eye_segments.h). Sums have the shape of numeric/sum.h over
// the beams that cross within the largest radius. Where a radius is 0 or infinite there is no strip
// and nothing is added.
void beam_gather_segment(struct beam_gather *, const struct walk *walk, const struct beams *,
                         const struct beam_tree *tree, const struct eye_segment *, int depth,
                         const struct strip *, int n_strips, double *out, long stride,
                         struct arena *);

#endif
