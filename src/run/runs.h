// What is kept of each run (key `keep: runs`), from the blocks into runs.csv.
#ifndef RUN_RUNS_H
#define RUN_RUNS_H

#include "run/plan.h"

// Writes runs.csv if any cell keeps runs: by group, run, cell, probe and checkpoint.
bool runs_collect(const struct plan *, const char *directory, struct arena scratch,
                  struct problem *);

#endif
