// Flat surfaces that scatter as Lambert says, the same at every point (shape.lambert): most of what
// most paths meet. They are sampled a block at a time, to the same bits as by bsdf.h.
#ifndef WALK_FACETS_H
#define WALK_FACETS_H

enum { FACETS = 64 }; // in a block, a multiple of the vectors' lanes

struct facets {
  double d[3][FACETS];   // of the path that arrives
  double n[3][FACETS];   // ng = ns
  double u[2][FACETS];   // random numbers of the direction
  double cosine[FACETS]; // of where it comes from to n; 0: along the surface, it is not met
  double wi[3][FACETS];  // where it goes
  double pdf[FACETS];    // solid angle
};

#endif
