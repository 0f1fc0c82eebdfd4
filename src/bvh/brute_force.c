// What a hit is, without a tree.
#include "bvh/bvh.h"

static struct hit closest(const struct scene *scene, const struct ray *ray) {
  struct hit best = {INFINITY, PRIMITIVE_NONE};
  for (uint32_t p = 0; p < scene->n_primitives; p++) {
    const struct shape *shape = &scene->shape[scene->shape_of[p]];
    double t;
    if (shape->type->intersect(scene, shape, p, ray, &t) && t < best.t) best = (struct hit){t, p};
  }
  return best;
}

void bvh_closest_brute_force(const struct scene *scene, const struct ray *rays, struct hit *hits,
                             int n) {
  for (int j = 0; j < n; j++) hits[j] = closest(scene, &rays[j]);
}
