// Rays and hits, as they travel in arrays.
#ifndef SCENE_RAY_H
#define SCENE_RAY_H

#include "base/vec.h"

#include <math.h>
#include <stdint.h>

#define PRIMITIVE_NONE UINT32_MAX

// One cache line. Hits are searched in 0 < t < t_max; `leaving` is the primitive the origin lies
// on: a flat one is ignored (a triangle with every triangle in its plane or behind it), of a curved
// one the root that is the origin itself. No origin is ever moved.
struct ray {
  struct vec o, d;  // d need not be of unit length
  double t_max;
  uint32_t leaving; // or PRIMITIVE_NONE
};

struct hit {
  double t;           // INFINITY: nothing hit
  uint32_t primitive; // or PRIMITIVE_NONE
};

#endif
