// What bias is measured against: an unbiased estimate at the probes with a standard error asked
// for, cached beside the results by what determines it.
#ifndef RUN_REFERENCE_H
#define RUN_REFERENCE_H

#include "run/plan.h"

// Fills reference and reference_se of the group's probes as one of its cells asks. `directory`
// holds the cache. The seed is the references' own. Interrupted: returns false without a problem,
// and goes on from the last block of samples when called again.
bool reference_make(const struct group_plan *, const struct cell *, const struct run_options *,
                    const char *directory, struct probe *, struct arena scratch, struct problem *);

// About how many seconds that will take on one thread; from a sixteenth of a block.
double reference_left_s(const struct group_plan *, const struct cell *, const char *directory,
                        struct arena scratch);

#endif
