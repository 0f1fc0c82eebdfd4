// Ray and cylinder: x^2 + y^2 = radius^2 in object space, z_min <= z <= z_max, 0 <= phi <= phi_max.
// The roots are the sphere's (sphere.h), without z: a ray that leaves drops the one that is its
// origin.
#ifndef SCENE_SHAPE_CYLINDER_H
#define SCENE_SHAPE_CYLINDER_H

#include "scene/shape/sphere.h"

static inline bool cylinder_hit(const struct quadric *c, const struct box *box,
                                const struct cone *cone, const struct ray *ray, bool leaving,
                                double *t) {
  struct vec o = transform_point(&c->object_from_world, ray->o);
  struct vec d = transform_direction(&c->object_from_world, ray->d);
  double root[2];
  if (!sphere_roots(vec(o.x, o.y, 0), vec(d.x, d.y, 0), c->radius, root)) return false;
  int first = root[1] < root[0];
  for (int i = 0; i < 2; i++) {
    int j = first ^ i;
    if (leaving && j == 0) continue;
    *t = root[j];
    struct vec p = vec_along(o, d, *t);
    if (p.z >= c->z_min && p.z <= c->z_max && quadric_sweeps(c, p.x, p.y) &&
        clip_accept(cone, box, ray->t_max, t))
      return true;
  }
  return false;
}

// shape_type.intersect of the cylinder (scene/intersect.c).
bool cylinder_intersect(const struct scene *, const struct shape *, uint32_t primitive,
                        const struct ray *, double *t);

#endif
