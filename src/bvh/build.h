// A binary tree on its way to a wide one: build.c divides, collapse.c chooses which of its nodes
// stay.
#ifndef BVH_BUILD_H
#define BVH_BUILD_H

#include "bvh/split.h"
#include "bvh/tree.h"

// Primitives first ... of the order. Refs lie in the first or second of two arrays.
struct range {
  uint32_t first, count, depth;
  int array;
  struct extent extent;
};

// A range, and what it costs as 1 ... BVH_WIDTH children of a node: see collapse.c.
struct binary {
  struct bounds box;
  struct binary *half[2]; // NULL: not divided
  uint32_t first, count;  // in the order of primitives
  enum bvh_kind kind;     // of a leaf it may be, or BVH_NODE
  double cost[BVH_WIDTH + 1];
  unsigned char left[BVH_WIDTH + 1]; // how many children the first half gets; 0: as with one less
  bool is_leaf;                      // as one child
};

// Fills cost, left and is_leaf from the halves. `leaf_size`: most primitives in a leaf.
void binary_choose(struct binary *, uint32_t leaf_size);

// The wide tree. order: the primitives.
void binary_collapse(const struct binary *root, const uint32_t *order, struct bvh *,
                     struct arena *arena, int threads, struct arena scratch);

#endif
