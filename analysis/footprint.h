// The pixel of a probe on the receiver's plane.
#ifndef ANALYSIS_FOOTPRINT_H
#define ANALYSIS_FOOTPRINT_H

#include "log/results.h"
#include "scene/scene.h"

// The points probe.p + s side[0] + t side[1], s and t uniform on [-1, 1].
struct footprint {
  struct vec side[2];
};

// False: the camera, the filter or the view makes it something else.
bool footprint_find(const struct scene *, const struct probe *, struct footprint *);

#endif
