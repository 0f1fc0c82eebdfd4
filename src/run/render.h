// One picture: photonlab render. The mean over iterations of one run of an integrator on all
// pixels.
#ifndef RUN_RENDER_H
#define RUN_RENDER_H

#include "image/image.h"
#include "run/plan.h"

// `measure` covers the film, one estimator. R, G, B: the mean over `iterations`. variance.*: of
// that mean, from the differences between iterations, so with a shrinking radius too large by what
// their biases differ, and with iterations that depend on each other without what they share (ppm:
// its points). The same bits for any number of threads. False: interrupted, nothing made.
bool render_image(const struct integrator_type *, const struct measurement *, uint64_t iterations,
                  struct run_options, struct arena *, struct image *);

#endif
