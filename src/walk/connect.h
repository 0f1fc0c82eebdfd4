// Next-event estimation for a batch: one light sample a point, one shadow ray each.
// Usage: connect_begin, connect_add for each point (or connect_ray), connect_finish.
#ifndef WALK_CONNECT_H
#define WALK_CONNECT_H

#include "walk/walk.h"

// A point that asks for direct light.
struct connection {
  const struct bsdf *bsdf;
  struct vec p;
  uint32_t primitive; // p is on it; PRIMITIVE_NONE: in a medium
  uint32_t medium;    // that the path arrived through; looked at only where there are media
  uint64_t path;      // whose random numbers its shadow ray uses there
  struct vec wo;      // towards the eye, unit length
  double weight[3];   // what the radiance scattered towards wo is multiplied with
  int owner;
};

void connect_begin(struct walk *);

// value = weight * f * cos * L / pdf. With `mis`, weighted by the balance heuristic against the
// material's own sampling (lights that no ray can hit keep their full weight). u_light chooses the
// light, u the point on it. At most WALK_BATCH points.
void connect_add(struct walk *, const struct connection *, double u_light, const double u[2],
                 bool mis);

// A shadow ray of one's own: `value` arrives if nothing is hit before `distance`.
void connect_ray(struct walk *, const struct ray *, double distance, const double value[3],
                 int owner);

// Adds what is not blocked to sum[owner * n_channels + c]. Surfaces that let rays pass attenuate.
void connect_finish(struct walk *, double *sum);

// The balance heuristic's weight of having met this emitter by the material's sampling, from p.
double connect_mis_weight(const struct scene *, const struct surface *emitter, struct vec p,
                          struct vec wi, double pdf);

// The same for the background of an infinite light.
double connect_mis_weight_background(const struct scene *, const struct light *, struct vec p,
                                     struct vec wi, double pdf);

#endif
