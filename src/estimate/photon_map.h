// One iteration of a photon integrator: eye points, a photon pass, and the density estimates at the
// points. What the radii are and what is remembered between iterations is the integrator's.
//   photon_map_see -> photon_map_emit -> for each photon_map_tile: photon_map_gather at its points,
//   photon_map_add_seen
#ifndef ESTIMATE_PHOTON_MAP_H
#define ESTIMATE_PHOTON_MAP_H

#include "estimate/tile.h"

enum { PHOTON_MAP_FEW = 16 }; // points; then photons elsewhere are not worth sorting

// The photons of one kind, and what finds them.
struct photon_field {
  int d;
  struct photons photons;
  double *c; // [n_estimators] psi(0) of the kernel in d dimensions
  struct grid grid;
  struct knn tree;
  struct grid_seen seen;
  struct photon_filter filter; // by `seen`
};

struct photon_map {
  const struct measurement *measure;
  struct arena *arena;
  struct walk *walk;
  uint64_t run;
  uint64_t seen;           // the iteration whose eye pass this is
  struct eye_point *point; // [measure->n_points] where they are kept, else NULL
  struct tile tile;        // those at hand
  int sets;                // ppm: the points are this many sets, each of all pixels; else 1
  struct photon_field field[POINT_KINDS]; // the first measurement_kinds of them
  struct beams *beams;                    // where a pass leaves them in media; NULL: nobody asks
  bool any_radius; // the photons are in the fields' trees, else in their grids
  struct vec seen_point[PHOTON_MAP_FEW];
};

static inline enum point_kind eye_point_kind(const struct eye_point *point) {
  return point->volume ? IN_VOLUME : ON_SURFACE;
}

struct photon_map *photon_map_new(const struct measurement *, struct arena *);

// The eye pass of iteration i; i = 0: one before all iterations. Kept points are one tile, at hand
// from here on; others are traced when their tile is asked for.
void photon_map_see(struct photon_map *, uint64_t i);

// The points from `first` on that are at hand together; false: there are none left.
//   for (int first = 0; photon_map_tile(map, first); first += map->tile.n)
bool photon_map_tile(struct photon_map *, int first);

// The photons that gathers of radius up to r[kind] around the points may find, into the map's own;
// r[kind] = 0: nobody asks for them. Holds until the next call.
struct photon_sinks photon_map_sinks(struct photon_map *, const double r[POINT_KINDS]);

// The photon pass of iteration i, made ready for radii up to r[kind]; all INFINITY: for any, and
// for photon_map_nearest.
void photon_map_emit(struct photon_map *, uint64_t i, const double r[POINT_KINDS]);

// Adds the estimates at a point of the tile with radius r[e] of estimator e to
// frame[(e * n_points + point) * n_channels + c], and counts the photons in each disc (count: NULL
// or [n_estimators]).
void photon_map_gather(struct photon_map *, int point, const double *r, int64_t *count,
                       double *frame);

// The same from the k[e] nearest photons, where k[e] > 0, of a point on a surface.
void photon_map_nearest(struct photon_map *, int point, const int *k, double *frame);

// Of the stored photons and what finds them.
int64_t photon_map_bytes(const struct photon_map *);

// Adds what needs no photons, of the tile's points: tile_add_seen.
void photon_map_add_seen(struct photon_map *, uint64_t i, double *frame);

// Length of a frame.
static inline long photon_map_frame(const struct measurement *measure) {
  return (long)measure->n_estimators * measure->n_points * measure->features.n_channels;
}

#endif
