// A tree of boxes around photon beams, for many eye segments. Long beams are boxed in parts, since
// a box of a long diagonal beam is mostly empty. Halves by number along the axis in which the
// middles extend most: the tree depends on nothing but the beams.
#ifndef DENSITY_BEAM_TREE_H
#define DENSITY_BEAM_TREE_H

#include "density/crossing.h"

// Part `part` of a beam, from length part / parts to length (part + 1) / parts.
struct beam_part {
  float lo[3], hi[3];
  uint32_t beam, part;
};

// Nodes in preorder: the left half follows its parent.
struct beam_node {
  float lo[3], hi[3];
  uint32_t right; // 0: a leaf
};

struct beam_tree {
  int64_t n_parts, parts_capacity;
  struct beam_part *part;
  int64_t n_nodes, nodes_capacity;
  struct beam_node *node;
  double part_length; // at most
};

// Grows in the arena.
void beam_tree_build(struct beam_tree *, const struct beams *, struct arena *);

// The beams that cross the segment less than r away, each once, in ascending order; returns how
// many. found: room for all beams.
int64_t beam_tree_find(const struct beam_tree *, const struct beams *, const struct eye_segment *,
                       double r, uint32_t *found);

// The same by looking at all of them.
int64_t beam_find_all(const struct beams *, const struct eye_segment *, double r, uint32_t *found);

static inline int64_t beam_tree_bytes(const struct beam_tree *tree) {
  return tree->n_parts * (int64_t)sizeof(struct beam_part) +
         tree->n_nodes * (int64_t)sizeof(struct beam_node);
}

#endif
