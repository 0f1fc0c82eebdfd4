// A block of runs ahead of an experiment: what they say of biases needs no reference (Richardson).
#ifndef RUN_PILOT_H
#define RUN_PILOT_H

#include "run/plan.h"

// The experiment's cells with a block of runs each, no pictures, and reference richardson where
// radii allow it, else none.
struct experiment pilot_of(const struct experiment *, struct arena *);

// The moments of the pilot's block of one group.
struct moments *pilot_run(const struct group_plan *, struct arena *);

// References that are to be known to a share of the smallest bias get a standard error: that of the
// last iteration, at the probes where a bias is seen by two standard errors, if none is of two
// standard errors themselves. A bias proportional to r^2 is assumed. `settled` is the experiment
// with them.
bool pilot_settle(const struct experiment *, struct run_options, struct experiment *settled,
                  struct arena *, struct problem *);

#endif
