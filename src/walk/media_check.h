// Whether a scene's media fit together. What a ray is in follows from the surfaces it has crossed
// (scene.h: surface_medium), so media that overlap, or a lamp in fog whose shape says vacuum, make
// eye paths and photons see different worlds.
#ifndef WALK_MEDIA_CHECK_H
#define WALK_MEDIA_CHECK_H

#include "bvh/bvh.h"

// Follows a fixed number of rays from the camera and from every light, through whatever scatters
// them; what moves is where the motion begins. At each surface that has a medium on a side, the
// medium on the ray's side must be the ray's; of a shape that emits towards the ray always. Where
// light comes from infinity, a ray that leaves the scene must be in a vacuum. Two paths have to
// disagree: one alone may have passed between two of a sphere's rounded points. False: problem set.
bool media_check(const struct scene *, const struct bvh *, struct arena scratch, struct problem *);

#endif
