#include "density/grid_level.h"
#include "numeric/lanes.h"

// Three vectors hold LANES positions, x y z x y z ...
static void bound(const struct vec *position, int64_t n, double lo[3], double hi[3]) {
  const double *x = (const double *)position;
  lanes least[3], most[3];
  double at_lanes[2][3 * LANES];
  int64_t j = 0;
  for (int v = 0; v < 3; v++) least[v] = lanes_set(INFINITY), most[v] = lanes_set(-INFINITY);
  for (; j + LANES <= n; j += LANES)
    for (int v = 0; v < 3; v++) {
      lanes a = lanes_load(x + 3 * j + v * LANES);
      least[v] = lanes_min(a, least[v]);
      most[v] = lanes_max(a, most[v]);
    }
  for (int v = 0; v < 3; v++) {
    lanes_store(&at_lanes[0][v * LANES], least[v]);
    lanes_store(&at_lanes[1][v * LANES], most[v]);
  }
  for (int k = 0; k < 3 * LANES; k++) {
    if (at_lanes[0][k] < lo[k % 3]) lo[k % 3] = at_lanes[0][k];
    if (at_lanes[1][k] > hi[k % 3]) hi[k % 3] = at_lanes[1][k];
  }
  for (int64_t k = 3 * j; k < 3 * n; k++) {
    if (x[k] < lo[k % 3]) lo[k % 3] = x[k];
    if (x[k] > hi[k % 3]) hi[k % 3] = x[k];
  }
}

// Of the cell's distance from the box's first one; 0 of no number.
static inline lanes_numbers wrapped(const struct grid *grid, int k, lanes x) {
  lanes cell = lanes_floor(x * lanes_set(grid->inverse_edge)) - lanes_set((double)grid->lo[k]);
  return lanes_to_numbers(lanes_max(cell, lanes_set(0))) & ((1u << grid->bits[k]) - 1);
}

static inline lanes_numbers bucket_of(const struct grid *grid, const double *position) {
  lanes p[3];
  lanes_load_triples(position, p);
  lanes_numbers row = wrapped(grid, 2, p[2]) << grid->bits[1] | wrapped(grid, 1, p[1]);
  return row << grid->bits[0] | wrapped(grid, 0, p[0]);
}

static void buckets(const struct grid *grid, const struct vec *position, int64_t n,
                    uint32_t *bucket) {
  struct vec last[LANES];
  int64_t j = 0;
  for (; j + LANES <= n; j += LANES) {
    lanes_numbers of = bucket_of(grid, &position[j].x);
    __builtin_memcpy(bucket + j, &of, sizeof of);
  }
  if (j == n) return;
  for (int k = 0; k < LANES; k++) last[k] = position[j + k < n ? j + k : j];
  lanes_numbers of = bucket_of(grid, &last->x);
  __builtin_memcpy(bucket + j, &of, (size_t)(n - j) * sizeof *bucket);
}

// What is within r is moved to the front and stored.
static int within(const struct grid *grid, const struct grid_range *range, int n, struct vec p,
                  double r2, uint32_t *at, double *distance2) {
  const double *x = grid->position[0], *y = grid->position[1], *z = grid->position[2];
  int found = 0;
  for (int k = 0; k < n; k++)
    for (int64_t j = range[k].begin, end = range[k].end; j < end; j += LANES) {
      lanes dx = lanes_load(x + j) - lanes_set(p.x), dy = lanes_load(y + j) - lanes_set(p.y),
            dz = lanes_load(z + j) - lanes_set(p.z);
      lanes d2 = dx * dx + dy * dy + dz * dz;
      lanes_some in = lanes_and(lanes_less(d2, lanes_set(r2)), lanes_first((int)(end - j)));
      lanes_pack(in, distance2 + found, d2);
      lanes_pack_numbers(in, at + found, (uint32_t)j);
      found += lanes_count(in);
    }
  return found;
}

const struct grid_level SIMD_NAME(grid_level) = {bound, buckets, within};
