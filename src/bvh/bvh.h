// The bounding volume hierarchy. What a ray hits is defined without it: the smallest
// (t, primitive number) over all primitives whose test accepts (scene/shape/); the tree only culls.
#ifndef BVH_BVH_H
#define BVH_BVH_H

#include "base/arena.h"
#include "scene/scene.h"

struct bvh; // bvh/tree.h

struct bvh_options {
  int leaf_size; // most primitives in a leaf; 0: the default, and no tree for a few primitives
};

struct bvh *bvh_build(const struct scene *, struct bvh_options, struct arena *);

// hits[j]: the closest hit of rays[j].
void bvh_closest(const struct bvh *, const struct ray *rays, struct hit *hits, int n);

// blocked[j]: whether anything is hit within (0, t_max).
void bvh_any(const struct bvh *, const struct ray *rays, unsigned char *blocked, int n);

// The definition itself, without a tree: what both must equal.
void bvh_closest_brute_force(const struct scene *, const struct ray *rays, struct hit *hits, int n);

struct bvh_statistics {
  uint32_t nodes, leaves, depth;
  double bytes_per_primitive, sah_cost;
};
struct bvh_statistics bvh_statistics(const struct bvh *);

#endif
