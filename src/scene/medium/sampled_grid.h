// A field given by samples at the centres of nx x ny x nz cells of the unit cube, x fastest, as
// pbrt-v4's SampledGrid: trilinear between them, and zero where there is no sample, so that it
// falls to half of the outermost sample at a face of the cube, a quarter at an edge.
#ifndef SCENE_MEDIUM_SAMPLED_GRID_H
#define SCENE_MEDIUM_SAMPLED_GRID_H

#include "base/vec.h"

#include <stdint.h>

struct sampled_grid {
  int n[3];
  const float *value;
};

static inline double sampled_grid_at(const struct sampled_grid *grid, int x, int y, int z) {
  const int *n = grid->n;
  if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) return 0;
  return (double)grid->value[((int64_t)z * n[1] + y) * n[0] + x];
}

static inline double sampled_grid_lerp(double t, double a, double b) { return (1 - t) * a + t * b; }

static inline double sampled_grid_row(const struct sampled_grid *grid, double t, int x, int y,
                                      int z) {
  return sampled_grid_lerp(t, sampled_grid_at(grid, x, y, z), sampled_grid_at(grid, x + 1, y, z));
}

// p in the unit cube.
static inline double sampled_grid_lookup(const struct sampled_grid *grid, struct vec p) {
  const int *n = grid->n;
  double at[3] = {p.x * n[0] - 0.5, p.y * n[1] - 0.5, p.z * n[2] - 0.5}, t[3];
  int k[3];
  for (int i = 0; i < 3; i++) {
    double cell = floor(at[i]);
    t[i] = at[i] - cell;
    k[i] = (int)cell;
  }
  double y0z0 = sampled_grid_row(grid, t[0], k[0], k[1], k[2]);
  double y1z0 = sampled_grid_row(grid, t[0], k[0], k[1] + 1, k[2]);
  double y0z1 = sampled_grid_row(grid, t[0], k[0], k[1], k[2] + 1);
  double y1z1 = sampled_grid_row(grid, t[0], k[0], k[1] + 1, k[2] + 1);
  return sampled_grid_lerp(t[2], sampled_grid_lerp(t[1], y0z0, y1z0),
                           sampled_grid_lerp(t[1], y0z1, y1z1));
}

// Of the samples that a point between lo and hi may be interpolated from.
static inline double sampled_grid_largest(const struct sampled_grid *grid, const double lo[3],
                                          const double hi[3]) {
  int from[3], to[3];
  double most = 0;
  for (int i = 0; i < 3; i++) {
    double first = floor(lo[i] * grid->n[i] - 0.5), last = floor(hi[i] * grid->n[i] - 0.5) + 1;
    from[i] = first > 0 ? (int)first : 0;
    to[i] = last < grid->n[i] - 1 ? (int)last : grid->n[i] - 1;
  }
  for (int z = from[2]; z <= to[2]; z++)
    for (int y = from[1]; y <= to[1]; y++)
      for (int x = from[0]; x <= to[0]; x++) {
        double value = sampled_grid_at(grid, x, y, z);
        most = most < value ? value : most;
      }
  return most;
}

#endif
