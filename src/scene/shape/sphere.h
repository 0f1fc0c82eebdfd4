// Ray and sphere: |p| = radius in object space, z_min <= z <= z_max, 0 <= phi <= phi_max.
// The roots of a t^2 + 2 b t + c = 0 are q / a and c / q with q = -(b + sign(b) sqrt(b^2 - a c)):
// no subtraction of nearly equal numbers. b^2 - a c is computed as a (r^2 - |closest point|^2),
// which keeps its digits when the origin is far away (Haines et al. 2019, "Precision Improvements
// for Ray/Sphere Intersection"). An origin on the sphere makes c zero but for rounding, so of the
// two roots c / q, always the smaller in magnitude, is the origin itself: a ray that leaves the
// sphere drops that root, whatever its value. No bound on t has to be chosen: where the chord is as
// short as the rounding of the origin, the root that is left is still the other one.
#ifndef SCENE_SHAPE_SPHERE_H
#define SCENE_SHAPE_SPHERE_H

#include "scene/shape/disk.h"

static inline bool sphere_sweeps(const struct quadric *s, struct vec p) {
  if (s->z_min > -s->radius && p.z < s->z_min) return false;
  if (s->z_max < s->radius && p.z > s->z_max) return false;
  return quadric_sweeps(s, p.x, p.y);
}

// roots[0] = c / q, the smaller in magnitude; roots[1] = q / a.
static inline bool sphere_roots(struct vec o, struct vec d, double radius, double roots[2]) {
  double a = vec_dot(d, d), b = vec_dot(o, d), c = vec_dot(o, o) - radius * radius;
  double closest = vec_length(vec_along(o, d, -b / a));
  double discriminant = a * (radius - closest) * (radius + closest);
  if (!(discriminant >= 0)) return false;
  double root = sqrt(discriminant), q = b < 0 ? root - b : -(b + root);
  roots[0] = c / q, roots[1] = q / a;
  return true;
}

static inline bool sphere_hit(const struct quadric *s, const struct box *box,
                              const struct cone *cone, const struct ray *ray, bool leaving,
                              double *t) {
  struct vec o = transform_point(&s->object_from_world, ray->o);
  struct vec d = transform_direction(&s->object_from_world, ray->d);
  double root[2];
  if (!sphere_roots(o, d, s->radius, root)) return false;
  int first = root[1] < root[0];
  for (int i = 0; i < 2; i++) {
    int j = first ^ i;
    if (leaving && j == 0) continue;
    *t = root[j];
    if (sphere_sweeps(s, vec_along(o, d, *t)) && clip_accept(cone, box, ray->t_max, t)) return true;
  }
  return false;
}

// shape_type.intersect of the sphere (scene/intersect.c).
bool sphere_intersect(const struct scene *, const struct shape *, uint32_t primitive,
                      const struct ray *, double *t);

#endif
