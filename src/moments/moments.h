// Moments over runs. They are reduced in one fixed binary tree over run numbers, so that any split
// of the runs over threads, machines or resumptions gives the same bits.
#ifndef MOMENTS_MOMENTS_H
#define MOMENTS_MOMENTS_H

#include "base/arena.h"

#include <stdint.h>

struct moments {
  double n, mean, m2, m3, m4; // m_p = sum of (x - mean)^p
};

static inline struct moments moments_of(double x) { return (struct moments){1, x, 0, 0, 0}; }

// Chan, Golub, LeVeque 1979; third and fourth by Pebay 2008.
struct moments moments_merge(struct moments a, struct moments b);

static inline double moments_variance(struct moments m) { return m.m2 / (m.n - 1); }  // unbiased
static inline double moments_se2(struct moments m) { return m.m2 / (m.n - 1) / m.n; } // of the mean

// Mean and m2 alone, of numbers that come one after the other: a pixel's over iterations.
struct running {
  double mean, m2;
};

// The n-th number (Welford 1962).
static inline void running_add(struct running *running, double x, double n) {
  double delta = x - running->mean;
  running->mean += delta / n;
  running->m2 += delta * (x - running->mean);
}

// The tree, over vectors of `width` numbers: push vectors in the order of run numbers (or moments
// of blocks of equal power-of-two size in the order of block numbers), then read the root.
struct moments_tree {
  long width;
  int levels;             // that can be stored
  uint64_t count;         // leaves pushed
  struct moments **level; // [levels][width]; level l is in use iff bit l of count is set
};
enum { MOMENTS_LEVELS = 40 };
struct moments_tree moments_tree_new(long width, struct arena *);
void moments_tree_push(struct moments_tree *, struct moments *leaf, struct arena *);
// Smaller subtrees (later runs) are merged first.
void moments_tree_root(const struct moments_tree *, struct moments *out);

#endif
