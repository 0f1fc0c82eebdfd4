// Next-event estimation for a batch: one light sample a path, one shadow ray each.
#ifndef WALK_CONNECT_H
#define WALK_CONNECT_H

#include "walk/walk.h"

// A point that asks for direct light.
struct connection {
  struct surface surface;
  struct vec wo;    // towards the eye, unit length
  double weight[3]; // what the radiance scattered towards wo is multiplied with
  int owner;
  uint64_t path;
};

// For each of n <= WALK_BATCH connections: value = weight * f * cos * L / pdf, unoccluded, added to
// sum[owner * n_channels + c]. With `mis`, weighted by the balance heuristic against the material's
// own sampling (lights that no ray can hit keep their full weight). Random numbers: the pairs
// VERTEX_LIGHT and VERTEX_EMITTER of `vertex`.
void connect_lights(struct walk *, const struct connection *, int n, int vertex, bool mis,
                    double *sum);

// The balance heuristic's weight of having met this emitter by the material's sampling, from p.
double connect_mis_weight(const struct scene *, const struct surface *emitter, struct vec p,
                          struct vec wi, double pdf);

#endif
