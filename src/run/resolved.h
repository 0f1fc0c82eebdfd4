// Whether radii that count in reference radii are resolved, as those in scene units must be.
#ifndef RUN_RESOLVED_H
#define RUN_RESOLVED_H

#include "run/plan.h"

// At the probes, where the first eye pass of the first run finds them, and at the last iteration.
bool resolved_at_probes(const struct group_plan *, struct arena scratch, struct problem *);

#endif
