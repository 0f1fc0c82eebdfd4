// Values of an experiment: numbers, counts, names. Each reader fills its result or sets a problem
// at the node's place, worded "KEY: TEXT is not ...".
#ifndef EXPERIMENT_VALUE_H
#define EXPERIMENT_VALUE_H

#include "experiment/tree.h"

#include <stdint.h>

struct reading {
  struct arena *arena;
  struct problem *problem;
  const char *key; // whose value is read
};

// The node's text; NULL when it is a list, a mapping or empty ("... where NOUN is expected").
const char *value_text(struct reading *, const struct node *, const char *noun);

// A finite number, "0.05" or "1e-3", or a ratio of two, "2/3".
bool value_number(struct reading *, const struct node *, double *);

// A whole number from `least` to `most`, exact up to 2^64 - 1 in digits; "1e6" where it is whole.
bool value_count(struct reading *, const struct node *, uint64_t least, uint64_t most, uint64_t *);

// The position of the node's text in names[n]; an unknown one lists those known.
bool value_choice(struct reading *, const struct node *, const char *const *names, int n, int *);

// problem_at the node, "KEY: TEXT " before the format.
bool value_complain(struct reading *, const struct node *, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
