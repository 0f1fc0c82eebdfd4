// Free flight through media, unbiased in any: collisions are sampled with a density that is nowhere
// below sigma_t, and are real with the probability that it exceeds (delta tracking, Woodcock et al.
// 1965), channels weighted so that the paths of all are the same (Kutz et al. 2017); a shadow ray
// is attenuated by the expected share of what is real (ratio tracking, Novak et al. 2014), or in
// closed form where the medium is uniform. What no medium needs is not drawn.
#ifndef WALK_FLIGHT_H
#define WALK_FLIGHT_H

#include "walk/walk.h"

// Flies path j to its hit. Where it collides before, hit and collision say so; where not, its
// throughput is what is left.
void flight_path(struct walk *, int j);

// The same for all paths.
void flight_all(struct walk *);

// Multiplies value[c] by the transmittance along `distance` of a ray in this medium (not
// MEDIUM_NONE). flights: random numbers used by the shadow ray since `vertex`.
void flight_shadow(const struct walk *, uint32_t medium, const struct ray *, double distance,
                   uint64_t path, int vertex, uint32_t *flights, double value[3]);

// The same for a ray that the eye looks along: adds to emitted[c] the medium's emission on the way,
// weighted with what is left of value[c] there. NULL: nobody asks.
void flight_along(const struct walk *, uint32_t medium, const struct ray *, double distance,
                  uint64_t path, int vertex, uint32_t *flights, double value[3], double *emitted);

#endif
