// References on disk: finished ones, by what determines them, and unfinished ones, to go on with.
#ifndef RUN_REFERENCE_CACHE_H
#define RUN_REFERENCE_CACHE_H

#include "run/plan.h"

#include "base/file.h"

// The file of the reference that a cell of the group asks for.
char *reference_path(const struct group_plan *, const struct cell *, const char *directory,
                     struct arena *);

// Fills reference and reference_se from a file that is whole; false: there is none.
bool reference_read(const char *path, const struct group_plan *, struct probe *,
                    struct arena scratch);
// Commits `out`, which was begun under the path.
bool reference_write(struct file_out *out, const struct group_plan *, const struct probe *,
                     double samples, struct problem *);

// What has been sampled so far, beside the path. A damaged file is as good as none. Writing dies
// when the disk fails.
void reference_keep(const char *path, const struct moments_tree *, struct arena scratch);
struct moments_tree reference_take_up(const char *path, long width, struct arena *);
void reference_forget(const char *path, struct arena scratch);

#endif
