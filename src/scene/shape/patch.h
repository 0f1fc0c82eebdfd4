// Ray and bilinear patch P(u, v) = (1-u)(1-v) p00 + u (1-v) p10 + (1-u) v p01 + u v p11 (Reshetov
// 2019, "Cool Patches: A Geometric Approach to Ray/Bilinear Patch Intersections"). The ray meets
// the line of constant u where it is coplanar with it: a + b u + c u^2 = 0. In that line v and t
// follow from the closest points of two lines. In double: o and the corners are exact, u and v are
// right to about 2^-50 |p - o| / size. A hit up to PATCH_RIM outside [0, 1] counts, so that no ray
// passes between two patches or a patch and a triangle that share an edge and are seen from up to
// 2^14 times their size.
#ifndef SCENE_SHAPE_PATCH_H
#define SCENE_SHAPE_PATCH_H

#include "scene/shape/clip.h"

#define PATCH_RIM 0x1p-36

struct patch {
  struct vec p00, e10, e00; // a corner and its edges, to p10 and p01
  struct vec twist;         // p00 - p10 - p01 + p11; 0: a parallelogram
};

static inline void patch_gather(const struct scene *scene, const struct shape *shape,
                                uint32_t primitive, float vertex[4][3]) {
  const uint32_t *row = scene->patch[shape->local + (primitive - shape->first)];
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) vertex[i][k] = scene->position[row[i]][k];
}

static inline struct patch patch_of(const float vertex[4][3]) {
  struct vec p[4];
  for (int i = 0; i < 4; i++)
    p[i] = vec((double)vertex[i][0], (double)vertex[i][1], (double)vertex[i][2]);
  struct patch patch = {.p00 = p[0], .e10 = vec_sub(p[1], p[0]), .e00 = vec_sub(p[2], p[0])};
  patch.twist = vec_sub(vec_sub(p[3], p[1]), patch.e00);
  return patch;
}

static inline struct box patch_box(const float vertex[4][3]) {
  struct box box;
  for (int k = 0; k < 3; k++) {
    box.lo[k] = box.hi[k] = vertex[0][k];
    for (int i = 1; i < 4; i++) {
      if (vertex[i][k] < box.lo[k]) box.lo[k] = vertex[i][k];
      if (vertex[i][k] > box.hi[k]) box.hi[k] = vertex[i][k];
    }
  }
  return box;
}

// Both roots of a + b u + c u^2 without cancellation; not finite where there is none.
static inline bool patch_roots(double a, double b, double c, double root[2]) {
  double discriminant = b * b - 4 * a * c;
  if (!(discriminant >= 0)) return false;
  double q = b < 0 ? (sqrt(discriminant) - b) / 2 : -(b + sqrt(discriminant)) / 2;
  root[0] = q / c, root[1] = a / q;
  return true;
}

// t in the line of this u; false: outside the patch.
static inline bool patch_line(const struct patch *patch, struct vec to_p00, struct vec d, double u,
                              double *t) {
  if (!(u >= -PATCH_RIM && u <= 1 + PATCH_RIM)) return false;
  struct vec from = vec_along(to_p00, patch->e10, u);
  struct vec along = vec_along(patch->e00, patch->twist, u);
  struct vec n = vec_cross(d, along), m = vec_cross(n, from);
  double n2 = vec_dot(n, n), v = vec_dot(m, d) / n2;
  *t = vec_dot(m, along) / n2;
  return v >= -PATCH_RIM && v <= 1 + PATCH_RIM;
}

// A ray that leaves drops the hit that is its origin: of those in the patch, the one nearest to t =
// 0. (Where a ray grazes the patch so closely that both are as near as rounding, either will do.)
static inline bool patch_hit(const float vertex[4][3], const struct box *box,
                             const struct cone *cone, const struct ray *ray, bool leaving,
                             double *t) {
  struct patch patch = patch_of(vertex);
  struct vec to_p00 = vec_sub(patch.p00, ray->o), e11 = vec_add(patch.e00, patch.twist);
  struct vec to_p10 = vec_add(to_p00, patch.e10);
  double a = vec_dot(vec_cross(to_p00, ray->d), patch.e00);
  double c = vec_dot(vec_cross(patch.twist, patch.e10), ray->d);
  double b = vec_dot(vec_cross(to_p10, ray->d), e11) - a - c;
  double u[2], s[2];
  if (!patch_roots(a, b, c, u)) return false;
  bool inside[2];
  for (int i = 0; i < 2; i++) inside[i] = patch_line(&patch, to_p00, ray->d, u[i], &s[i]);
  if (leaving) inside[inside[0] && inside[1] ? cone_abs(s[1]) < cone_abs(s[0]) : inside[1]] = false;
  for (int i = 0; i < 2; i++) inside[i] = inside[i] && clip_accept(cone, box, ray->t_max, &s[i]);
  if (!inside[0] && !inside[1]) return false;
  *t = inside[0] && !(inside[1] && s[1] < s[0]) ? s[0] : s[1];
  return true;
}

// shape_type.intersect of every shape made of patches (scene/intersect.c).
bool patch_intersect(const struct scene *, const struct shape *, uint32_t primitive,
                     const struct ray *, double *t);

#endif
