// A tree on its way: divided into parts that threads build on their own (build.c), then moved to
// where it stays (place.c). What the parts are depends on the scene alone.
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

// Either divided in two halves, or whole: a subtree in nodes of its own. Until it is placed, its
// children's rows are counted from its own first ones, and `count` of a leaf is primitives.
struct part {
  struct part *half[2]; // NULL: whole
  struct bounds box;
  struct bvh_node *node;
  struct bvh_child root;
  uint32_t first; // in the order of primitives
  uint32_t n_nodes, n_blocks, n_others;
  uint32_t at_node, at_block, at_other; // where it is placed
  struct bvh_statistics statistics;
};

// Gives the parts their places in the order of the tree and fills its arrays. bvh->statistics is
// the sum over all parts.
void part_place_all(struct bvh *, struct part *root, const uint32_t *order, struct arena *,
                    int threads, struct arena scratch);

#endif
