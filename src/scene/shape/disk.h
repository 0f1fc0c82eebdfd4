// Ray and disk: z = height in object space, inner_radius <= distance from the axis <= radius,
// 0 <= phi <= phi_max. Flat: a ray that leaves a disk does not hit it.
#ifndef SCENE_SHAPE_DISK_H
#define SCENE_SHAPE_DISK_H

#include "numeric/elementary.h"
#include "scene/shape/clip.h"

#define QUADRIC_TURN 6.283185307179586 // 2 pi

static inline const struct quadric *shape_quadric(const struct scene *scene,
                                                  const struct shape *shape, uint32_t primitive) {
  return &scene->quadric[shape->local + (primitive - shape->first)];
}

// Whether an angle from the x axis, in [0, 2 pi), is part of the sweep.
static inline bool quadric_sweeps(const struct quadric *q, double x, double y) {
  if (q->phi_max >= QUADRIC_TURN) return true;
  double phi = num_atan2(y, x);
  return (phi < 0 ? phi + QUADRIC_TURN : phi) <= q->phi_max;
}

static inline bool disk_hit(const struct quadric *q, const struct box *box, const struct cone *cone,
                            const struct ray *ray, double *t) {
  struct vec o = transform_point(&q->object_from_world, ray->o);
  struct vec d = transform_direction(&q->object_from_world, ray->d);
  if (d.z == 0) return false;
  *t = (q->height - o.z) / d.z;
  struct vec p = vec_along(o, d, *t);
  double r2 = p.x * p.x + p.y * p.y;
  if (!(r2 <= q->radius * q->radius && r2 >= q->inner_radius * q->inner_radius)) return false;
  return quadric_sweeps(q, p.x, p.y) && clip_accept(cone, box, ray->t_max, t);
}

// shape_type.intersect of the disk (scene/intersect.c).
bool disk_intersect(const struct scene *, const struct shape *, uint32_t primitive,
                    const struct ray *, double *t);

#endif
