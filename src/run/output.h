// What a finished experiment leaves in its directory.
#ifndef RUN_OUTPUT_H
#define RUN_OUTPUT_H

#include "run/plan.h"

struct outputs {
  const struct plan *plan;
  struct probe *const *probe; // by cell
  const char *directory;
};

// Whether the names of the experiment and its scenes can stand in the outputs.
bool output_check_names(const struct plan *, struct problem *);

// Whether the directory holds the finished results of exactly this plan.
bool output_is_complete(const struct plan *, const char *directory, struct arena scratch);

// Finished results of something else are renamed, not overwritten: DIR.1, DIR.2, ... Unfinished
// blocks (run/block.h) stay. `directory` has no slash at its end.
bool output_set_aside(const struct plan *, const char *directory, struct arena scratch,
                      struct problem *);

// Merges the blocks and writes everything; manifest.json last, then the blocks are removed.
bool output_write(const struct outputs *, struct arena scratch, struct problem *);

#endif
