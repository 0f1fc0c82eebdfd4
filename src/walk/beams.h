// Photon beams (Jarosz, Nowrouzezahrai, Sadeghi, Jensen 2011): where photons flew through media. A
// beam is the piece of a photon's ray that it has flown, with the flux it had there ("short"
// beams): the density of (flux times length) is, on average, the fluence [W m^-2], in any medium,
// so that beams carry no transmittance.
#ifndef WALK_BEAMS_H
#define WALK_BEAMS_H

#include "walk/walk.h"

struct photon_beam {
  struct vec o, d; // d of unit length, where the photon went
  double length;   // finite
  uint16_t vertex; // scatterings on its way; 65535 for more
  uint8_t kind;    // enum light_path: what an eye that looks here completes
};

// In the order of (batch, vertex, path, distance), which no thread count can change.
struct beams {
  int64_t count, capacity;
  int n_channels;
  struct photon_beam *beam;
  double *flux[3]; // W, not divided by n_emitted
  int first_vertex;
  struct arena *arena;
  int last_path; // of the walk, and where on its ray the last beam ends
  double last_end;
};

// From here to beams_end the beams of all paths of the walk are stored. Where a medium is uniform
// and scatters nothing there are none (they may have no end).
void beams_begin(struct beams *, struct walk *, int first_vertex, struct arena *);
void beams_end(struct walk *);

// Of what it holds.
static inline int64_t beams_bytes(const struct beams *beams) {
  return beams->count *
         ((int64_t)sizeof(struct photon_beam) + beams->n_channels * (int64_t)sizeof(double));
}

#endif
