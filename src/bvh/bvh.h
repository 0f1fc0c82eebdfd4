// The bounding volume hierarchy. What a ray hits is defined without it: the smallest
// (t, primitive number) over all primitives whose test accepts (scene/shape/); the tree only culls.
#ifndef BVH_BVH_H
#define BVH_BVH_H

#include "base/arena.h"
#include "scene/scene.h"

struct bvh; // bvh/tree.h

struct bvh_options {
  int leaf_size; // most primitives in a leaf; 0: the default, and no tree for a few primitives
  bool tree;     // over a few primitives, too
  int threads;   // 0: as many as there are; the tree is the same bits for any number
  int part_size; // a thread builds as many primitives alone; 0: the default (tests need less)
};

struct bvh *bvh_build(const struct scene *, struct bvh_options, struct arena *);

// A copy of the tree for `scene`, which has the same primitives in other places: those of shapes
// with moves[shape] (NULL: of all). To be refitted before it is used.
struct bvh *bvh_clone(const struct bvh *, const struct scene *, const bool *moves, struct arena *);

// Brings the boxes and vertices of a clone up to date with its scene.
void bvh_refit(struct bvh *);

// hits[j]: the closest hit of rays[j].
void bvh_closest(const struct bvh *, const struct ray *rays, struct hit *hits, int n);

// blocked[j]: whether anything is hit within (0, t_max).
void bvh_any(const struct bvh *, const struct ray *rays, unsigned char *blocked, int n);

// Shadow rays: is anything in the way of a point at `distance` on the primitive `emitter` (or
// PRIMITIVE_NONE)? hits[j] is
// - nothing, where the closest hit is not nearer than the distance;
// - the closest hit, where that is the emitter, nearer than the distance;
// - else any hit nearer than the distance and, if the emitter is hit, before the emitter.
// So whoever asks only whether the closest hit is nearer than the distance, and if it is the
// emitter where, may ask this. The distance is not the rays' t_max, which counts as well.
void bvh_blockers(const struct bvh *, const struct ray *rays, const double *distance,
                  const uint32_t *emitter, struct hit *hits, int n);

// The definition itself, without a tree: what both must equal.
void bvh_closest_brute_force(const struct scene *, const struct ray *rays, struct hit *hits, int n);

struct bvh_statistics {
  uint32_t nodes, leaves, depth;
  double bytes_per_primitive, sah_cost;
};
struct bvh_statistics bvh_statistics(const struct bvh *);

#endif
