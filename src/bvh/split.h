// Where to divide a range of primitives: binned SAH.
#ifndef BVH_SPLIT_H
#define BVH_SPLIT_H

#include "bvh/bounds.h"

enum { BVH_MAX_BINS = 32 };

// The boxes of a set of primitives and of their centres.
struct extent {
  struct bounds box, centers;
};

static inline struct extent extent_empty(void) {
  return (struct extent){bounds_empty(), bounds_empty()};
}

static inline void extent_add(struct extent *a, const struct extent *b) {
  bounds_add(&a->box, b->box);
  bounds_add(&a->centers, b->centers);
}

static inline void extent_add_ref(struct extent *a, const struct bvh_ref *ref) {
  bounds_add(&a->box, ref_bounds(ref));
  bounds_add_point(&a->centers, ref_center(ref));
}

// Which bin: (center - origin) * scale on each axis. Scale 0: all centres of that axis are one.
struct binning {
  int n;
  double origin[3], scale[3];
};

struct bins {
  struct bounds box[3][BVH_MAX_BINS];
  uint32_t count[3][BVH_MAX_BINS];
};

struct split {
  double cost;   // of the children, in block tests times area; INFINITY: there is none
  int axis, bin; // the first bin of the right side
};

struct binning split_binning(const struct bounds *centers, uint32_t count);

static inline int split_bin(const struct binning *binning, int axis, float4 center) {
  int bin = (int)(((double)center[axis] - binning->origin[axis]) * binning->scale[axis]);
  return bin < binning->n ? bin : binning->n - 1;
}

static inline bool split_is_left(const struct binning *binning, const struct split *split,
                                 const struct bvh_ref *ref) {
  return split_bin(binning, split->axis, ref_center(ref)) < split->bin;
}

void split_fill(const struct binning *, const struct bvh_ref *, uint32_t count, struct bins *);
void split_merge(const struct binning *, struct bins *into, const struct bins *);

// The cheapest plane between bins, of equals the one of the lowest axis and bin.
struct split split_best(const struct binning *, const struct bins *);

// How many are left of it.
uint32_t split_count_left(const struct bins *, const struct split *);

#endif
