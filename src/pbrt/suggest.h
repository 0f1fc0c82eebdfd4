// "did you mean": the nearest known name.
#ifndef PBRT_SUGGEST_H
#define PBRT_SUGGEST_H

#include <stddef.h>

// How many letters must be inserted, deleted, replaced or swapped with a neighbour to make b of a
// (case ignored); names longer than 63 letters are as far as can be.
int suggest_distance(const char *a, const char *b);

// The nearest of names[0, n) if no more than a third of the letters differ, else NULL.
const char *suggest_name(const char *name, const char *const *names, int n);

#endif
