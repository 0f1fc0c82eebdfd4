// The tree as build.c makes it and bvh.c walks it.
#ifndef BVH_TREE_H
#define BVH_TREE_H

#include "bvh/bvh.h"
#include "bvh/lanes.h"

// Every level of the tree leaves at most one child waiting. Below BVH_SAH_DEPTH a range is halved,
// and a leaf of several kinds of primitives is divided once more, so the depth is at most
// BVH_SAH_DEPTH + log2(2^32) + 1.
enum { BVH_SAH_DEPTH = 64, BVH_MAX_DEPTH = BVH_SAH_DEPTH + 33 };

enum { BVH_LINE = 64 }; // bytes of a cache line, to which the arrays are aligned

#define BVH_MAX_COUNT 0x3fffffffu

enum bvh_kind { BVH_NODE, BVH_TRIANGLES, BVH_OTHERS };

struct bvh_child {
  uint32_t first;      // row of node, block or other
  uint32_t count : 30; // of blocks or others
  uint32_t kind : 2;   // enum bvh_kind
};

// The boxes of both children, side by side. One cache line.
struct bvh_node {
  lanes_float face[2][3]; // [lo, hi][axis]
  struct bvh_child child[2];
};

// Triangles of a leaf, side by side. Lanes without one hold NaN vertices: nothing accepts them.
struct bvh_block {
  lanes_float vertex[3][3]; // [corner][axis]
  uint32_t primitive[LANES];
};

// A sphere, disk, or a shape the tree knows only by its row.
struct bvh_other {
  struct box box;
  uint32_t primitive;
};

struct bvh {
  const struct scene *scene;
  struct bvh_node *node;
  struct bvh_block *block;
  struct bvh_other *other;
  struct bvh_child root;
  uint32_t n_nodes, n_blocks, n_others;
  unsigned char *moving; // [n_nodes] bit of each child that a refit visits; NULL: all do
  struct bvh_statistics statistics;
};

// Room for the tree's arrays.
void bvh_allocate(struct bvh *, uint32_t n_nodes, uint32_t n_blocks, uint32_t n_others,
                  struct arena *);

// Fills a block with the first LANES of `count` triangles.
void bvh_block_set(const struct scene *, struct bvh_block *, const uint32_t *primitive,
                   uint32_t count);
void bvh_other_set(const struct scene *, struct bvh_other *, uint32_t primitive);

#endif
