// Reference radii (Knaus, Zwicker 2011): the radius of iteration i at a point is what the law says
// times a reference radius of the point, which no iteration's photons may change. To add one, add a
// row in reference_radius.c; nothing else knows one.
#ifndef ESTIMATE_REFERENCE_RADIUS_H
#define ESTIMATE_REFERENCE_RADIUS_H

#include "estimate/photon_map.h"

struct radii;

struct reference_radius {
  const char *name, *about, *source;
  bool global;        // 1 at all points: radii are in scene units
  bool nearest;       // takes k
  bool differentials; // eye paths carry them
  // Of a point, scene units. Where it is 0 or infinite the point has no disc and its estimate is
  // 0: see density/gather.h.
  double (*at)(struct radii *, const struct eye_point *, int k);
};

extern const struct reference_radius reference_radii[]; // the first is global
extern const int n_reference_radii;

// The reference radii of a map's points, for each estimator.
struct radii {
  struct photon_map *map;
  struct arena *arena;
  bool global;   // of all estimators
  double *value; // [points * n_estimators] of the map's tile
  double *r;     // scratch, [n_estimators]
  bool drawn;    // the photons of the first pass
  struct photons photons;
  struct knn tree;
  struct gather gather;
};

// Before the map's first eye pass.
struct radii radii_new(struct photon_map *, struct arena *);

// Of the points of the map's tile.
void radii_set(struct radii *);

// r[e] times the reference radius of estimator e at a point of the tile; valid until the next call.
const double *radii_scale(struct radii *, int point, const double *r);

// Of the photons of the first pass and what finds them.
int64_t radii_bytes(const struct radii *);

#endif
