// Where a ray is inside a box. This is part of what a hit is, not only of culling: a primitive is
// hit only if the clip of its own box is not empty, and its t is clamped into that clip. A box that
// contains another has a clip that contains the other's, exactly, so a tree may skip every box
// whose clip is empty or begins beyond the closest t: it never loses a hit.
//
// The ray is widened to a thin cone: at t it covers o + t (d -+ w) on every axis, w = APERTURE *
// the largest |d|. Without it a ray aimed at an edge could miss the box of the triangle that
// accepts it: projecting a vertex (triangle.h) displaces it by up to 4 eps times its distance from
// o, so an accepted ray passes its triangle by at most 4 eps R, R the distance of the farthest
// vertex. At the hit, at distance h, the cone is APERTURE h wide, so it covers R / h up to APERTURE
// / (4 eps) = 2^30.
//
// Monotone: face - o and (face - o) * scale are monotone in `face` as rounded, the choice of face
// and scale depends on the ray alone, and a NaN (0 * infinity, where the direction underflows)
// loses both comparisons, as the infinity of the right sign would on either side of it.
#ifndef SCENE_SHAPE_CLIP_H
#define SCENE_SHAPE_CLIP_H

#include "scene/scene.h"

#define CLIP_APERTURE 0x1p-20

struct cone {
  double o[3];
  double near_scale[3], far_scale[3]; // 1 / (d +- w), signed as d
  int backward[3];                    // 1: d < 0, the ray enters through `hi`
  bool parallel[3];                   // |d| <= w: the cone reaches both faces and leaves neither
  bool any_parallel;
};

static inline double cone_abs(double x) { return x < 0 ? -x : x; }

static inline void cone_set_axis(struct cone *cone, int k, double o, double d, double w) {
  bool backward = d < 0, parallel = cone_abs(d) <= w;
  double side = backward ? -w : w;
  cone->o[k] = o;
  cone->backward[k] = backward;
  cone->parallel[k] = parallel;
  cone->near_scale[k] = 1 / (parallel ? 2 * w : d + side);
  cone->far_scale[k] = 1 / (d - side);
}

static inline void cone_set(struct cone *cone, const struct ray *ray) {
  double x = cone_abs(ray->d.x), y = cone_abs(ray->d.y), z = cone_abs(ray->d.z);
  double w = x > 0 ? x : 0; // never -0: 1 / w has the sign of a distance
  w = y > w ? y : w;
  w = CLIP_APERTURE * (z > w ? z : w);
  cone_set_axis(cone, 0, ray->o.x, ray->d.x, w);
  cone_set_axis(cone, 1, ray->o.y, ray->d.y, w);
  cone_set_axis(cone, 2, ray->o.z, ray->d.z, w);
  cone->any_parallel = cone->parallel[0] | cone->parallel[1] | cone->parallel[2];
}

// The t >= 0 at which the cone meets the box; false if there is none.
static inline bool cone_clip(const struct cone *cone, const struct box *box, double *t0,
                             double *t1) {
  double near = 0, far = INFINITY;
  for (int k = 0; k < 3; k++) {
    double lo = (double)box->lo[k] - cone->o[k], hi = (double)box->hi[k] - cone->o[k];
    if (cone->parallel[k]) {
      double outside = lo > -hi ? lo : -hi;
      if (outside * cone->near_scale[k] > near) near = outside * cone->near_scale[k];
      continue;
    }
    double enter = (cone->backward[k] ? hi : lo) * cone->near_scale[k];
    double leave = (cone->backward[k] ? lo : hi) * cone->far_scale[k];
    if (enter > near) near = enter;
    if (leave < far) far = leave;
  }
  *t0 = near, *t1 = far;
  return near <= far;
}

// The t of a primitive from the t of its surface: a hit if it lies ahead and within t_max. A t that
// is not finite is none.
static inline bool clip_accept(const struct cone *cone, const struct box *box, double t_max,
                               double *t) {
  double t0, t1;
  if (!(*t > 0 && *t < INFINITY) || !cone_clip(cone, box, &t0, &t1)) return false;
  if (*t < t0) *t = t0;
  if (*t > t1) *t = t1;
  return *t > 0 && *t < t_max;
}

#endif
