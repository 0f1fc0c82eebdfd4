// What a thread needs for runs of a group, one after the other.
#ifndef RUN_WORKER_H
#define RUN_WORKER_H

#include "run/plan.h"
#include "run/progress.h"

// What a run took until some iteration, or the runs of a block together; not part of any result.
struct block_time {
  double wall_s, cpu_s;
  int64_t photon_bytes; // the most an iteration held, of photons and what finds them
};

// Running sums of one run: of the probes' luminance, and of the film where images are kept.
struct worker_sums {
  double *probe, *film;
  long film_size;
};

struct worker {
  const struct group_plan *plan;
  uint64_t run;            // the last
  void *state;             // the integrator's
  double *frame;           // of one iteration
  double *value;           // [width] of the last run
  struct block_time *time; // [n_times] of the last run
  struct block_time made;  // what worker_new took, until a run has it
  struct worker_sums sum;
};
struct worker *worker_new(const struct group_plan *, struct arena *);

// Run k = 1, 2, ..., over which the progress advances by `run_work`.
void worker_run(struct worker *, uint64_t run, struct progress *, double run_work);

// What is kept of the last run: [kept_width].
void worker_keep(const struct worker *, double *kept);

#endif
