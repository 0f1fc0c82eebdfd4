// Two ways to fail (a third, assert, is for our own bugs).
// The user's file or flag: the reader fills a problem and returns false; only the command line prints it.
// The world (memory, disk): die where it happens.
#ifndef BASE_PROBLEM_H
#define BASE_PROBLEM_H

#include <stdbool.h>

struct problem {
  char text[1024]; // one line, no newline
};

struct place {
  const char *file; // as the user wrote it
  int line, column; // from 1; 0 where there is none
};

// Both return false, so that a reader can `return problem_at(...)`. The first problem set is kept.
bool problem_set(struct problem *, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool problem_at(struct problem *, struct place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Prints "photonlab: ..." and exits with status 1.
_Noreturn void die(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
