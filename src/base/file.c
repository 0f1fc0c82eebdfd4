#define _GNU_SOURCE // getpid, fileno
#include "base/file.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool file_read(const char *path, struct arena *arena, struct text *text, struct problem *problem) {
  FILE *stream = fopen(path, "rb");
  if (!stream) return problem_set(problem, "%s: cannot open it: %s", path, strerror(errno));
  struct stat info;
  if (fstat(fileno(stream), &info) != 0 || S_ISDIR(info.st_mode)) {
    fclose(stream);
    return problem_set(problem, "%s: is a directory, not a file", path);
  }
  // Read to the end rather than trust the size: the path may be a pipe.
  ptrdiff_t capacity = info.st_size > 0 ? (ptrdiff_t)info.st_size + 2 : 65536, length = 0;
  char *data = arena_new(arena, char, capacity);
  for (;;) { // fread stops short only at the end or at an error
    length += (ptrdiff_t)fread(data + length, 1, (size_t)(capacity - 1 - length), stream);
    if (length < capacity - 1) break;
    data = arena_grow(arena, data, capacity, 2 * capacity, 1, 1);
    capacity *= 2;
  }
  bool bad = ferror(stream);
  int why = errno;
  fclose(stream);
  if (bad) return problem_set(problem, "%s: cannot read it: %s", path, strerror(why));
  *text = (struct text){data, length};
  return true;
}

bool file_exists(const char *path) { return access(path, F_OK) == 0; }

bool file_make_directory(const char *path, struct problem *problem) {
  char part[4096];
  if (!*path) return problem_set(problem, "a directory without a name cannot be made");
  if (strlen(path) >= sizeof part) return problem_set(problem, "%s: path too long", path);
  strcpy(part, path);
  for (char *at = part + 1;; at++) {
    if (*at != '/' && *at != 0) continue;
    char kept = *at;
    *at = 0;
    struct stat info;
    if (mkdir(part, 0777) != 0 && errno != EEXIST)
      return problem_set(problem, "%s: cannot make this directory: %s", part, strerror(errno));
    if (stat(part, &info) != 0 || !S_ISDIR(info.st_mode))
      return problem_set(problem, "%s: is a file, a directory is needed here", part);
    *at = kept;
    if (!kept) return true;
  }
}

bool file_begin(struct file_out *out, const char *path, struct problem *problem) {
  if (strlen(path) >= sizeof out->final) return problem_set(problem, "%s: path too long", path);
  strcpy(out->final, path);
  snprintf(out->temporary, sizeof out->temporary, "%s.tmp%ld", path, (long)getpid());
  out->stream = fopen(out->temporary, "wb");
  if (!out->stream) return problem_set(problem, "%s: cannot write it: %s", path, strerror(errno));
  return true;
}

bool file_commit(struct file_out *out, struct problem *problem) {
  // What fails now says why; after an earlier failure errno still does, success never clears it.
  bool failed = fflush(out->stream) != 0 || ferror(out->stream);
  int why = errno;
  bool closed = fclose(out->stream) == 0;
  out->stream = NULL;
  if (!failed && closed && rename(out->temporary, out->final) == 0) return true;
  if (!failed) why = errno;
  unlink(out->temporary);
  return problem_set(problem, "%s: cannot write it: %s", out->final, strerror(why));
}

void file_abandon(struct file_out *out) {
  if (out->stream) fclose(out->stream);
  out->stream = NULL;
  unlink(out->temporary);
}

char *file_base_name(const char *path, struct arena *arena) {
  const char *slash = strrchr(path, '/');
  const char *name = slash ? slash + 1 : path;
  const char *dot = strrchr(name, '.');
  return arena_string(arena, name, dot && dot != name ? dot - name : (ptrdiff_t)strlen(name));
}
