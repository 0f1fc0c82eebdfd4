// The rows' intersect: the ray tests of scene/shape/*.h with everything worked out for one
// primitive. Shapes of the same kind share the function, which is how the tree knows them.
#include "scene/shape/cylinder.h"
#include "scene/shape/disk.h"
#include "scene/shape/patch.h"
#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"

// The corners of the triangle or plane patch that the ray leaves; how many, 0 if it leaves neither.
static int left_corners(const struct scene *scene, const struct ray *ray, float corner[4][3]) {
  if (ray->leaving == PRIMITIVE_NONE) return 0;
  const struct shape *shape = &scene->shape[scene->shape_of[ray->leaving]];
  if (shape->type->intersect == triangle_intersect) {
    triangle_gather(scene, shape, ray->leaving, corner);
    return 3;
  }
  if (shape->type->intersect != patch_intersect) return 0;
  patch_gather(scene, shape, ray->leaving, corner);
  struct vec p = triangle_vertex(corner[3]);
  double height = vec_dot(triangle_cross(corner), vec_sub(p, triangle_vertex(corner[0])));
  return height == 0 ? 4 : 0;
}

static bool vertex_is_shared(const float vertex[3], const float other[][3], int n) {
  for (int i = 0; i < n; i++)
    if (vertex[0] == other[i][0] && vertex[1] == other[i][1] && vertex[2] == other[i][2])
      return true;
  return false;
}

// The hull of these n vertices lies wholly in the plane the ray leaves, or behind it.
static bool is_left_behind(const struct scene *scene, const struct ray *ray,
                           const float vertex[][3], int n) {
  float left[4][3];
  int n_left = left_corners(scene, ray, left);
  if (!n_left) return false;
  struct vec normal = triangle_cross(left), p = triangle_vertex(left[0]);
  double side = vec_dot(normal, ray->d);
  if (side == 0) return false;
  for (int i = 0; i < n; i++) {
    double height = vec_dot(normal, vec_sub(triangle_vertex(vertex[i]), p));
    if ((side > 0 ? height > 0 : height < 0) && !vertex_is_shared(vertex[i], left, n_left))
      return false;
  }
  return true;
}

bool triangle_is_left_behind(const struct scene *scene, const struct ray *ray,
                             const float vertex[3][3]) {
  return is_left_behind(scene, ray, vertex, 3);
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
  bool leaving = ray->leaving == primitive;
  return patch_hit(vertex, &box, &cone, ray, leaving, t) &&
         (leaving || !is_left_behind(scene, ray, vertex, 4));
}
