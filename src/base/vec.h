// Points, directions and RGB triples in double. Only + - * / and sqrt, so the same bits everywhere.
#ifndef BASE_VEC_H
#define BASE_VEC_H

#include "base/exact.h"

struct vec {
  double x, y, z;
};

static inline struct vec vec(double x, double y, double z) { return (struct vec){x, y, z}; }

static inline struct vec vec_add(struct vec a, struct vec b) {
  return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct vec vec_sub(struct vec a, struct vec b) {
  return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct vec vec_scale(struct vec a, double s) { return vec(a.x * s, a.y * s, a.z * s); }

// a + s b
static inline struct vec vec_along(struct vec a, struct vec b, double s) {
  return vec(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline double vec_dot(struct vec a, struct vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Exactly antisymmetric: cross(a, b) == -cross(b, a) bit for bit, as long as nothing is fused.
static inline struct vec vec_cross(struct vec a, struct vec b) {
  return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double vec_length(struct vec a) { return sqrt(vec_dot(a, a)); }

static inline struct vec vec_normalize(struct vec a) { return vec_scale(a, 1 / vec_length(a)); }

// Two unit vectors that make (s, t, n) an orthonormal basis; n of unit length
// (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
static inline void vec_basis(struct vec n, struct vec *s, struct vec *t) {
  double sign = n.z < 0 ? -1.0 : 1.0;
  double a = -1 / (sign + n.z), b = n.x * n.y * a;
  *s = vec(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
  *t = vec(b, sign + n.y * n.y * a, -n.y);
}

#endif
