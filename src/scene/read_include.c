// Include and Import: other files within a file.
#include "base/gzip.h"
#include "scene/reader.h"

#include <stdio.h>

// Deeper is a file that includes itself; a file that includes another twice, and so on, can ask for
// more files than there are.
enum { MAX_DEPTH = 32, MAX_FILES = 100000 };

static bool too_deep(struct reader *reader, const struct call *call) {
  char chain[512];
  size_t used = 0;
  const struct reading *file = reader->reading;
  for (int k = 0; file && k < 4 && used < sizeof chain; k++, file = file->outer)
    used +=
        (size_t)snprintf(chain + used, sizeof chain - used, "%s%s", k ? " in " : "", file->path);
  return problem_at(
      reader->problem, call->place,
      "files are nested more than %d deep: \"%s\" in %s in ...; does one include itself?",
      MAX_DEPTH, call->type, chain);
}

static bool check_nesting(struct reader *reader, const struct call *call) {
  int depth = 0;
  for (const struct reading *file = reader->reading; file; file = file->outer) depth++;
  if (depth > MAX_DEPTH) return too_deep(reader, call);
  if (++reader->n_files > MAX_FILES)
    return problem_at(reader->problem, call->place, "more than %d files are included", MAX_FILES);
  return true;
}

static bool open_text(struct reader *reader, const char *path, struct arena *arena,
                      struct text *text, struct problem *problem) {
  return scene_read_path(&reader->builder, path, arena, text, problem) &&
         (!gzip_is(*text) || gzip_expand(path, *text, arena, text, problem));
}

static bool read_nested(struct reader *reader, const struct call *call) {
  struct arena scratch = call->scratch;
  struct problem problem = {{0}};
  struct text text;
  if (!check_nesting(reader, call)) return false;
  const char *path = scene_path_of(&reader->builder, call->type, &reader->lists); // for places
  if (!open_text(reader, path, &scratch, &text, &problem))
    return problem_at(reader->problem, call->place, "%s: %s", call->name, problem.text);
  struct lexer outer = reader->lexer;
  struct reading file = {path, reader->reading};
  reader->lexer = lexer_begin(path, text, reader->problem);
  reader->reading = &file;
  bool ok = read_directives(reader, scratch);
  reader->reading = file.outer;
  reader->lexer = outer;
  return ok;
}

bool read_include(struct reader *reader, struct call *call) { return read_nested(reader, call); }

// What the file begins it must end, and its attributes stay its own.
bool read_import(struct reader *reader, struct call *call) {
  struct attributes now = reader->now;
  ptrdiff_t outside = reader->saved_outside;
  reader->saved_outside = reader->saved.count;
  bool ok = read_nested(reader, call) && read_all_popped(reader, reader->saved_outside);
  reader->saved_outside = outside;
  reader->now = now;
  return ok;
}
