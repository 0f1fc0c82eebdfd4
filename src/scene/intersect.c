// The rows' intersect: the ray tests of scene/shape/*.h with everything worked out for one
// primitive. Shapes of the same kind share the function, which is how the tree knows them.
#include "scene/shape/disk.h"
#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"

bool triangle_intersect(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                        const struct ray *ray, double *t) {
  if (ray->leaving == primitive) return false;
  float vertex[3][3];
  triangle_gather(scene, shape, primitive, vertex);
  struct shear shear;
  shear_set(&shear, ray);
  if (!triangle_accepts(&shear, vertex)) return false;
  struct cone cone;
  cone_set(&cone, ray);
  struct box box = triangle_box(vertex);
  *t = triangle_plane(ray, vertex);
  return clip_accept(&cone, &box, ray->t_max, t);
}

bool disk_intersect(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                    const struct ray *ray, double *t) {
  if (ray->leaving == primitive) return false;
  struct box box = shape->type->bounds(scene, shape, primitive);
  struct cone cone;
  cone_set(&cone, ray);
  return disk_hit(shape_quadric(scene, shape, primitive), &box, &cone, ray, t);
}

bool sphere_intersect(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                      const struct ray *ray, double *t) {
  struct box box = shape->type->bounds(scene, shape, primitive);
  struct cone cone;
  cone_set(&cone, ray);
  bool leaving = ray->leaving == primitive;
  return sphere_hit(shape_quadric(scene, shape, primitive), &box, &cone, ray, leaving, t);
}
