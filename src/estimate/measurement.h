// What is measured: the points, what determines their paths, and the estimators that share them.
#ifndef ESTIMATE_MEASUREMENT_H
#define ESTIMATE_MEASUREMENT_H

#include "bvh/bvh.h"
#include "density/kernel.h"
#include "density/law.h"
#include "scene/scene.h"
#include "scene/skip.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

// Where an eye point is: on a surface, or in a medium. Photons of each kind are kept apart.
enum point_kind { ON_SURFACE, IN_VOLUME, POINT_KINDS };
static const int point_dimension[POINT_KINDS] = {2, 3};

// One estimator on the shared photons.
struct estimator {
  const struct kernel *kernel;
  const struct law *law;
  double alpha;
  double r1;        // support at i = 1, in units of the reference radius; without one, scene units
  double r1_volume; // of points in media; 0: r1
  const struct reference_radius *reference; // NULL: global
  int k; // nearest photons of the reference radius, or of a photon map's estimate; 0: none
};

static inline double estimator_r1(const struct estimator *estimator, enum point_kind kind) {
  bool own = kind == IN_VOLUME && estimator->r1_volume > 0;
  return own ? estimator->r1_volume : estimator->r1;
}

// What determines the paths, and the estimators that share them.
struct measurement {
  const struct scene *scene;
  const struct bvh *bvh;
  struct features features;
  const struct pixel *pixel; // [n_points] what is measured: a few probes or a whole image
  int n_points;
  int n_replicas;     // path: this many points in a row are samples of one pixel, each with
                      // random numbers of its own; at least 1
  int hit_points;     // ppm: this many points of one eye pass a pixel; 0: one
  bool footprint;     // a new uniform position in the pixel each iteration, else its centre
  bool nee;           // direct light by next-event estimation instead of photons
  bool keep_points;   // all eye points of an iteration stay for who asks for them afterwards
  int depth;          // pbrt's maxdepth
  uint64_t n_emitted; // photon paths per iteration
  uint64_t seed;
  const struct estimator *estimator;
  int n_estimators;
  unsigned skip_off; // bits of enum skip: what is not to be skipped
  unsigned left_out; // bits of enum light_path: what is not to be seen; 0: all is
  int threads;       // that one iteration may use, where iterations depend on each other; 0: one
};

// Whether all iterations see the same points.
static inline bool measurement_is_static(const struct measurement *measure) {
  return !measure->footprint && !measure->features.random_eye &&
         !(measure->skip_off & SKIP_STATIC_EYE);
}

// The kinds there are, from the first: without media only surfaces.
static inline int measurement_kinds(const struct measurement *measure) {
  return measure->features.media ? POINT_KINDS : ON_SURFACE + 1;
}

// Kernel, law and radius mean nothing to some integrators: all estimators get the first one's
// frame.
static inline void measurement_copy(const struct measurement *measure, double *frame) {
  long size = (long)measure->n_points * measure->features.n_channels;
  for (int e = 1; e < measure->n_estimators; e++)
    memcpy(frame + e * size, frame, (size_t)size * sizeof *frame);
}

#endif
