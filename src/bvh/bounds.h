// Boxes while a tree is built: three coordinates in a vector of four. The fourth means nothing.
#ifndef BVH_BOUNDS_H
#define BVH_BOUNDS_H

#include "bvh/tree.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

typedef float float4 __attribute__((vector_size(16)));
typedef uint32_t uint32x4 __attribute__((vector_size(16)));

struct bounds {
  float4 lo, hi;
};

// a < b ? a : b and a > b ? a : b: which zero is taken where both are depends on the order.
static inline float4 float4_min(float4 a, float4 b) {
#ifdef __SSE2__
  return _mm_min_ps(a, b);
#else
  for (int k = 0; k < 3; k++) b[k] = a[k] < b[k] ? a[k] : b[k];
  return b;
#endif
}

static inline float4 float4_max(float4 a, float4 b) {
#ifdef __SSE2__
  return _mm_max_ps(a, b);
#else
  for (int k = 0; k < 3; k++) b[k] = a[k] > b[k] ? a[k] : b[k];
  return b;
#endif
}

static inline struct bounds bounds_empty(void) {
  return (struct bounds){{INFINITY, INFINITY, INFINITY, 0}, {-INFINITY, -INFINITY, -INFINITY, 0}};
}

static inline void bounds_add(struct bounds *a, struct bounds b) {
  a->lo = float4_min(b.lo, a->lo);
  a->hi = float4_max(b.hi, a->hi);
}

static inline void bounds_add_point(struct bounds *a, float4 p) {
  bounds_add(a, (struct bounds){p, p});
}

// Half the surface; 0 of a single point.
static inline double bounds_area(struct bounds b) {
  double x = (double)b.hi[0] - (double)b.lo[0], y = (double)b.hi[1] - (double)b.lo[1],
         z = (double)b.hi[2] - (double)b.lo[2];
  return x * y + y * z + z * x;
}

static inline void node_set_box(struct bvh_node *node, int slot, struct bounds box) {
  for (int k = 0; k < 3; k++) {
    node->face[k][0][slot] = box.lo[k];
    node->face[k][1][slot] = box.hi[k];
  }
}

static inline struct bounds node_box(const struct bvh_node *node, int slot) {
  struct bounds box = bounds_empty();
  for (int k = 0; k < 3; k++) {
    box.lo[k] = node->face[k][0][slot];
    box.hi[k] = node->face[k][1][slot];
  }
  return box;
}

static inline struct box bounds_box(struct bounds bounds) {
  struct box box;
  for (int k = 0; k < 3; k++) box.lo[k] = bounds.lo[k], box.hi[k] = bounds.hi[k];
  return box;
}

// A primitive on its way into a leaf. The fourth coordinates hold the bits of its number and of
// whether it is a triangle.
struct bvh_ref {
  float4 lo, hi;
};

static inline float4 bounds_load(const float p[3]) {
  float4 v = {p[0], p[1], p[2], 0};
  return v;
}

static inline struct bounds bounds_of_box(const struct box *box) {
  return (struct bounds){bounds_load(box->lo), bounds_load(box->hi)};
}

static inline struct bvh_ref ref_new(const struct box *box, uint32_t primitive, bool is_triangle) {
  uint32x4 lo = (uint32x4)bounds_load(box->lo), hi = (uint32x4)bounds_load(box->hi);
  lo[3] = primitive, hi[3] = is_triangle;
  return (struct bvh_ref){(float4)lo, (float4)hi};
}

static inline uint32_t ref_primitive(const struct bvh_ref *ref) {
  uint32x4 bits = (uint32x4)ref->lo;
  return bits[3];
}

static inline bool ref_is_triangle(const struct bvh_ref *ref) {
  uint32x4 bits = (uint32x4)ref->hi;
  return bits[3];
}

static inline struct bounds ref_bounds(const struct bvh_ref *ref) {
  return (struct bounds){ref->lo, ref->hi};
}

// Half of each corner, so that the sum is finite. Numbers are kept out of the arithmetic.
static inline float4 ref_center(const struct bvh_ref *ref) {
  const uint32x4 coordinates = {~0u, ~0u, ~0u, 0};
  const float4 half = {0.5f, 0.5f, 0.5f, 0.5f};
  float4 lo = (float4)((uint32x4)ref->lo & coordinates),
         hi = (float4)((uint32x4)ref->hi & coordinates);
  return half * lo + half * hi;
}

#endif
