#include "scene/scene.h"

struct surface scene_surface(const struct scene *scene, const struct ray *ray, struct hit hit) {
  struct surface surface = {.p = vec_along(ray->o, ray->d, hit.t),
                            .primitive = hit.primitive,
                            .shape = scene->shape_of[hit.primitive]};
  const struct shape *shape = &scene->shape[surface.shape];
  surface.ng = shape->faceted ? scene->facet[hit.primitive]
                              : shape->type->normal(scene, shape, hit.primitive, surface.p);
  surface.ns = surface.ng;
  if (shape->detailed) shape->type->detail(scene, shape, &surface);
  return surface;
}

// x along dpdu made orthogonal to the shading normal.
static void set_frame(struct bsdf *bsdf, const struct surface *surface) {
  bsdf->ng = surface->ng;
  bsdf->n = surface->ns;
  bsdf->bent = surface->ns.x != surface->ng.x || surface->ns.y != surface->ng.y ||
               surface->ns.z != surface->ng.z;
  struct vec across = vec_along(surface->dpdu, bsdf->n, -vec_dot(surface->dpdu, bsdf->n));
  if (vec_dot(across, across) > 0) {
    bsdf->s = vec_normalize(across);
    bsdf->t = vec_cross(bsdf->n, bsdf->s);
  } else {
    vec_basis(bsdf->n, &bsdf->s, &bsdf->t);
  }
}

struct bsdf surface_bsdf(const struct scene *scene, const struct surface *surface, double u) {
  const struct material *material = scene_material(scene, surface);
  const struct bsdf *constant = scene->shape[surface->shape].bsdf;
  struct bsdf bsdf = {.u = u};
  if (constant) bsdf = *constant;
  set_frame(&bsdf, surface);
  if (!constant) material->type->bsdf(scene, material, surface, &bsdf);
  return bsdf;
}

double surface_opacity(const struct scene *scene, const struct surface *surface) {
  const struct shape *shape = &scene->shape[surface->shape];
  if (scene->material[shape->material].type->passed) return 0;
  return shape->alpha ? input_float(shape->alpha, surface) : 1;
}
