// Moments of a whole film as an image.
#ifndef RUN_PICTURE_H
#define RUN_PICTURE_H

#include "image/image.h"
#include "integrator/integrator.h"
#include "moments/moments.h"

// R, G, B: means; variance.R, .G, .B: what `variance` says of the moments, NAN of fewer than two
// values. moments[point * n_channels + channel]; `measure` covers the film.
struct image picture_of(const struct measurement *measure, const struct moments *moments,
                        double (*variance)(struct moments), struct arena *);

#endif
