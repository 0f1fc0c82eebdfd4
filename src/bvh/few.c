#include "bvh/few.h"

static void triangle_set(const struct scene *scene, uint32_t primitive,
                         struct few_triangle *triangle) {
  float vertex[3][3];
  triangle_gather(scene, &scene->shape[scene->shape_of[primitive]], primitive, vertex);
  struct vec n = triangle_cross((const float(*)[3])vertex);
  struct box box = triangle_box((const float(*)[3])vertex);
  triangle->n[0] = n.x, triangle->n[1] = n.y, triangle->n[2] = n.z;
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 3; i++) triangle->vertex[i][k] = (double)vertex[i][k];
    triangle->lo[k] = (double)box.lo[k], triangle->hi[k] = (double)box.hi[k];
  }
}

// By a ray straight to the side of the normal, or against it: of float vertices n.n is between
// 1e-180 and 1e155, a double, so that it has the sign of any ray to that side.
static bool is_left_behind(const struct scene *scene, const struct few *few, uint32_t left,
                           uint32_t other, enum few_side side) {
  const double *n = few->triangle[left].n;
  struct ray ray = {.d = vec(n[0], n[1], n[2]), .leaving = left};
  float vertex[3][3];
  if (side == FEW_BACKWARD) ray.d = vec_scale(ray.d, -1);
  triangle_gather(scene, &scene->shape[scene->shape_of[other]], other, vertex);
  return triangle_is_left_behind(scene, &ray, (const float(*)[3])vertex);
}

static void unmet_set(const struct scene *scene, struct few *few, uint32_t left) {
  for (int side = 0; side < FEW_SIDES; side++) {
    uint64_t unmet = UINT64_C(1) << left;
    for (uint32_t other = 0; side != FEW_ALONG && other < (uint32_t)few->n; other++)
      if (is_left_behind(scene, few, left, other, (enum few_side)side))
        unmet |= UINT64_C(1) << other;
    few->unmet[left][side] = unmet;
  }
}

struct few *few_new(const struct scene *scene, struct arena *arena) {
  if (!scene_is_few_triangles(scene)) return NULL;
  struct few *few = arena_new(arena, struct few, 1);
  few->n = (int)scene->n_primitives;
  for (uint32_t k = 0; k < scene->n_primitives; k++) triangle_set(scene, k, &few->triangle[k]);
  for (uint32_t k = 0; k < scene->n_primitives; k++) unmet_set(scene, few, k);
  return few;
}
