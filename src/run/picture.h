// Moments of a whole film as an image.
#ifndef RUN_PICTURE_H
#define RUN_PICTURE_H

#include "image/image.h"
#include "integrator/integrator.h"
#include "moments/moments.h"

// Planes R, G, B, variance.R, .G, .B, to be filled; `measure` covers the film.
struct image picture_new(const struct measurement *measure, struct arena *);

// Means and variances, NAN of fewer than two values. moments[point * n_channels + channel].
struct image picture_of(const struct measurement *measure, const struct moments *moments,
                        struct arena *);

#endif
