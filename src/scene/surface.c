#include "scene/scene.h"

void scene_surface(const struct scene *scene, const struct ray *ray, struct hit hit,
                   struct surface *out) {
  uint32_t row = scene->shape_of[hit.primitive];
  const struct shape *shape = &scene->shape[row];
  struct vec p = vec_along(ray->o, ray->d, hit.t);
  struct vec ng = shape->faceted ? scene->facet[hit.primitive]
                                 : shape->type->normal(scene, shape, hit.primitive, p);
  out->p = p;
  out->primitive = hit.primitive;
  out->shape = row;
  out->ng = out->ns = ng;
  out->dpdu = vec(0, 0, 0);
  out->uv[0] = out->uv[1] = 0;
  if (shape->detailed) shape->type->detail(scene, shape, out);
}

// x along dpdu made orthogonal to the shading normal.
static void set_frame(const struct surface *surface, struct bsdf *bsdf) {
  struct vec n = surface->ns, ng = surface->ng;
  struct vec across = vec_along(surface->dpdu, n, -vec_dot(surface->dpdu, n)), s, t;
  if (vec_dot(across, across) > 0) {
    s = vec_normalize(across);
    t = vec_cross(n, s);
  } else {
    vec_basis(n, &s, &t);
  }
  bsdf->s = s;
  bsdf->t = t;
  bsdf->n = n;
  bsdf->ng = ng;
  bsdf->bent = n.x != ng.x || n.y != ng.y || n.z != ng.z;
}

void surface_bsdf(const struct scene *scene, const struct surface *surface, double u,
                  struct bsdf *out) {
  const struct material *material = scene_material(scene, surface);
  const struct bsdf *constant = scene->shape[surface->shape].bsdf;
  set_frame(surface, out);
  out->volume = false;
  out->u = u;
  if (constant) {
    out->type = constant->type;
    out->data = constant->data;
    for (int i = 0; i < BSDF_NUMBERS; i++) out->x[i] = constant->x[i];
  } else {
    out->type = NULL;
    material->type->bsdf(scene, material, surface, out);
  }
}

double surface_opacity(const struct scene *scene, const struct surface *surface) {
  const struct shape *shape = &scene->shape[surface->shape];
  if (scene->material[shape->material].type->passed) return 0;
  return shape->alpha ? input_float(shape->alpha, surface) : 1;
}
