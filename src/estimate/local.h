// Local statistics (Hachisuka, Ogaki, Jensen 2008): each point of each estimator has a radius and a
// count of its own, which only the photons found there change. The flux rule tau (r'^2 / r^2) makes
// the estimate the average of what each pass alone estimates (theory 2.4), so a pass gives just
// that.
//
// Points on surfaces and in media have statistics apart, r^2 and r^3 under the same rule: where a
// pixel sees now the one and now the other, each counts the passes in which it was seen.
//
// A pass works in parallel on measure->threads: photons by batches, points apart. Nothing a thread
// does depends on how many there are, and a point's sums on no other point, so neither does a bit.
#ifndef ESTIMATE_LOCAL_H
#define ESTIMATE_LOCAL_H

#include "estimate/photon_map.h"

// Grids of edge r1, r1/2, r1/4, ... (r1: the largest of the estimators); a point asks the finest
// that is not below its radius.
enum { LOCAL_LEVELS = 15 };

// Of the points of one kind, which have d dimensions.
struct local_field {
  int d;
  double *rd, *n; // [point * n_estimators + estimator] r^d, and the photons counted
  bool used[LOCAL_LEVELS];
  struct grid grid[LOCAL_LEVELS];
};

struct local {
  struct photon_map *map;
  struct local_field field[POINT_KINDS]; // the first measurement_kinds of them
  unsigned char *kind;                   // [point] enum point_kind of the one last seen
  bool fixed, seen;                      // every eye pass is the same; there was one
  int n_workers;
  struct local_worker *worker;
};

struct local *local_new(const struct measurement *, struct arena *);
void local_begin(struct local *, uint64_t run);

// The eye pass of iteration i; 0: one before all iterations, for each of the map's sets. Points
// that are not kept are traced by local_pass, a tile after the other.
void local_see(struct local *, uint64_t i);

// Photon pass i around the points, its estimates into the frame, then the law. A law without
// local statistics follows i alone.
void local_pass(struct local *, uint64_t i, double *frame);

// Of an estimator at a point as it stands.
double local_radius(const struct local *, int point, int estimator);

// Of the photons of the last pass and the grids that find them.
int64_t local_bytes(const struct local *);

#endif
