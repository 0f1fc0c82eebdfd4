// The bodies of grid_find.
#ifndef DENSITY_GRID_LEVEL_H
#define DENSITY_GRID_LEVEL_H

#include "base/level.h"
#include "density/grid.h"

// Of sorted photons: begin <= at < end.
struct grid_range {
  uint32_t begin, end;
};

struct grid_level {
  // Those of n ranges within sqrt(r2) of p; returns how many.
  int (*within)(const struct grid *, const struct grid_range *, int n, struct vec p, double r2,
                uint32_t *at, double *distance2);
};
LEVEL_TABLES(grid_level);

#endif
