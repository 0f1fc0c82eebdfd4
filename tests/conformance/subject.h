// A scene to be judged, and our renders of it in independent parts.
#ifndef TESTS_CONFORMANCE_SUBJECT_H
#define TESTS_CONFORMANCE_SUBJECT_H

#include "run/plan.h"
#include "tests/conformance/compare.h"

struct subject {
  const char *name;
  struct scene scene;
  struct measurement measure; // the whole film, with the file's depth and pixel footprint
};

bool subject_load(const char *name, const char *path, struct arena *, struct subject *,
                  struct problem *);

// Of a name, so that the means of different purposes and numbers are independent.
uint64_t subject_seed(const struct subject *, const char *purpose, int number,
                      struct arena scratch);

void subject_stop_if_interrupted(void); // the process ends

// ---- path tracing ----
// Batches have seeds of their own.
struct batches {
  int n;
  uint64_t samples; // a pixel, over all batches
  struct image *image;
  double seconds;
};

// `purpose` tells the seeds of one use from another's. Interrupted: the process ends.
struct batches batches_render(const struct subject *, const char *purpose, int n,
                              uint64_t samples_each, struct arena *);
struct image batches_mean(const struct batches *, struct arena *);

// Over batches first, first + step, ...
struct estimate batches_region(const struct batches *, struct region, int first, int step,
                               struct arena scratch);

double subject_seconds(void); // of a clock that only goes forward

#endif
