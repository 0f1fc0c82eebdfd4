// The photon grid: who lies within r of a point. Cubic cells of edge r; the cell (x, y, z) is in
// the bucket of (x mod X, y mod Y, z mod Z), powers of two of at least 16 where the photons' box
// has as many cells. So the cells of a ball are in different buckets, those along x side by side,
// and what else is in one of them is too far away: the distance says so, no hash has to. Photons
// are copied in the order of buckets, by a stable counting sort, so that a query finds them in one
// order: cells by (z, y, x), within a cell as stored, whatever the number of buckets.
#ifndef DENSITY_GRID_H
#define DENSITY_GRID_H

#include "base/arena.h"
#include "base/problem.h"
#include "scene/scene.h"
#include "walk/photons.h"

struct grid {
  double r, inverse_edge;
  int n_channels;
  int deepest;                   // of their vertex[]
  int64_t lo[3], hi[3];          // cells of the photons' box
  double lo_cell[3], hi_cell[3]; // the same
  int bits[3];                   // X = 1 << bits[0], ...
  uint32_t *first;               // [X Y Z + 1] of each bucket's photons; x varies fastest
  int64_t count, capacity, bucket_capacity;
  // Sorted; GRID_ROOM more than there are photons.
  double *position[3], *wi[3], *flux[3];
  uint16_t *vertex;
  uint8_t *kind;
  uint32_t *photon; // their numbers before
  uint32_t *bucket; // scratch: by photon
};

// Whether r is resolved in a scene within these bounds: at least 100 times the spacing of floats at
// the largest coordinate (theory 7), or the density error of the vertices' rounding shows.
bool grid_radius_is_resolved(struct box bounds, double r, struct problem *);

// Sorts the photons; grows in the arena.
void grid_build(struct grid *, const struct photons *, double r, struct arena *);

enum { GRID_ROOM = 8 };

// Photons within r of p, r at most the grid's: their numbers among the sorted and their squared
// distances, in the grid's order. At most `count` of the photons there are; the arrays have
// GRID_ROOM more.
int grid_find(const struct grid *, struct vec p, double r, uint32_t *at, double *distance2);

static inline int64_t grid_buckets(const struct grid *grid) {
  return INT64_C(1) << (grid->bits[0] + grid->bits[1] + grid->bits[2]);
}

// Of what it holds.
static inline int64_t grid_bytes(const struct grid *grid) {
  size_t photon = (size_t)(6 + grid->n_channels) * sizeof(double) + 2 * sizeof(uint32_t) +
                  sizeof(uint16_t) + sizeof(uint8_t);
  return grid->count * (int64_t)photon + (grid_buckets(grid) + 1) * (int64_t)sizeof(uint32_t);
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
