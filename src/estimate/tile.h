// A few eye points, and what a thread needs to see them, to gather around them and to connect them
// to lights. Where every iteration sees new points none outlives its tile: memory does not grow
// with the picture, and what a point needs is still in the cache when it is gathered.
#ifndef ESTIMATE_TILE_H
#define ESTIMATE_TILE_H

#include "density/gather.h"
#include "estimate/measurement.h"
#include "walk/eye.h"

enum { TILE_POINTS = 2048 };

struct tile {
  const struct measurement *measure;
  struct walk *walk;
  int first, n;            // the points of pixels first..first + n - 1
  struct eye_point *point; // [n]
  struct eye_point *room;  // [TILE_POINTS], where they are not kept elsewhere; else NULL
  struct gather gather;
  struct disc *disc; // [n_estimators] scratch
  double *direct;    // [WALK_BATCH * n_channels] scratch of next-event estimation; NULL: none
};

// Whether the points of a whole eye pass stay: they serve later iterations (or whoever asks for
// them), or they are few.
static inline bool measurement_keeps_points(const struct measurement *measure) {
  return measure->keep_points || measurement_is_static(measure) || measure->n_points <= TILE_POINTS;
}

struct tile tile_new(const struct measurement *, struct walk *, struct arena *);

// Random numbers of iteration i.
void tile_begin(struct tile *, uint64_t run, enum rng_purpose, uint64_t i);

// Traces the points of pixels first..first + n - 1, n <= TILE_POINTS, into the tile's own room.
void tile_see(struct tile *, uint64_t run, uint64_t i, int first, int n);

// The points are these, which are kept elsewhere.
void tile_take(struct tile *, struct eye_point *kept, int first, int n);

static inline const struct eye_point *tile_point(const struct tile *tile, int j) {
  return &tile->point[j - tile->first];
}

// Adds to frame[(e * n_points + j) * n_channels + c] what needs no photons: emission seen by the
// tile's points, and their direct light where it is left to next-event estimation (random in
// iteration i). Points of ppm are `sets`, each of all pixels; else 1.
void tile_add_seen(struct tile *, uint64_t run, uint64_t i, int sets, double *frame);

#endif
