// The unit of work: sixteen runs of one group, reduced to moments (with key `keep: runs` also each
// run's averages), kept in a file of its own so that an interrupted experiment goes on where it
// stopped.
#ifndef RUN_BLOCK_H
#define RUN_BLOCK_H

#include "run/worker.h"

// How many runs the block has: RUNS_PER_BLOCK, or less at the end.
int block_runs(const struct group_plan *, uint64_t block);

// Of runs 16 block + 1 ...: their times and moments, and what is kept of each.
struct block {
  struct block_time *time; // [n_times]
  struct moments *moments; // [width]
  double *kept;            // [block_runs][kept_width], run by run
};
struct block block_new(const struct group_plan *, uint64_t block, struct arena *);

// A block on its way: runs added in their order, whoever computed them.
struct block_sum {
  const struct group_plan *plan;
  uint64_t number;
  struct block *block;
  struct moments *leaf;
  struct moments_tree tree;
};
struct block_sum block_begin(const struct group_plan *, uint64_t number, struct block *out,
                             struct arena *);
// The next run, the worker's last one. True: it was the last of the block, which is ready now.
bool block_add(struct block_sum *, const struct worker *, struct arena *);

// All of it on this thread. Over each run the progress advances by `run_work`.
void block_compute(const struct group_plan *, uint64_t block, struct block *out, struct progress *,
                   double run_work, struct arena scratch);

// Blocks of a plan are files in DIRECTORY/blocks/FINGERPRINT, so that the unfinished work of
// another experiment or version in the same directory is never written over.
const char *block_folder(const struct plan *, const char *directory, struct arena *);

// The file of a block in that folder. A file of another fingerprint, or a damaged one, is as good
// as none: false. Writing dies when the disk fails.
bool block_read(const struct group_plan *, uint64_t block, const char *folder, struct block *,
                struct arena *);
const struct block_time *block_times(const struct group_plan *, uint64_t block, const char *folder,
                                     struct arena *); // NULL: none
void block_write(const struct group_plan *, uint64_t block, const char *folder,
                 const struct block *, struct arena scratch);

// Removes the folder of a finished plan and all in it, and DIRECTORY/blocks if it held no other;
// returns whether it did.
bool block_remove_all(const struct plan *, const char *directory, struct arena scratch);

// A block of a run that is finished; dies where there is none.
struct block block_must_read(const struct group_plan *, uint64_t block, const char *folder,
                             struct arena *);

// Merges all blocks of a group: moments over all its runs.
void block_merge(const struct group_plan *, const char *folder, struct moments *out,
                 struct arena scratch);

#endif
