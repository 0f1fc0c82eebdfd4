// What sphere and disk share: a row of scene.quadric, reading phimax, normals through a transform.
#ifndef SCENE_SHAPE_QUADRIC_H
#define SCENE_SHAPE_QUADRIC_H

#include "numeric/elementary.h"
#include "scene/box.h"
#include "scene/read.h"

static const double quadric_two_pi = 0x1.921fb54442d18p+2;

static inline const struct quadric *quadric_of(const struct scene *scene,
                                               const struct shape *shape) {
  return &scene->quadric[shape->local];
}

// `float phimax` in degrees -> radians; 360 gives 2 pi exactly.
static inline double quadric_read_phi_max(struct params *params) {
  double degrees = params_float(params, "phimax", 360);
  if (!(degrees > 0 && degrees <= 360))
    params_complain(params, "phimax", "phimax must be in (0, 360] degrees");
  return degrees / 360 * quadric_two_pi;
}

static inline double quadric_read_radius(struct params *params) {
  double radius = params_float(params, "radius", 1);
  if (!(radius > 0)) params_complain(params, "radius", "the radius must be positive");
  return radius;
}

// The object-space normal n in world space, of unit length, flipped as the shape says.
static inline struct vec quadric_normal(const struct quadric *quadric, const struct shape *shape,
                                        struct vec n) {
  n = vec_normalize(transform_normal(&quadric->object_from_world, n));
  return shape->flip ? vec_scale(n, -1) : n;
}

// cos and sin of the angle u phi_max.
static inline void quadric_angle(const struct quadric *quadric, double u, double *cosine,
                                 double *sine) {
  num_sincos_turns(u * (quadric->phi_max / quadric_two_pi), sine, cosine);
}

#endif
