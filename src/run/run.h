// The experiment runner: photonlab run.
#ifndef RUN_RUN_H
#define RUN_RUN_H

#include "run/plan.h"

// Seconds one run of a group takes on one thread: a few of its iterations, spread over all of them,
// until a twentieth of a second has passed.
double run_seconds(const struct group_plan *, struct arena scratch);

enum run_outcome { RUN_FAILED, RUN_DONE, RUN_INTERRUPTED };

// Runs the experiment into `directory` (made if needed), going on where an interrupted run of the
// same experiment stopped. RUN_FAILED: problem set, nothing half-written. Writes manifest.json,
// log.csv, runs.csv (key keep), probes.csv, timing.csv, images/*.exr, discs/*.csv and a copy of the
// experiment; references are cached in `references` beside the directory.
enum run_outcome run_experiment(const struct experiment *, const char *directory,
                                struct run_options, struct arena *, struct problem *);

// Only the references that run_experiment would sample, into the same cache; probe[cell] are then
// the probes of each cell.
enum run_outcome run_references(const struct experiment *, const char *directory,
                                struct run_options, struct probe **probe, struct plan *,
                                struct arena *, struct problem *);

#endif
