// The tree as build.c makes it and bvh.c walks it.
#ifndef BVH_TREE_H
#define BVH_TREE_H

#include "bvh/bvh.h"

// Every level of the tree leaves at most one child waiting. Below BVH_SAH_DEPTH a range is halved,
// so the depth is at most BVH_SAH_DEPTH + log2(2^32).
enum { BVH_SAH_DEPTH = 64, BVH_MAX_DEPTH = BVH_SAH_DEPTH + 32 };

enum bvh_kind { BVH_NODE, BVH_TRIANGLES, BVH_MIXED }; // mixed: not only triangles

struct bvh_child {
  uint32_t first; // node, or first item of a leaf
  uint32_t count; // items of a leaf
  enum bvh_kind kind;
};

// The boxes of both children, side by side.
struct bvh_node {
  float face[2][3][2]; // [lo, hi][axis][child]
  struct bvh_child child[2];
};

// A primitive of a leaf. Only triangles have vertices.
struct bvh_item {
  float vertex[3][3];
  uint32_t primitive;
};

struct bvh {
  const struct scene *scene;
  struct bvh_node *node;
  struct bvh_item *item;
  struct bvh_child root;
  struct bvh_statistics statistics;
};

#endif
