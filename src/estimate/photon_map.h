// One iteration of a photon integrator: eye points, a photon pass, and the density estimates at the
// points. What the radii are and what is remembered between iterations is the integrator's.
//   photon_map_see -> photon_map_emit -> photon_map_gather at each point -> photon_map_add_seen
#ifndef ESTIMATE_PHOTON_MAP_H
#define ESTIMATE_PHOTON_MAP_H

#include "density/gather.h"
#include "estimate/measurement.h"

enum { PHOTON_MAP_FEW = 16 }; // points; then photons elsewhere are not worth sorting

struct photon_map {
  const struct measurement *measure;
  struct arena *arena;
  struct walk *walk;
  uint64_t run;
  struct eye_point *point; // [measure->n_points]
  int sets;                // ppm: the points are this many sets, each of all pixels; else 1
  struct photons photons;
  double *c;       // [n_estimators] psi(0) of the kernel
  bool any_radius; // the photons are in `tree`, else in `grid`
  struct grid grid;
  struct knn tree;
  struct gather gather;
  struct disc *disc; // [n_estimators] scratch
  struct grid_seen seen;
  struct photon_filter filter; // by `seen`
  struct vec seen_point[PHOTON_MAP_FEW];
  double *direct; // [n_points * n_channels], next-event estimation only
};

struct photon_map *photon_map_new(const struct measurement *, struct arena *);

// The eye pass of iteration i; i = 0: one before all iterations.
void photon_map_see(struct photon_map *, uint64_t i);

// Which photons a gather of radius up to r around the points may find; NULL: any. Holds until the
// next call.
const struct photon_filter *photon_map_filter(struct photon_map *, double r);

// The photon pass of iteration i, made ready for radii up to r; INFINITY: for any, and for
// photon_map_nearest.
void photon_map_emit(struct photon_map *, uint64_t i, double r);

// Adds the estimates at a point with radius r[e] of estimator e to
// frame[(e * n_points + point) * n_channels + c], and counts the photons in each disc (count: NULL
// or [n_estimators]).
void photon_map_gather(struct photon_map *, int point, const double *r, int64_t *count,
                       double *frame);

// The same from the k[e] nearest photons, where k[e] > 0.
void photon_map_nearest(struct photon_map *, int point, const int *k, double *frame);

// Of the stored photons and what finds them.
int64_t photon_map_bytes(const struct photon_map *);

// Adds what needs no photons: emission seen by the points, and their direct light where it is left
// to next-event estimation (random in iteration i).
void photon_map_add_seen(struct photon_map *, uint64_t i, double *frame);

// Length of a frame.
static inline long photon_map_frame(const struct measurement *measure) {
  return (long)measure->n_estimators * measure->n_points * measure->features.n_channels;
}

#endif
