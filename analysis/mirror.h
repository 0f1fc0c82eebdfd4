// Light that reaches a plane by one plane mirror (theory 5 viii): its irradiance is that of the
// light's mirror image.
#ifndef ANALYSIS_MIRROR_H
#define ANALYSIS_MIRROR_H

#include "analysis/flat.h"
#include "base/arena.h"
#include "experiment/experiment.h"

struct vec mirror_point(const struct plane *mirror, struct vec p);
struct vec mirror_direction(const struct plane *mirror, struct vec w);

// Every shape lies in the receiver (p, n) or in one plane of perfect mirrors, which sends the light
// of the scene's only light, a point or a beam, to all of the disc of this radius around p. The
// disc sees none of it directly. Paths have at most three scatterings: so light arrives once, and
// the eye sees p directly or by the mirror.
bool mirror_find(const struct scene *, const struct cell *, struct vec p, struct vec n,
                 double radius, struct arena scratch, struct plane *mirror);

#endif
