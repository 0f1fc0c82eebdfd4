// The straight edge of a shadow in parallel light, and kernels that reach across it (theory 1.5,
// 5 iv).
#ifndef ANALYSIS_SHADOW_H
#define ANALYSIS_SHADOW_H

#include "base/arena.h"
#include "density/kernel.h"
#include "scene/scene.h"

#include <stdbool.h>

enum shade {
  SHADE_NONE,
  SHADE_LIT,
  SHADE_DARK
}; // is there an edge, and which side is the probe on?

struct half_shadow {
  enum shade shade;
  double distance;   // from the probe to the edge
  struct vec across; // and the direction, of unit length
};

// What keeps parallel light, that comes from direction wi over `distance`, from the disc of this
// radius around p: opaque triangles above the receiver (p, n), whose shadow in the disc is nothing
// or a half-plane. False: it is something else, or what casts it might scatter light to the
// receiver; nothing scatters if only direct light is followed.
bool shadow_find(const struct scene *, struct vec p, struct vec n, struct vec wi, double distance,
                 double radius, bool direct_only, struct arena scratch, struct half_shadow *);

// The integral of psi^power over the part of the unit disc beyond a line at this distance from its
// centre, in [0, 1].
double shadow_beyond(const struct kernel *, int power, double distance);

#endif
