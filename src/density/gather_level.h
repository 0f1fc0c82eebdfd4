// The bodies of gathers.
#ifndef DENSITY_GATHER_LEVEL_H
#define DENSITY_GATHER_LEVEL_H

#include "density/grid_level.h"

// Lambert's: f on the side of n, nothing on the other.
struct sided_bsdf {
  struct vec n;
  double f[3];
};

struct gather_level {
  // The photons of n ranges within sqrt(r2) of p that are scattered: their squared distances and
  // f * flux; returns how many.
  int (*find_on_side)(const struct grid *, const struct grid_range *, int n, struct vec p,
                      double r2, const struct sided_bsdf *, double *distance2,
                      double *const value[3]);
};
SIMD_TABLES(gather_level);

#endif
