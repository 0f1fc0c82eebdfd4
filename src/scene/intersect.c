// The rows' intersect: the ray tests of scene/shape/*.h with everything worked out for one
// primitive. Shapes of the same kind share the function, which is how the tree knows them.
#include "scene/shape/cylinder.h"
#include "scene/shape/disk.h"
#include "scene/shape/patch.h"
#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"

static bool vertex_is_shared(const float vertex[3], const float other[3][3]) {
  for (int i = 0; i < 3; i++)
    if (vertex[0] == other[i][0] && vertex[1] == other[i][1] && vertex[2] == other[i][2])
      return true;
  return false;
}

bool triangle_is_left_behind(const struct scene *scene, const struct ray *ray,
                             const float vertex[3][3]) {
  if (ray->leaving == PRIMITIVE_NONE) return false;
  const struct shape *shape = &scene->shape[scene->shape_of[ray->leaving]];
  if (shape->type->intersect != triangle_intersect) return false;
  float left[3][3];
  triangle_gather(scene, shape, ray->leaving, left);
  struct vec n = triangle_cross(left), p = triangle_vertex(left[0]);
  double side = vec_dot(n, ray->d);
  if (side == 0) return false;
  for (int i = 0; i < 3; i++) {
    double height = vec_dot(n, vec_sub(triangle_vertex(vertex[i]), p));
    if ((side > 0 ? height > 0 : height < 0) && !vertex_is_shared(vertex[i], left)) return false;
  }
  return true;
}

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
  return clip_accept(&cone, &box, ray->t_max, t) && !triangle_is_left_behind(scene, ray, vertex);
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

bool cylinder_intersect(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                        const struct ray *ray, double *t) {
  struct box box = shape->type->bounds(scene, shape, primitive);
  struct cone cone;
  cone_set(&cone, ray);
  bool leaving = ray->leaving == primitive;
  return cylinder_hit(shape_quadric(scene, shape, primitive), &box, &cone, ray, leaving, t);
}

bool patch_intersect(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                     const struct ray *ray, double *t) {
  float vertex[4][3];
  patch_gather(scene, shape, primitive, vertex);
  struct box box = patch_box(vertex);
  struct cone cone;
  cone_set(&cone, ray);
  return patch_hit(vertex, &box, &cone, ray, ray->leaving == primitive, t);
}
