// Ray and triangle, watertight (after Woop, Benthin, Wald 2013, in double).
// The vertices, relative to the origin, are sheared along the ray onto a plane across it: each
// becomes two doubles (x, y) that depend on the vertex and the ray alone, and the ray becomes (0,
// 0). The triangle accepts if the edge functions ax*by - ay*bx of its three edges have one sign or
// are zero. Rounding is monotone, so if ax*by > ay*bx exactly, the rounded difference is never
// negative (as long as nothing is fused): a computed sign is right or zero, and zero accepts. Hence
// a triangle whose projected vertices enclose (0, 0) is never missed, and as neighbours share these
// vertices, no ray slips between them, at an edge or at a vertex. Two-sided.
#ifndef SCENE_SHAPE_TRIANGLE_H
#define SCENE_SHAPE_TRIANGLE_H

#include "scene/shape/clip.h"

struct shear {
  double o[3];
  int x, y, z;             // z: the axis of the largest |d|
  double along_x, along_y; // d[x] / d[z], d[y] / d[z]
};

static inline void shear_set(struct shear *s, const struct ray *ray) {
  const double d[3] = {ray->d.x, ray->d.y, ray->d.z};
  s->z = cone_abs(d[0]) > cone_abs(d[1]) ? 0 : 1;
  if (cone_abs(d[2]) > cone_abs(d[s->z])) s->z = 2;
  s->x = s->z == 2 ? 0 : s->z + 1;
  s->y = s->x == 2 ? 0 : s->x + 1;
  s->o[0] = ray->o.x, s->o[1] = ray->o.y, s->o[2] = ray->o.z;
  s->along_x = d[s->x] / d[s->z];
  s->along_y = d[s->y] / d[s->z];
}

// Whether the ray's line passes through the triangle of these vertices.
static inline bool triangle_accepts(const struct shear *s, const float vertex[3][3]) {
  double x[3], y[3];
  for (int i = 0; i < 3; i++) {
    double z = (double)vertex[i][s->z] - s->o[s->z];
    x[i] = ((double)vertex[i][s->x] - s->o[s->x]) - s->along_x * z;
    y[i] = ((double)vertex[i][s->y] - s->o[s->y]) - s->along_y * z;
  }
  double e0 = x[1] * y[2] - y[1] * x[2];
  double e1 = x[2] * y[0] - y[2] * x[0];
  double e2 = x[0] * y[1] - y[0] * x[1];
  return (e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0);
}

static inline struct vec triangle_vertex(const float vertex[3]) {
  return vec((double)vertex[0], (double)vertex[1], (double)vertex[2]);
}

// (p0 - p2) x (p1 - p2): pbrt's normal, of length twice the area.
static inline struct vec triangle_cross(const float vertex[3][3]) {
  struct vec p2 = triangle_vertex(vertex[2]);
  return vec_cross(vec_sub(triangle_vertex(vertex[0]), p2),
                   vec_sub(triangle_vertex(vertex[1]), p2));
}

static inline struct box triangle_box(const float vertex[3][3]) {
  struct box box;
  for (int k = 0; k < 3; k++) {
    float a = vertex[0][k], b = vertex[1][k], c = vertex[2][k];
    float lo = a < b ? a : b, hi = a < b ? b : a;
    box.lo[k] = c < lo ? c : lo;
    box.hi[k] = c > hi ? c : hi;
  }
  return box;
}

// t of the ray in the triangle's plane. Without area or seen edge-on n . d == 0, and t is not
// finite.
static inline double triangle_plane(const struct ray *ray, const float vertex[3][3]) {
  struct vec n = triangle_cross(vertex);
  return vec_dot(n, vec_sub(triangle_vertex(vertex[0]), ray->o)) / vec_dot(n, ray->d);
}

// The vertices of a primitive.
static inline void triangle_gather(const struct scene *scene, const struct shape *shape,
                                   uint32_t primitive, float vertex[3][3]) {
  const uint32_t *row = scene->triangle[shape->local + (primitive - shape->first)];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) vertex[i][k] = scene->position[row[i]][k];
}

// Whether the ray leaves a triangle or plane patch that has `vertex` wholly in its plane or behind
// it: each vertex is one of its own or not on the side the ray goes to. Exactly, such a ray never
// meets it at t > 0; rounded, a neighbour in the same plane would shadow a point on the edge they
// share.
bool triangle_is_left_behind(const struct scene *, const struct ray *, const float vertex[3][3]);

// What every shape made of triangles does (scene/intersect.c, scene/triangle_mesh.c); the tree
// knows triangles by triangle_intersect.
bool triangle_intersect(const struct scene *, const struct shape *, uint32_t primitive,
                        const struct ray *, double *t);
struct box triangle_bounds(const struct scene *, const struct shape *, uint32_t primitive);
void triangle_detail(const struct scene *, const struct shape *, struct surface *);
struct vec triangle_normal(const struct scene *, const struct shape *, uint32_t primitive,
                           struct vec p);
double triangle_area(const struct scene *, const struct shape *, uint32_t primitive);
void triangle_sample(const struct scene *, const struct shape *, uint32_t primitive, double u0,
                     double u1, struct vec *p, struct vec *ng);

#endif
