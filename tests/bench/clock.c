#define _GNU_SOURCE // sched_setaffinity
#include "tests/bench/clock.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds_of(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct seconds clock_now(void) {
  return (struct seconds){seconds_of(CLOCK_PROCESS_CPUTIME_ID), seconds_of(CLOCK_MONOTONIC)};
}

struct seconds clock_since(struct seconds begin) {
  struct seconds now = clock_now();
  return (struct seconds){now.cpu - begin.cpu, now.wall - begin.wall};
}

void clock_pin(bool one_core) {
  static cpu_set_t all;
  static bool known;
  static int core;
  if (!known) {
    sched_getaffinity(0, sizeof all, &all);
    core = sched_getcpu();
    known = true;
  }
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  sched_setaffinity(0, sizeof one, one_core ? &one : &all);
}

enum { TABLE = 1 << 15, STEPS = 200000 };

double clock_calibrate(void) {
  static double table[TABLE];
  static volatile double sink __attribute__((unused));
  if (table[0] == 0)
    for (int i = 0; i < TABLE; i++) table[i] = 1 + (double)((i * 7919) % TABLE) / TABLE;
  double begin = seconds_of(CLOCK_PROCESS_CPUTIME_ID), x = 1, y = 1, sum = 0;
  uint32_t at = 1;
  for (int i = 0; i < STEPS; i++) {
    at = at * 1664525 + 1013904223;
    double t = table[at >> 17];
    x = x * t + 0.5 * y;
    y = y * 0.25 + t;
    x = x > 4 ? x * 0.125 : x;
    sum += t < 1.5 ? x / t : sqrt(y);
  }
  sink = sum;
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID) - begin;
}

// ---- statistics ----
static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Of sorted numbers, by linear interpolation.
static double quantile(const double *x, int n, double p) {
  double at = p * (n - 1);
  int k = (int)at;
  return k + 1 < n ? x[k] + (at - k) * (x[k + 1] - x[k]) : x[k];
}

static double median(double *x, int n) {
  qsort(x, (size_t)n, sizeof *x, compare);
  return quantile(x, n, 0.5);
}

static double mean(const double *x, int n) {
  double sum = 0;
  for (int k = 0; k < n; k++) sum += x[k];
  return sum / n;
}

// Of a repetition that took t: seconds, or calibrations.
static double value_of(const struct row *row, double t) {
  return row->kind == RATE ? row->work / t : t / row->work;
}

static double time_of(const struct row *row, const struct repetition *repetition) {
  return row->threads > 1 ? repetition->time.wall : repetition->time.cpu;
}

struct figure figure_of(const struct row *row, const struct repetition *repetition, int n,
                        const struct row *base_row, const struct repetition *base) {
  struct figure f = {.value = row->work,
                     .low = row->work,
                     .high = row->work,
                     .relative = row->work,
                     .ratio = NAN,
                     .repetitions = n};
  if (row->kind == COUNT) return f;
  double value[MOST_REPETITIONS], relative[MOST_REPETITIONS], ratio[MOST_REPETITIONS];
  for (int k = 0; k < n; k++) {
    double t = time_of(row, &repetition[k]);
    value[k] = value_of(row, t);
    relative[k] = value_of(row, t / repetition[k].calibration);
    ratio[k] = base ? value[k] / value_of(base_row, time_of(base_row, &base[k])) : NAN;
    f.time.cpu += repetition[k].time.cpu;
    f.time.wall += repetition[k].time.wall;
  }
  f.value = row->mean ? mean(value, n) : 0;
  f.relative = row->mean ? mean(relative, n) : median(relative, n);
  if (base) {
    f.ratio = median(ratio, n);
    f.ratio_low = quantile(ratio, n, 0.25);
    f.ratio_high = quantile(ratio, n, 0.75);
  }
  double middle = median(value, n);
  if (!row->mean) f.value = middle;
  f.low = quantile(value, n, 0.25);
  f.high = quantile(value, n, 0.75);
  return f;
}
