// The density estimate at eye points, for all estimators of a group at once (theory 1.1):
//   L_r(x) = 1/n_emitted * sum over photons p of k_r(x_p - x) f(wo, wi_p) flux_p.
// A photon counts iff it is within the 3D distance r and the BSDF value at the eye point scatters
// its direction: from the side of the eye where only reflection is, from the other where light is
// transmitted. No other test. Where the shading normal is not the geometric one, the flux is
// corrected (bsdf_photon_factor), so that the limit is what an eye path measures.
//
// What it is a density of. On surfaces (d = 2) photons carry flux [W]: the density is irradiance
// [W / unit^2], f [1/sr] the BSDF. In media (d = 3) every collision leaves a photon, scattered or
// absorbed, that carries flux over sigma_t of its own place and channel [W x unit]: the density is
// fluence rate [W / unit^2], f [1/sr] the phase function, and point->weight holds sigma_s of the
// eye point [1 / unit]. So the kernel averages fluence alone, which is smooth also where the medium
// is not; what the medium scatters is what it scatters at the eye point. A ball that reaches into a
// wall, or out of the medium, lacks photons there (theory 1.5): near walls the estimate is too low,
// in a layer as thick as r, so that a pixel that sees a wall through a medium has a bias of order
// r.
#ifndef DENSITY_GATHER_H
#define DENSITY_GATHER_H

#include "density/grid.h"
#include "density/kernel.h"
#include "density/knn.h"
#include "density/law.h"
#include "walk/eye.h"

// One estimator at one point and iteration; in media a ball.
struct disc {
  const struct kernel *kernel;
  double r;     // support
  double scale; // c / (r^d n_emitted)
};

// c = psi(0) in d dimensions, kernel->constants(d).c; d = 2: a disc, 3: a ball.
static inline struct disc disc_of(const struct kernel *kernel, double c, double r, int d,
                                  uint64_t n_emitted) {
  return (struct disc){kernel, r, c / (radius_power(r, d) * (double)n_emitted)};
}

// Scratch for queries on grids of up to `capacity` photons.
struct gather {
  int64_t capacity;
  uint32_t *photon;
  struct vec *wi;
  double *distance2, *weight, *value[3];
  unsigned left_out; // bits of enum light_path: photons of these count, but bring nothing
};

// Adds to out[disc * stride + c] the radiance towards the eye at `point`. The grid's r is at least
// every disc's. Sums have the shape of numeric/sum.h over the photons in the largest disc.
// depth: pbrt's maxdepth of the whole path. count: NULL, or the photons within each disc that the
// point scatters. Where a radius is 0 or infinite (or its square is, or it is no number) there is
// no disc: nothing is added and nothing counted.
void gather_point(struct gather *, const struct grid *, const struct eye_point *, int depth,
                  const struct disc *, int n_discs, int64_t *count, double *out, long stride,
                  struct arena *);

// The same for radii of any size.
void gather_point_in_tree(struct gather *, const struct photons *, const struct knn *,
                          const struct eye_point *, int depth, const struct disc *, int n_discs,
                          int64_t *count, double *out, long stride, struct arena *);

// The estimates from the k[disc] nearest of the photons that the point scatters, in discs given as
// of radius 1. A radius taken from the photons it counts is biased: with all k of a constant
// density the box gives k / (k - 1) of it. The k-th sets the radius and is left out of the sum;
// then every kernel is right there (theory 1.5; the factor (k - 1) / k would be right for the box
// only). If there are fewer, the k-th is infinitely far and nothing is added. k = 0: not asked for.
void gather_nearest(struct gather *, const struct photons *, const struct knn *,
                    const struct eye_point *, int depth, const struct disc *, const int *k,
                    int n_discs, double *out, long stride, struct arena *);

// To the k-th nearest of the photons that the point scatters; INFINITY if there are fewer.
double gather_distance(struct gather *, const struct photons *, const struct knn *,
                       const struct eye_point *, int depth, int k, struct arena *);

#endif
