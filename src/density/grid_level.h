// The bodies of grid_build and grid_find.
#ifndef DENSITY_GRID_LEVEL_H
#define DENSITY_GRID_LEVEL_H

#include "base/simd.h"
#include "density/grid.h"

// Of sorted photons: begin <= at < end.
struct grid_range {
  uint32_t begin, end;
};

// Where the photons around p are, and others: the ranges of its cells that are not empty. The grid
// is not empty.
enum { GRID_RANGES = 2 * 16 * 16 };
int grid_ranges(const struct grid *, struct vec p, double r, struct grid_range[GRID_RANGES]);

struct grid_level {
  // Widens the box lo..hi to hold n positions, no number left out.
  void (*bound)(const struct vec *, int64_t n, double lo[3], double hi[3]);
  // bucket[j] of n positions in a box of less than 2^31 cells each way, none beyond 2^51.
  void (*buckets)(const struct grid *, const struct vec *, int64_t n, uint32_t *bucket);
  // Those of n ranges within sqrt(r2) of p; returns how many.
  int (*within)(const struct grid *, const struct grid_range *, int n, struct vec p, double r2,
                uint32_t *at, double *distance2);
};
SIMD_TABLES(grid_level);

#endif
