// The bodies of walk_sample_facets.
#ifndef WALK_FACETS_LEVEL_H
#define WALK_FACETS_LEVEL_H

#include "base/simd.h"
#include "walk/facets.h"

struct facets_level {
  // cosine, wi and pdf of the first n; those behind, up to a multiple of 8, may become anything.
  void (*sample)(struct facets *, int n);
};
SIMD_TABLES(facets_level);

#endif
