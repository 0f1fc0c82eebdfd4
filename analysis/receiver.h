// The surface around a probe: is it one plane lit by one light and nothing else?
#ifndef ANALYSIS_RECEIVER_H
#define ANALYSIS_RECEIVER_H

#include "base/vec.h"
#include "scene/scene.h"

#include <stdbool.h>

// Every shape lies in the plane (p, n), apart from the black emitter of `light` (any emitter at all
// if nothing that leaves the plane is followed: `direct_only`). So no photon arrives twice.
bool receiver_is_plane(const struct scene *, struct vec p, struct vec n, uint32_t light,
                       bool direct_only);

// Distance from p to the nearest edge of what lies in its plane; edges shared by two triangles are
// inside. For triangles that only touch along part of an edge it is too small, never too large.
double receiver_clearance(const struct scene *, struct vec p, struct vec n, struct arena scratch);

// The same, and to anything that is not in the plane: within this distance theory's expansion in
// r^2 stands, as far as surfaces go. Shadows may still fall there. Boxes stand for curved shapes,
// too near rather than too far; a sphere p lies on is no obstacle (a ball on it is a disc,
// theory 1.5).
double receiver_surroundings(const struct scene *, struct vec p, struct vec n,
                             struct arena scratch);

#endif
