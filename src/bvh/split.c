// Binned SAH (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
// The unit of cost is the test of a block of BVH_BLOCK triangles, whether full or not.
#include "bvh/split.h"

// Few primitives need few bins: most ranges are small, and what they cost is mostly the bins.
static int bins_for(uint32_t count) {
  uint32_t n = 4 + count;
  return n < BVH_MAX_BINS ? (int)n : BVH_MAX_BINS;
}

struct binning split_binning(const struct bounds *centers, uint32_t count) {
  struct binning binning = {.n = bins_for(count)};
  for (int k = 0; k < 3; k++) {
    double lo = (double)centers->lo[k], hi = (double)centers->hi[k];
    binning.origin[k] = lo;
    binning.scale[k] = hi > lo ? binning.n / (hi - lo) : 0;
  }
  return binning;
}

void split_fill(const struct binning *binning, const struct bvh_ref *ref, uint32_t count,
                struct bins *bins) {
  for (int axis = 0; axis < 3; axis++)
    for (int i = 0; i < binning->n; i++)
      bins->box[axis][i] = bounds_empty(), bins->count[axis][i] = 0;
  for (uint32_t i = 0; i < count; i++) {
    struct bounds box = ref_bounds(&ref[i]);
    float4 center = ref_center(&ref[i]);
    for (int axis = 0; axis < 3; axis++) {
      int bin = split_bin(binning, axis, center);
      bounds_add(&bins->box[axis][bin], box);
      bins->count[axis][bin]++;
    }
  }
}

void split_merge(const struct binning *binning, struct bins *into, const struct bins *from) {
  for (int axis = 0; axis < 3; axis++)
    for (int i = 0; i < binning->n; i++) {
      bounds_add(&into->box[axis][i], from->box[axis][i]);
      into->count[axis][i] += from->count[axis][i];
    }
}

// An empty bin divides as the one before it does, which costs nothing to find out.
static void best_of_axis(const struct bins *bins, int n, int axis, struct split *best) {
  double left_cost[BVH_MAX_BINS];
  struct bounds box = bounds_empty();
  uint32_t count = 0;
  left_cost[0] = INFINITY;
  for (int i = 0; i < n - 1; i++) {
    left_cost[i + 1] = left_cost[i];
    if (bins->count[axis][i] == 0) continue;
    bounds_add(&box, bins->box[axis][i]);
    count += bins->count[axis][i];
    left_cost[i + 1] = bounds_area(box) * bvh_blocks_of(count);
  }
  struct split split = {INFINITY, axis, 0};
  box = bounds_empty(), count = 0;
  for (int i = n - 1; i > 0; i--) {
    if (bins->count[axis][i] == 0) continue;
    bounds_add(&box, bins->box[axis][i]);
    count += bins->count[axis][i];
    double cost = left_cost[i] + bounds_area(box) * bvh_blocks_of(count);
    if (cost <= split.cost) split.cost = cost, split.bin = i;
  }
  if (split.cost < best->cost) *best = split;
}

struct split split_best(const struct binning *binning, const struct bins *bins) {
  struct split best = {.cost = INFINITY};
  for (int axis = 0; axis < 3; axis++)
    if (binning->scale[axis] > 0) best_of_axis(bins, binning->n, axis, &best);
  return best;
}

uint32_t split_count_left(const struct bins *bins, const struct split *split) {
  uint32_t count = 0;
  for (int i = 0; i < split->bin; i++) count += bins->count[split->axis][i];
  return count;
}
