// How far an image is from its reference. Means over the pixels and the channels R, G, B of, x the
// image's value and r the reference's,
//   mse     (x - r)^2                     radiance^2
//   relmse  (x - r)^2 / (r^2 + 0.01)      relative mean square error (Rousselle et al. 2012)
//   smape   |x - r| / (|x| + |r|)         symmetric mean absolute error, in [0, 1]; 0 where both
//   are 0
// No pixel is left out or clamped. Pixels of one image share photons, so a spread over pixels says
// nothing of how well a metric is known: that takes several images of independent runs
// (theory 4.8).
#ifndef ANALYSIS_IMAGE_ERROR_H
#define ANALYSIS_IMAGE_ERROR_H

#include "image/image.h"

enum { IMAGE_MSE, IMAGE_RELMSE, IMAGE_SMAPE, IMAGE_METRICS };
struct image_metric {
  const char *name, *definition;
  double (*of)(double x, double r);
};
extern const struct image_metric image_metrics[IMAGE_METRICS];

// value[IMAGE_METRICS]. Names are for problems: other sizes, no R, G, B (or Y), a value that is not
// finite.
bool image_error(const struct image *, const char *name, const struct image *reference,
                 const char *reference_name, double *value, struct problem *);

#endif
