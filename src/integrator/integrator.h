// An integrator computes one iteration: one frame of values, for every cell and point of a group.
// The loop belongs to the caller: begin a run, step i = 1, 2, ..., read the frame.
// One file each in this folder; the build collects the rows.
#ifndef INTEGRATOR_INTEGRATOR_H
#define INTEGRATOR_INTEGRATOR_H

#include "estimate/measurement.h"

#include <stdbool.h>
#include <stdint.h>

struct local; // estimate/local.h

struct integrator_type {
  const char *name, *about, *source;
  bool photons;     // uses kernel, law, radius and photons
  bool independent; // iterations are independent of each other: any order, any split; else
                    // i = 1, 2, ... after begin
  const char *law; // the default; NULL: knaus-zwicker
  bool one_eye_pass; // eye points are drawn once a run and stay
  bool blind_to_mirrored; // leaves out surfaces seen in mirrors and through clear glass
  bool takes_reference; // reference radii other than global
  bool takes_k;         // the k nearest photons instead of a radius
  bool only_photons;    // direct light too: no next-event estimation
  bool fixed;           // all iterations have the same radius: no law but fixed
  int volume_dimension; // of its kernels in media: 3 of points, 1 of beams; 0: it has none there
  // Whether it can measure the scene, at pixel footprints or centres; else a problem. NULL: any.
  bool (*accepts)(const struct scene *, bool footprint, struct problem *);
  // State for one thread. The measurement must outlive it.
  void *(*create)(const struct measurement *, struct arena *);
  void (*begin)(void *state, uint64_t run); // k = 1, 2, ...; references take 0
  // frame[(estimator * n_points + point) * n_channels + channel]: radiance (W sr^-1 m^-2) this
  // iteration alone estimates.
  void (*step)(void *state, uint64_t i, double *frame);
  // Of the photons of the last step and what finds them; NULL: none are stored.
  int64_t (*bytes)(const void *state);
  // The points' own radii, of the next step; NULL: it keeps none. Of several points a pixel the
  // first set comes first, in the order of the measured pixels.
  const struct local *(*local)(const void *state);
};

extern const struct integrator_type *const integrator_types[]; // NULL-terminated
const struct integrator_type *integrator_find(const char *name);

#endif
