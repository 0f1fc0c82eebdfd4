// Errors under stress: the numerical hazards of long and extreme runs (theory 7), each by the code
// that measures and fits, against what is exact. A hazard is a row of a table in stability_*.c.
// What whole scenes show is in experiments/numerical-stability.sh.
#ifndef APP_STABILITY_H
#define APP_STABILITY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

struct stress {
  const char *family;       // a panel of the figure
  const char *what, *level; // what is measured, and what stresses it
  double from, to, factor;  // levels: from, from * factor, ... to
  double parameter;
  double (*error)(double parameter, double level);
  double (*bound)(double parameter, double level); // NULL: a way not taken, for comparison
  bool (*refused)(double level);                   // NULL: nothing is
};

// The tables end with a row without a family.
extern const struct stress stress_laws[], stress_sums[], stress_moments[], stress_places[];

// 32 bits that are as good as random.
static inline uint64_t stability_term(uint64_t j) {
  uint64_t z = (j + 1) * UINT64_C(0x9e3779b97f4a7c15);
  return ((z ^ z >> 32) * UINT64_C(0xbf58476d1ce4e5b9)) >> 32;
}

// Prints a line per row, its worst level, and a last one; `csv`: NULL, or all levels go there.
// True: every error is within its bound, or the level refused.
bool stability_run(FILE *out, FILE *csv);

#endif
