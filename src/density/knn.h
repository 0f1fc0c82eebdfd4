// Photons in a balanced tree over their positions (Bentley 1975): the k nearest of a point, and all
// within any radius, where radii differ too much for one grid. The tree is implicit: the median of
// items [lo, hi) along its axis stands in the middle, what is below it before, what is above
// behind. Photons with the same coordinate or distance go by their numbers, so that there is one
// answer.
#ifndef DENSITY_KNN_H
#define DENSITY_KNN_H

#include "base/arena.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

struct knn_item {
  struct vec p;
  uint32_t photon; // its number
  uint32_t axis;   // 0, 1, 2: along which it parts those around it
};

struct knn {
  int64_t count, capacity;
  struct knn_item *item;
};

// Grows in the arena.
void knn_build(struct knn *, const struct vec *position, int64_t count, struct arena *);

// Which photons count; NULL: all.
struct knn_filter {
  bool (*accept)(void *data, uint32_t photon);
  void *data;
};

// The k nearest of p among those that count, the nearest first: their numbers and squared
// distances. Returns how many there are, less than k only if no more count.
int knn_nearest(const struct knn *, struct vec p, int k, const struct knn_filter *,
                uint32_t *photon, double *distance2);

// All nearer than r, in the order of the tree.
int knn_within(const struct knn *, struct vec p, double r, uint32_t *photon, double *distance2);

#endif
