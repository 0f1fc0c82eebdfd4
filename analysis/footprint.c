#include "analysis/footprint.h"

#include "analysis/flat.h"

#include <math.h>
#include <string.h>

// Where the ray through (x, y) of the film meets the receiver; height of its origin. False: never.
static bool meet(const struct scene *scene, const struct plane *receiver, double x, double y,
                 struct vec *p, double *height) {
  struct ray ray = camera_ray(&scene->camera, x, y, NULL);
  *height = vec_dot(receiver->n, vec_sub(ray.o, receiver->p));
  double t = -*height / vec_dot(receiver->n, ray.d);
  *p = vec_along(ray.o, ray.d, t);
  return t > 0 && t < INFINITY;
}

// Nothing is between the receiver and a camera at this height that is nearer than all else.
static bool sees_receiver(const struct scene *scene, const struct plane *receiver, double height) {
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (flat_contains_shape(receiver, scene, shape)) continue;
    if (!flat_is_triangles(shape)) return false;
    for (uint32_t t = 0; t < shape->count; t++) {
      struct vec v[3];
      flat_triangle(scene, shape, t, v);
      for (int k = 0; k < 3; k++)
        if (!(vec_dot(receiver->n, vec_sub(v[k], receiver->p)) > height)) return false;
    }
  }
  return true;
}

// A camera that looks along the normal maps pixels to parallelograms, but for rounding.
static const double round_off = 1e-12;

bool footprint_find(const struct scene *scene, const struct probe *probe,
                    struct footprint *footprint) {
  struct plane receiver = flat_plane(scene, probe->p, probe->n);
  const struct filter *filter = &scene->filter;
  if (strcmp(filter->type->name, "box") || scene->camera.lens_radius > 0) return false;
  if (scene->n_motions > 0) return false;
  struct vec corner[4];
  double height = 0;
  for (int k = 0; k < 4; k++) {
    double x = probe->x + 0.5 + (k % 2 ? 1 : -1) * filter->radius[0];
    double y = probe->y + 0.5 + (k / 2 ? 1 : -1) * filter->radius[1];
    if (!meet(scene, &receiver, x, y, &corner[k], &height)) return false;
  }
  if (!sees_receiver(scene, &receiver, height)) return false;
  footprint->side[0] = vec_scale(vec_sub(corner[1], corner[0]), 0.5);
  footprint->side[1] = vec_scale(vec_sub(corner[2], corner[0]), 0.5);
  double size = vec_length(footprint->side[0]) + vec_length(footprint->side[1]);
  struct vec diagonal = vec_add(footprint->side[0], footprint->side[1]);
  return vec_length(vec_sub(vec_add(probe->p, diagonal), corner[3])) <= round_off * size &&
         vec_length(vec_sub(vec_sub(probe->p, diagonal), corner[0])) <= round_off * size;
}
