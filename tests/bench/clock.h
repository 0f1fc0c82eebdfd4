// Time, the core it is taken on, and statistics of repetitions.
#ifndef TESTS_BENCH_CLOCK_H
#define TESTS_BENCH_CLOCK_H

#include "tests/bench/bench.h"

enum { MOST_REPETITIONS = 64 };

struct seconds {
  double cpu, wall; // cpu: user and system, of all threads
};
struct seconds clock_now(void);
struct seconds clock_since(struct seconds);

// To the core it runs on, or to all it had at first.
void clock_pin(bool one_core);

// CPU seconds of a fixed piece of work (arithmetic in double, and loads that miss the first cache):
// what seconds are compared to, so that a busy or another machine matters less.
double clock_calibrate(void);

// One repetition each.
struct repetition {
  struct seconds time;
  double calibration;
};

// What is said of a row.
struct figure {
  double value, low, high; // the median (or mean), and quartiles
  double relative;         // the value where the unit of time is the calibration's
  // To the base, of the ratios of turns: the median, and quartiles. NAN: no base.
  double ratio, ratio_low, ratio_high;
  struct seconds time; // of all repetitions
  int repetitions;
};

// base: the repetitions of the row that it is compared to, or NULL.
struct figure figure_of(const struct row *, const struct repetition *, int n,
                        const struct row *base_row, const struct repetition *base);

#endif
