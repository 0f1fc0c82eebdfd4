// Whole files in, whole files out: what is written appears under its name complete or not at all.
#ifndef BASE_FILE_H
#define BASE_FILE_H

#include "base/arena.h"
#include "base/problem.h"

#include <stdbool.h>
#include <stdio.h>

struct text {
  char *data; // zero-terminated; may hold zeros
  ptrdiff_t length;
};

// The whole file. A missing or unreadable one, or a directory, is the user's problem (path and why).
bool file_read(const char *path, struct arena *, struct text *, struct problem *);

bool file_exists(const char *path);

// mkdir -p.
bool file_make_directory(const char *path, struct problem *);

// Write to a temporary name beside the final one, then rename: a killed program leaves no half of a
// file. No fsync, which costs a second a file on a busy disk: what a power cut could damage is cheap
// to make again, or carries a checksum (blocks of runs). Usage:
//   if (!file_begin(&out, path, problem)) return false;
//   fprintf(out.stream, ...);
//   return file_commit(&out, problem);
// file_abandon removes what was begun.
struct file_out {
  FILE *stream;
  char final[4096], temporary[4128];
};
bool file_begin(struct file_out *, const char *path, struct problem *);
bool file_commit(struct file_out *, struct problem *);
void file_abandon(struct file_out *);

// The name without folders and extension: "scenes/box.pbrt" -> "box".
char *file_base_name(const char *path, struct arena *);

#endif
