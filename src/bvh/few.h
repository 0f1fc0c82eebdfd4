// A few triangles, tested without a tree: every triangle against as many rays at a time as a vector
// has lanes. There is nothing to branch on, fetch or queue, which at this size costs more than the
// tests a tree spares.
#ifndef BVH_FEW_H
#define BVH_FEW_H

#include "bvh/search.h"
#include "scene/skip.h"

enum few_side { FEW_ALONG, FEW_FORWARD, FEW_BACKWARD, FEW_SIDES };

struct few_triangle {
  double vertex[3][3]; // [corner][axis]
  double n[3];         // triangle_cross
  double lo[3], hi[3]; // triangle_box
};

struct few {
  int n; // primitives 0 .. n - 1 are the triangles
  struct few_triangle triangle[SKIP_FEW_TRIANGLES];
  // Bits of the triangles that a ray does not meet which leaves this one along its plane, or to the
  // side of its n, or to the other: itself and those it leaves behind (triangle_is_left_behind).
  uint64_t unmet[SKIP_FEW_TRIANGLES][FEW_SIDES];
};

// NULL: the scene has others, or more.
struct few *few_new(const struct scene *, struct arena *);

struct few_level {
  void (*run[3])(const struct bvh *, const struct queries *); // [enum search_kind]
};
SIMD_TABLES(few_level);

#endif
