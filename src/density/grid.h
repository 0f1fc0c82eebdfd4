// The photon grid: who lies within r of a point. Cubic cells of edge r, hashed into buckets, filled
// by a stable counting sort, so that a query finds photons in one order: cells by (z, y, x), within
// a cell as stored. A photon of another cell that shares the bucket is told apart by its cell, so
// no photon is ever found twice.
#ifndef DENSITY_GRID_H
#define DENSITY_GRID_H

#include "base/arena.h"
#include "base/problem.h"
#include "scene/scene.h"
#include "walk/photons.h"

// Numbers of cells modulo 2^32: of two cells with the same numbers one is too far from any point to
// matter, and the distance says which. So any coordinate has a cell.
struct grid_cell {
  uint32_t x, y, z;
};

struct grid {
  double r, inverse_edge;
  uint32_t mask;   // buckets - 1, a power of two
  uint32_t *first; // [mask + 2] of each bucket's photons
  int64_t count, capacity;
  uint32_t bucket_capacity;
  struct vec *position;   // sorted
  struct grid_cell *cell; // of each sorted photon
  uint32_t *photon;       // its number in struct photons
  uint32_t *bucket;       // scratch: by photon
};

// Whether r is resolved in a scene within these bounds: at least 100 times the spacing of floats at
// the largest coordinate (theory 7), or the density error of the vertices' rounding shows.
bool grid_radius_is_resolved(struct box bounds, double r, struct problem *);

// Sorts the photons; grows in the arena.
void grid_build(struct grid *, const struct photons *, double r, struct arena *);

// Photons within r of p, r at most the grid's: their numbers in struct photons and squared
// distances, in the grid's order. At most `count` of the photons there are.
int grid_find(const struct grid *, struct vec p, double r, uint32_t *photon, double *distance2);

// Of what it holds.
static inline int64_t grid_bytes(const struct grid *grid) {
  return grid->count *
             (int64_t)(sizeof(struct vec) + sizeof(struct grid_cell) + 2 * sizeof(uint32_t)) +
         ((int64_t)grid->mask + 2) * (int64_t)sizeof(uint32_t);
}

// The cells that the ball of radius r around any of n points meets, as a filter for photons_trace.
// Conservative: it may keep more, never less, than what a query around these points can find.
struct grid_seen {
  double inverse_edge;
  uint64_t bit[1024];
};
void grid_seen_mark(struct grid_seen *, const struct vec *p, int n, double r);
bool grid_seen_keep(const void *seen, struct vec p); // photon_filter.keep

#endif
