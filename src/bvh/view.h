// The scene and tree of one iteration. Where nothing moves they are those of all; else a thread has
// its own, and brings them to the time of the iteration.
#ifndef BVH_VIEW_H
#define BVH_VIEW_H

#include "bvh/bvh.h"

struct view {
  const struct scene *scene;
  const struct bvh *bvh;
  struct scene *own; // NULL: nothing moves
  struct bvh *tree;  // NULL: no shape moves
  double share;      // as it is set
};

// moves: as if something did, where nothing does.
struct view view_new(const struct scene *, const struct bvh *, bool moves, struct arena *);

// Moves everything to its place at a share of the time the shutter is open.
void view_set(struct view *, double share);

#endif
