#include "analysis/mirror.h"

#include "analysis/receiver.h"
#include "scene/bsdf.h"

#include <math.h>

struct vec mirror_direction(const struct plane *mirror, struct vec w) {
  return vec_along(w, mirror->n, -2 * vec_dot(mirror->n, w));
}

struct vec mirror_point(const struct plane *mirror, struct vec p) {
  return vec_add(mirror->p, mirror_direction(mirror, vec_sub(p, mirror->p)));
}

// All of the light and none of it elsewhere, at this cosine.
static bool reflects_all(const struct bsdf *bsdf, double cosine) {
  struct vec wo = vec(sqrt(1 - cosine * cosine), 0, cosine);
  struct bsdf_sample sample;
  if (bsdf_delta_probability(bsdf, wo, TRANSPORT_IMPORTANCE) != 1) return false;
  if (!bsdf_sample(bsdf, wo, (double[3]){0.3, 0.6, 0.9}, TRANSPORT_IMPORTANCE, &sample))
    return false;
  for (int c = 0; c < 3; c++)
    if (sample.weight[c] != 1) return false;
  return sample.wi.x == -wo.x && sample.wi.y == 0 && sample.wi.z == wo.z;
}

static bool is_mirror(const struct scene *scene, const struct shape *shape) {
  const struct material *material = &scene->material[shape->material];
  if (material->type->passed || shape->alpha) return false;
  if (material->needs & (MATERIAL_DETAIL | MATERIAL_RANDOM)) return false;
  struct bsdf bsdf = {.s = {1, 0, 0}, .t = {0, 1, 0}, .n = {0, 0, 1}, .ng = {0, 0, 1}};
  material->type->bsdf(scene, material, &(struct surface){0}, &bsdf);
  return bsdf.type && reflects_all(&bsdf, 0.3) && reflects_all(&bsdf, 1);
}

static struct plane plane_of(const struct scene *scene, const struct shape *shape) {
  struct vec v[3];
  flat_triangle(scene, shape, 0, v);
  struct vec n = vec_normalize(vec_cross(vec_sub(v[1], v[0]), vec_sub(v[2], v[0])));
  return flat_plane(scene, v[0], n);
}

static bool find_plane(const struct scene *scene, const struct plane *receiver,
                       struct plane *mirror) {
  bool found = false;
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (flat_contains_shape(receiver, scene, shape)) continue;
    if (!flat_is_triangles(shape) || shape->count == 0 || !is_mirror(scene, shape)) return false;
    if (!found) *mirror = plane_of(scene, shape);
    if (!flat_contains_shape(mirror, scene, shape)) return false;
    found = true;
  }
  return found;
}

static bool is_on(const struct scene *scene, const struct plane *mirror, struct vec point) {
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (!flat_contains_shape(mirror, scene, shape)) continue;
    for (uint32_t t = 0; t < shape->count; t++) {
      struct vec vertex[3];
      flat_triangle(scene, shape, t, vertex);
      if (flat_inside(point, vertex)) return true;
    }
  }
  return false;
}

static double height(const struct plane *plane, struct vec p) {
  return vec_dot(plane->n, vec_sub(p, plane->p));
}

// From the light to the image of p the ray crosses the mirror. Rays to the rest of the disc cross
// it within `radius` of there: they are parallel, or meet at the light.
static bool lights_disc(const struct scene *scene, const struct plane *receiver,
                        const struct plane *mirror, double radius, struct arena scratch) {
  const struct light *light = &scene->light[0];
  struct vec image = mirror_point(mirror, receiver->p);
  struct light_sample sample;
  if (!light->type->delta || !light->type->sample(scene, light, image, NULL, &sample)) return false;
  if (!isfinite(sample.distance)) return false;
  struct vec from = vec_along(image, sample.wi, sample.distance);
  double above = height(mirror, image), below = height(mirror, from);
  if (!(above * below < 0)) return false;
  struct vec crossing =
      vec_along(image, sample.wi, sample.distance * fabs(above) / (fabs(above) + fabs(below)));
  return height(receiver, from) > 0 && height(receiver, crossing) > 0 &&
         is_on(scene, mirror, crossing) &&
         receiver_clearance(scene, crossing, mirror->n, scratch) > radius;
}

static bool is_dark_without(const struct scene *scene, const struct plane *receiver,
                            double radius) {
  struct light_closed_form form;
  const struct light *light = &scene->light[0];
  if (!light->type->closed_form(scene, light, receiver->p, receiver->n, &form)) return false;
  for (int c = 0; c < 3; c++)
    if (form.irradiance[c] != 0) return false;
  return form.clear_radius > radius;
}

bool mirror_find(const struct scene *scene, const struct cell *cell, struct vec p, struct vec n,
                 double radius, struct arena scratch, struct plane *mirror) {
  struct plane receiver = flat_plane(scene, p, n);
  return cell->depth == 3 && find_plane(scene, &receiver, mirror) &&
         is_dark_without(scene, &receiver, radius) &&
         lights_disc(scene, &receiver, mirror, radius, scratch);
}
