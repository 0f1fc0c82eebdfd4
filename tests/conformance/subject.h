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

// ---- path tracing ----
// Batches have seeds of their own, hashed from names, so that their means are independent.
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

// ---- photons ----
enum { PHOTON_REGIONS = 5 }; // the image and its quadrants

struct photon_plan {
  double radius;
  uint64_t n_emitted, iterations; // of each run
  int runs;
  const char *purpose;
};

struct region photon_region(const struct subject *, int number);

// Radius zero from radii r, r/2 and r/4 on the same photons: bias m1 r (edges) + m2 r^2 (inside)
// cancels. Each run is extrapolated, so the error comes from the runs.
void photons_extrapolate(const struct subject *, struct photon_plan, struct arena scratch,
                         struct estimate out[PHOTON_REGIONS]);

double subject_seconds(void); // of a clock that only goes forward

#endif
