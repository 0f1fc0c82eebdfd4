// The unit of work: sixteen runs of one group, reduced to moments, kept in a file of its own so
// that an interrupted experiment goes on where it stopped.
#ifndef RUN_BLOCK_H
#define RUN_BLOCK_H

#include "run/plan.h"

// Moments over runs 16 block + 1 ... of each of the plan's `width` numbers.
void block_compute(const struct group_plan *, uint64_t block, struct moments *out,
                   struct arena scratch);

// The file of a block in a results directory. A file of another fingerprint, or a damaged one, is
// as good as none. Writing dies when the disk fails.
bool block_exists(const struct group_plan *, uint64_t block, const char *directory,
                  struct arena scratch);
void block_write(const struct group_plan *, uint64_t block, const char *directory,
                 const struct moments *, struct arena scratch);
void block_remove(const struct group_plan *, uint64_t block, const char *directory,
                  struct arena scratch);

// Merges all blocks of a group: moments over all its runs.
void block_merge(const struct group_plan *, const char *directory, struct moments *out,
                 struct arena scratch);

#endif
