// A transformation between two times, as pbrt-v4's AnimatedTransform: M = T R S by polar
// decomposition; the translation T and the stretch S go linearly, the rotation R by the shorter arc.
#ifndef SCENE_ANIMATION_H
#define SCENE_ANIMATION_H

#include "scene/transform.h"

struct animation {
  bool moves; // false: end[0] at all times
  struct transform end[2];
  struct vec translation[2];
  double rotation[2][4]; // unit quaternions x, y, z, w in one half of the sphere
  double stretch[2][3][3];
};

struct animation animation_new(struct transform start, struct transform end);

// At a share of the interval; before 0 and after 1 the ends themselves.
struct transform animation_at(const struct animation *, double share);

// Of a point at p at all shares: it stays within `slack` (each axis) of its places at the shares
// k / ANIMATION_STEPS.
enum { ANIMATION_STEPS = 32 };
double animation_slack(const struct animation *, struct vec p);

#endif
