// A reader over the fields of the lines of a CSV file without quotes.
#ifndef LOG_CSV_H
#define LOG_CSV_H

#include "base/arena.h"
#include "base/problem.h"

#include <stdint.h>

struct csv {
  const char *path;
  char *at;
  int line;
  uint64_t sum; // of the whole file, XXH64
  struct problem *problem;
};

// False and a problem where the first line is not `header`.
bool csv_open(struct csv *, const char *path, const char *header, struct arena *, struct problem *);

// Sets the problem: the file is damaged at this line. False.
bool csv_bad(struct csv *, const char *what);

// Splits the next line into exactly n fields.
bool csv_row(struct csv *, int n, char **field);
bool csv_numbers(struct csv *, char *const *field, int n, double *const *value);
// A whole number from `least` to `most`, both below 2^53.
bool csv_whole(struct csv *, char *field, uint64_t least, uint64_t most, uint64_t *value);

// When every row made sense: whether the file is the one with this sum.
bool csv_close(const struct csv *, uint64_t sum);

#endif
