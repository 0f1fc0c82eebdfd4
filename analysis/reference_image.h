// What images are compared with, and how far it may be off itself: a picture over several runs by
// an estimator without bias, or by photons at fixed radii r, 2 r and 4 r, extrapolated to none.
#ifndef ANALYSIS_REFERENCE_IMAGE_H
#define ANALYSIS_REFERENCE_IMAGE_H

#include "image/image.h"

// Errors are relative mean square ones, as `relmse` of image_error.h, of the reference itself.
struct reference_image {
  struct image image; // R, G, B
  double noise;       // expected from the spread over its runs
  double bias;        // at most about this much
};

// A moment image: means over independent runs (at least 2), and variances of one.
struct moment_image {
  const struct image *image;
  double runs;
  const char *name; // for problems
};

bool reference_image_unbiased(const struct moment_image *, struct arena *, struct reference_image *,
                              struct problem *);

// at[3]: of radii r, 2 r, 4 r, all independent of each other. A bias in proportion to r^2 goes away
// in e(r) = (4 x(r) - x(2 r)) / 3. What is left shows in e(r) - e(2 r): where light is smooth it is
// far smaller, and where discs cross edges half as many pixels (in proportion to r) have as large a
// bias in e(r) as in e(2 r). Next to an edge both have theirs in common, so that e(r)'s mean square
// is 1.5 times (box; Epanechnikov: 1.7) the difference's of a straight edge. Twice is on the safe
// side.
bool reference_image_extrapolated(const struct moment_image at[3], struct arena *,
                                  struct reference_image *, struct problem *);

#endif
