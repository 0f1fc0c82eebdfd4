// Independent runs of an integrator on a subject: the means of regions of the film, extrapolated to
// radius zero where there is a radius.
#ifndef TESTS_CONFORMANCE_RUNS_H
#define TESTS_CONFORMANCE_RUNS_H

#include "tests/conformance/subject.h"

// The image and its quadrants; the same without the pixels that see a surface in a mirror or
// through clear glass; and those pixels.
enum { AREAS = 5, UNMIRRORED = AREAS, MIRRORED = 2 * AREAS, REGIONS };

struct regions {
  uint16_t *in; // [n_points] bit r: the pixel belongs to region r
  int pixels[REGIONS];
};

struct regions regions_of(const struct subject *, struct arena *);

struct runs_plan {
  const struct integrator_type *type;
  enum direct direct;
  double radius, volume;          // the largest of three, on surfaces and in media; 0: the same
  uint64_t n_emitted, iterations; // of each run
  int first, runs;                // first + 1, ..., first + runs are their numbers
  const char *purpose;            // tells its seed from others
};

// Whether the integrator takes the scene, as an experiment would find it.
bool runs_accepted(const struct subject *, const struct runs_plan *, struct problem *);

// Radius zero from radii r, r/2 and r/4 on the same photons: bias m1 r (edges) + m2 r^2 (inside)
// cancels. The radii stay: the law is the integrator's own with alpha = 1. Each run is
// extrapolated, so the error comes from the runs.
void runs_measure(const struct subject *, const struct regions *, const struct runs_plan *,
                  struct arena scratch, struct estimate out[REGIONS]);

#endif
