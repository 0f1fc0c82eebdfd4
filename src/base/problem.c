#include "base/problem.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Behind what is there already; what does not fit is cut.
static void append(struct problem *problem, const char *format, va_list args) {
  size_t used = strlen(problem->text);
  vsnprintf(problem->text + used, sizeof problem->text - used, format, args);
}

static void append_place(struct problem *problem, const char *format, ...) {
  va_list args;
  va_start(args, format);
  append(problem, format, args);
  va_end(args);
}

bool problem_set(struct problem *problem, const char *format, ...) {
  if (problem->text[0]) return false;
  va_list args;
  va_start(args, format);
  append(problem, format, args);
  va_end(args);
  return false;
}

bool problem_at(struct problem *problem, struct place place, const char *format, ...) {
  if (problem->text[0]) return false;
  append_place(problem, "%s:", place.file);
  if (place.line > 0) append_place(problem, "%d:%d:", place.line, place.column);
  append_place(problem, " ");
  va_list args;
  va_start(args, format);
  append(problem, format, args);
  va_end(args);
  return false;
}

void die(const char *format, ...) {
  va_list args;
  va_start(args, format);
  fputs("photonlab: ", stderr);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
  va_end(args);
  fflush(stdout);
  _Exit(1); // not exit: two threads may die of the same full disk, and exit is for one
}
