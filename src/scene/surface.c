#include "scene/scene.h"

struct surface scene_surface(const struct scene *scene, const struct ray *ray, struct hit hit) {
  struct surface surface = {.p = vec_along(ray->o, ray->d, hit.t),
                            .primitive = hit.primitive,
                            .shape = scene->shape_of[hit.primitive]};
  const struct shape *shape = &scene->shape[surface.shape];
  surface.ng = shape->type->normal(scene, shape, hit.primitive, surface.p);
  return surface;
}
