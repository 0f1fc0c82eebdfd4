// The photon pass: paths from the lights, stored where they meet surfaces and collide in media.
#ifndef WALK_PHOTONS_H
#define WALK_PHOTONS_H

#include "walk/beams.h"

// Stored photons in the order of (batch, vertex, path), which no thread count can change.
struct photons {
  int64_t count, capacity;
  int n_channels;
  struct vec *position;
  struct vec *wi;   // towards where it came from, unit length
  double *flux[3];  // W, not divided by n_emitted; in media W x scene unit: see photon_sinks.volume
  uint16_t *vertex; // scatterings on its way; 65535 for more
  uint8_t *kind;    // enum light_path: what an eye that looks here completes
};

// Of what it holds.
static inline int64_t photons_bytes(const struct photons *photons) {
  return photons->count *
         (2 * (int64_t)sizeof(struct vec) + (int64_t)(sizeof(uint16_t) + sizeof(uint8_t)) +
          photons->n_channels * (int64_t)sizeof(double));
}

struct photon_pass {
  uint64_t n_emitted;
  int depth;        // pbrt's maxdepth: the most scatterings, the one towards the eye included
  int first_vertex; // 1: the first surface is left to next-event estimation; else 0
  uint64_t first;   // paths before are left out: a multiple of WALK_BATCH, so that parts of a pass
                    // put together are the pass
  bool past_last;   // a direction is drawn after the last vertex, too, and nobody follows it
};

// Which photons are worth storing (NULL: all). A pure function of the position that keeps every
// photon anybody can see: what it drops changes no estimate.
struct photon_filter {
  bool (*keep)(const void *data, struct vec p);
  const void *data;
};

// Emission of the paths walk->path[0..n - 1]: one ray each, with the flux that the choice of its
// light leaves it.
void photons_emit(struct walk *);

// The medium in which a photon begins that the light emits along this ray.
uint32_t photons_start_in(const struct scene *, const struct light *, const struct ray *);

// Where photons go: emptied first, grown in the arena. Zeroed photons are ready for use.
struct photon_sink {
  struct photons *photons; // NULL: nobody asks
  const struct photon_filter *filter;
};

struct photon_sinks {
  struct photon_sink surface;
  // At every collision in a medium, scattered afterwards or absorbed: flux over the density of
  // collisions there, so that what is estimated is the density of fluence, smooth also where
  // sigma_t is not. The radiance scattered towards w is
  //   sigma_s(x) / n_emitted * sum k_r(x_p - x) f(w, w_p) flux_p,
  // k_r in scene units^-3 (theory 1.1, with sigma_t of each photon's own place).
  struct photon_sink volume;
  struct beams *beams; // emptied first, grown in the arena; NULL: nobody asks (walk/beams.h)
};

// One pass: walk->key and walk->iteration are set by the caller.
void photons_trace(struct walk *, const struct photon_pass *, const struct photon_sinks *,
                   struct arena *);

// Puts the photons of another part of the pass behind these.
void photons_append(struct photons *, const struct photons *more, struct arena *);

#endif
