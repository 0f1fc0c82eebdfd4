#include "base/problem.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static void fill(struct problem *problem, int used, const char *format, va_list args) {
  if (used >= 0 && used < (int)sizeof problem->text)
    vsnprintf(problem->text + used, sizeof problem->text - (size_t)used, format, args);
}

bool problem_set(struct problem *problem, const char *format, ...) {
  if (problem->text[0]) return false;
  va_list args;
  va_start(args, format);
  fill(problem, 0, format, args);
  va_end(args);
  return false;
}

bool problem_at(struct problem *problem, struct place place, const char *format, ...) {
  if (problem->text[0]) return false;
  int used = snprintf(problem->text, sizeof problem->text, "%s:", place.file);
  if (place.line > 0)
    used += snprintf(problem->text + used, sizeof problem->text - (size_t)used, "%d:%d:",
                     place.line, place.column);
  used += snprintf(problem->text + used, sizeof problem->text - (size_t)used, " ");
  va_list args;
  va_start(args, format);
  fill(problem, used, format, args);
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
  exit(1);
}
