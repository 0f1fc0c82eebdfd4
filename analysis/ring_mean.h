// The light around a probe where theory knows it: on a plane under one light, also by a mirror or
// with a shadow's edge (theory 5).
#ifndef ANALYSIS_RING_MEAN_H
#define ANALYSIS_RING_MEAN_H

#include "analysis/chebyshev.h"
#include "analysis/shadow.h"
#include "base/arena.h"
#include "experiment/experiment.h"
#include "log/results.h"
#include "scene/scene.h"

// The density of photons around the probe, averaged over the angle, in the squared distance; a
// shadow's edge only where it is the same everywhere, and `density` is that of the lit side.
struct ring_mean {
  int d;       // dimensions of that distance
  double flux; // luminance per photon
  struct chebyshev density;
  struct half_shadow shadow;
  double spread; // the distance to the edge is uniform, by as much as this: a pixel's footprint
};

// False: there is no closed form for this probe within `radius`.
bool ring_mean_find(const struct scene *, const struct cell *, const struct probe *, double radius,
                    struct arena scratch, struct ring_mean *);

#endif
