// An integrator computes one iteration: one frame of values, for every cell and point of a group.
// The loop belongs to the caller: begin a run, step i = 1, 2, ..., read the frame.
// One file each in this folder; the build collects the rows.
#ifndef INTEGRATOR_INTEGRATOR_H
#define INTEGRATOR_INTEGRATOR_H

#include "base/arena.h"
#include "bvh/bvh.h"
#include "density/kernel.h"
#include "density/law.h"
#include "scene/scene.h"
#include "scene/skip.h"

#include <stdbool.h>
#include <stdint.h>

// One estimator on the shared photons.
struct estimator {
  const struct kernel *kernel;
  const struct law *law;
  double alpha;
  double r1; // support at i = 1, scene units
};

// What determines the paths, and the estimators that share them.
struct measurement {
  const struct scene *scene;
  const struct bvh *bvh;
  struct features features;
  const struct pixel *pixel; // [n_points] what is measured: a few probes or a whole image
  int n_points;
  int n_replicas;     // path: this many points in a row are samples of one pixel, each with
                      // random numbers of its own; at least 1
  bool footprint;     // a new uniform position in the pixel each iteration, else its centre
  bool nee;           // direct light by next-event estimation instead of photons
  int depth;          // pbrt's maxdepth
  uint64_t n_emitted; // photon paths per iteration
  uint64_t seed;
  const struct estimator *estimator;
  int n_estimators;
  unsigned skip_off; // bits of enum skip: what is not to be skipped
};

struct integrator_type {
  const char *name, *about, *source;
  bool photons;     // uses kernel, law, radius and photons
  bool independent; // iterations are independent of each other: any order, any split
  // State for one thread. The measurement must outlive it.
  void *(*create)(const struct measurement *, struct arena *);
  void (*begin)(void *state, uint64_t run); // k = 1, 2, ...; references take 0
  // frame[(estimator * n_points + point) * n_channels + channel]: radiance (W sr^-1 m^-2) this
  // iteration alone estimates.
  void (*step)(void *state, uint64_t i, double *frame);
};

extern const struct integrator_type *const integrator_types[]; // NULL-terminated
const struct integrator_type *integrator_find(const char *name);

#endif
