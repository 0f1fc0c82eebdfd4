// Whole experiments, as `photonlab run` runs them.
#ifndef TESTS_BENCH_TRIAL_H
#define TESTS_BENCH_TRIAL_H

#include "run/run.h"
#include "tests/bench/bench.h"

struct trial {
  struct experiment experiment;
  struct run_options options; // quiet, on as many threads as are said
  const char *directory;
};

// An experiment file, to be run into a directory below the benchmark's folder.
struct trial *trial_new(struct bench *, const char *path, const char *quality, const char *name);

void trial_run(void *trial, int repetition); // row.body: from the beginning each time

// Runs both and dies unless what they measured is the same. shorter: runs (key keep) of the first
// are fewer, and are those the second began with.
void trial_check_same(struct trial *, struct trial *, bool shorter);

#endif
