// What the parts measure: whole films of 256 x 256 at pixel footprints, 65,536 photons emitted an
// iteration, radius 0.05, depth 64, as the peers of the performance scenes were timed.
#ifndef TESTS_BENCH_MEASURE_H
#define TESTS_BENCH_MEASURE_H

#include "estimate/reference_radius.h"
#include "integrator/integrator.h"
#include "tests/bench/bench.h"

enum { PHOTONS = 65536, DEPTH = 64 };

// By the estimator at alpha = 2/3 with a box.
struct measurement measure_of(const struct bench_scene *, bool nee);
// With a law the integrator takes.
void measure_set_law(struct measurement *, const struct integrator_type *, struct arena *);

// An integrator at work: iterations i = next, next + 1, ...
struct steps {
  const struct integrator_type *integrator;
  struct measurement measure;
  void *state;
  double *frame;
  long size;
  uint64_t next;
  int each; // iterations of a repetition
};
struct steps *steps_new(const char *integrator, struct measurement, struct arena *);
void steps_run(void *steps, int repetition); // row.body
uint64_t steps_hash(const void *steps);      // of the last frame

// Dies unless iterations 1 and 2 give the same bytes to another who computes them by `threads`, or
// (iterations that are independent) in the other order.
void steps_check(const struct steps *, int threads, const char *name);

#endif
