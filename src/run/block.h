// The unit of work: sixteen runs of one group, reduced to moments, kept in a file of its own so
// that an interrupted experiment goes on where it stopped.
#ifndef RUN_BLOCK_H
#define RUN_BLOCK_H

#include "run/plan.h"
#include "run/progress.h"

// What the runs of a block took until some iteration, all together; not part of any result.
struct block_time {
  double wall_s, cpu_s;
  int64_t photon_bytes; // the most an iteration held, of photons and what finds them
};

// Moments over runs 16 block + 1 ... of each of the plan's `width` numbers, and the time at each of
// its n_times. Over each run the progress advances by `run_work`.
void block_compute(const struct group_plan *, uint64_t block, struct moments *out,
                   struct block_time *, struct progress *, double run_work, struct arena scratch);

// How many runs the block has: RUNS_PER_BLOCK, or less at the end.
int block_runs(const struct group_plan *, uint64_t block);

// Blocks of a plan are files in DIRECTORY/blocks/FINGERPRINT, so that the unfinished work of
// another experiment or version in the same directory is never written over.
const char *block_folder(const struct plan *, const char *directory, struct arena *);

// The file of a block in that folder. A file of another fingerprint, or a damaged one, is as good
// as none: NULL, else its times [n_times]. Writing dies when the disk fails.
const struct block_time *block_times(const struct group_plan *, uint64_t block, const char *folder,
                                     struct arena *);
void block_write(const struct group_plan *, uint64_t block, const char *folder,
                 const struct moments *, const struct block_time *, struct arena scratch);

// Removes the folder of a finished plan and all in it, and DIRECTORY/blocks if it held no other;
// returns whether it did.
bool block_remove_all(const struct plan *, const char *directory, struct arena scratch);

// Merges all blocks of a group: moments over all its runs.
void block_merge(const struct group_plan *, const char *folder, struct moments *out,
                 struct arena scratch);

#endif
