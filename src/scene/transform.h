// Affine maps, points are columns: p' = M p. pbrt's `Transform` lists columns.
#ifndef SCENE_TRANSFORM_H
#define SCENE_TRANSFORM_H

#include "base/vec.h"

#include <stdbool.h>

struct transform {
  double m[3][4]; // last row is 0 0 0 1
};

struct transform transform_identity(void);
struct transform transform_multiply(struct transform a, struct transform b); // a b: first b, then a
bool transform_invert(struct transform, struct transform *inverse); // false: singular
double transform_determinant(struct transform);

struct transform transform_translate(struct vec);
struct transform transform_scale(struct vec);
// By `degrees` around an axis of any length but 0, as pbrt's Rotate; exact at multiples of 90.
struct transform transform_rotate(double degrees, struct vec axis);
// Camera from world as pbrt's LookAt: +z towards `look`, +y up, +x right, left-handed. False if
// eye and look coincide or up points along the view.
bool transform_look_at(struct vec eye, struct vec look, struct vec up, struct transform *);
// Columns of a 4x4 matrix; false if its last row is not 0 0 0 1.
bool transform_from_columns(const double column[16], struct transform *);
bool transform_is_finite(const struct transform *);

static inline struct vec transform_point(const struct transform *t, struct vec p) {
  return vec(t->m[0][0] * p.x + t->m[0][1] * p.y + t->m[0][2] * p.z + t->m[0][3],
             t->m[1][0] * p.x + t->m[1][1] * p.y + t->m[1][2] * p.z + t->m[1][3],
             t->m[2][0] * p.x + t->m[2][1] * p.y + t->m[2][2] * p.z + t->m[2][3]);
}

static inline struct vec transform_direction(const struct transform *t, struct vec v) {
  return vec(t->m[0][0] * v.x + t->m[0][1] * v.y + t->m[0][2] * v.z,
             t->m[1][0] * v.x + t->m[1][1] * v.y + t->m[1][2] * v.z,
             t->m[2][0] * v.x + t->m[2][1] * v.y + t->m[2][2] * v.z);
}

// Normals: the inverse's transpose, given the inverse.
static inline struct vec transform_normal(const struct transform *inverse, struct vec n) {
  return vec(inverse->m[0][0] * n.x + inverse->m[1][0] * n.y + inverse->m[2][0] * n.z,
             inverse->m[0][1] * n.x + inverse->m[1][1] * n.y + inverse->m[2][1] * n.z,
             inverse->m[0][2] * n.x + inverse->m[1][2] * n.y + inverse->m[2][2] * n.z);
}

#endif
