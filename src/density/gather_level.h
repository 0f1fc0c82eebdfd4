// The bodies of gathers.
#ifndef DENSITY_GATHER_LEVEL_H
#define DENSITY_GATHER_LEVEL_H

#include "base/level.h"
#include "density/gather.h"

// f where wi is on the side of n, and on the other; in the third channel as in the others.
struct sided_bsdf {
  struct vec n;
  double above[3], below[3];
};

struct gather_level {
  // Of n found photons those that the point scatters, moved to the front with f * flux of each;
  // returns how many.
  int (*weigh_by_side)(struct gather *, const struct photons *, const struct sided_bsdf *, int n);
};
LEVEL_TABLES(gather_level);

#endif
