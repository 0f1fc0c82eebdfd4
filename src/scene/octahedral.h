// pbrt-v4's equal-area map between the square [0, 1]^2 and the unit sphere (Clarberg 2008, "Fast
// Equal-Area Mapping of the (Hemi)Sphere using SIMD"): each area of the square is 4 pi times as
// large on the sphere. The inner diamond is the upper hemisphere (z > 0) with the pole in its
// centre; the corners are folded below.
#ifndef SCENE_OCTAHEDRAL_H
#define SCENE_OCTAHEDRAL_H

#include "base/vec.h"
#include "numeric/elementary.h"

static inline struct vec octahedral_direction(double u, double v) {
  double x = 2 * u - 1, y = 2 * v - 1, ax = fabs(x), ay = fabs(y);
  double to_diamond = 1 - (ax + ay), r = 1 - fabs(to_diamond), sine, cosine;
  // The angle in the quadrant, in eighths of a turn: 0 on the axis of x, 2 on that of y.
  num_sincos_turns((r == 0 ? 1 : (ay - ax) / r + 1) / 8, &sine, &cosine);
  double across = r * sqrt(2 - r * r), z = 1 - r * r;
  return vec(x < 0 ? -cosine * across : cosine * across, y < 0 ? -sine * across : sine * across,
             to_diamond < 0 ? -z : z);
}

// d of unit length.
static inline void octahedral_square(struct vec d, double *u, double *v) {
  const double two_over_pi = 0x1.45f306dc9c883p-1;
  double ax = fabs(d.x), ay = fabs(d.y);
  double r = sqrt((ax * ax + ay * ay) / (1 + fabs(d.z))); // sqrt(1 - |z|)
  double y = ax == 0 && ay == 0 ? 0 : num_atan2(ay, ax) * two_over_pi * r, x = r - y;
  if (d.z < 0) {
    double swap = x;
    x = 1 - y;
    y = 1 - swap;
  }
  *u = ((d.x < 0 ? -x : x) + 1) / 2;
  *v = ((d.y < 0 ? -y : y) + 1) / 2;
}

#endif
