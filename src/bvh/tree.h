// The tree as collapse.c makes it and the search walks it: nodes of eight children, blocks of four
// triangles.
#ifndef BVH_TREE_H
#define BVH_TREE_H

#include "bvh/bvh.h"

enum { BVH_WIDTH = 8, BVH_BLOCK = 4, BVH_OCTANTS = 8 };

// The binary tree that the wide one is made of has at most this many levels: below BVH_SAH_DEPTH a
// range is halved, and a leaf of several kinds of primitives is divided once more.
enum { BVH_SAH_DEPTH = 64, BVH_MAX_DEPTH = BVH_SAH_DEPTH + 33 };

// What may wait at once while one ray is followed: all but one child of a node of each level, and
// room to write eight where some are none.
enum { BVH_MOST_WAITING = (BVH_WIDTH - 1) * BVH_MAX_DEPTH + 1 + BVH_WIDTH };

enum { BVH_LINE = 64 }; // bytes of a cache line, to which the arrays are aligned

// A child in one word: its kind, and its row among those. Of a leaf the first row.
enum bvh_kind { BVH_NODE, BVH_TRIANGLES, BVH_OTHERS, BVH_NOTHING };
enum { BVH_ROW_BITS = 30 };
#define BVH_MAX_ROWS (UINT32_C(1) << BVH_ROW_BITS)

static inline uint32_t bvh_child(enum bvh_kind kind, uint32_t row) {
  return (uint32_t)kind << BVH_ROW_BITS | row;
}
static inline enum bvh_kind bvh_kind_of(uint32_t child) {
  return (enum bvh_kind)(child >> BVH_ROW_BITS);
}
static inline uint32_t bvh_row_of(uint32_t child) { return child & (BVH_MAX_ROWS - 1); }

// Four cache lines. Where there is no child the box is empty, lo = INFINITY > hi = -INFINITY, which
// no ray meets.
struct bvh_node {
  _Alignas(BVH_LINE) float face[3][2][BVH_WIDTH]; // [axis][lo, hi][child]
  uint32_t child[BVH_WIDTH];
  uint32_t order[BVH_OCTANTS]; // [octant of the direction]: children from far to near, 3 bits each
};

// Triangles of a leaf, side by side, in three cache lines. Lanes without one hold NaN vertices:
// nothing accepts them.
struct bvh_block {
  _Alignas(BVH_LINE) float vertex[3][3][BVH_BLOCK]; // [corner][axis]
  uint32_t primitive[BVH_BLOCK];
  uint32_t more; // whether the leaf goes on in the next block
};

// A sphere, disk, or a shape the tree knows only by its row.
struct bvh_other {
  struct box box;
  uint32_t primitive, more;
};

struct few; // bvh/few.h

struct bvh {
  const struct scene *scene;
  const struct few *few; // NULL: the tree is walked
  struct bvh_node *node;
  struct bvh_block *block;
  struct bvh_other *other;
  uint32_t *lane; // [n_primitives] BVH_BLOCK * block + lane of a triangle, else ROW_NONE
  uint32_t root;  // a child
  struct box box; // of everything
  uint32_t n_nodes, n_blocks, n_others;
  unsigned char *moving; // [n_nodes] bit of each child that a refit visits; NULL: all do
  struct bvh_statistics statistics;
};

// Room for the tree's arrays.
void bvh_allocate(struct bvh *, uint32_t n_nodes, uint32_t n_blocks, uint32_t n_others,
                  struct arena *);

// Fills the rows of a leaf with `count` primitives.
void bvh_leaf_set(struct bvh *, uint32_t leaf, const uint32_t *primitive, uint32_t count);

// What a row holds, brought up to date with the scene.
void bvh_block_update(const struct scene *, struct bvh_block *);
void bvh_other_update(const struct scene *, struct bvh_other *);

static inline uint32_t bvh_blocks_of(uint32_t count) {
  return count / BVH_BLOCK + (count % BVH_BLOCK != 0);
}

#endif
