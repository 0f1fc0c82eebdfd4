#include "density/grid.h"

#include "density/grid_level.h"

#include <assert.h>
#include <float.h>
#include <string.h>

static const double last_cell = 0x1p62;

// Floor, not truncation: cells below zero are as wide as the others. (Without SSE4.1 floor is a
// call.) In a medium without end photons may lie anywhere: beyond 2^62 cells, where doubles are
// farther apart than cells are wide, all are in the last one.
static int64_t cell_coordinate(double x, double inverse_edge) {
  double scaled = x * inverse_edge;
  scaled = scaled < last_cell ? scaled : last_cell;
  scaled = scaled > -last_cell ? scaled : -last_cell;
  int64_t truncated = (int64_t)scaled;
  return truncated - (scaled < (double)truncated);
}

// The cells of a ball, from lo to hi in each coordinate. A point within r of p differs by at most r
// in each, rounding included: d2 < r2 implies |dx| <= r (1 + 2 eps), so the corners are taken from
// a box that is wider than that.
struct cells {
  int64_t lo[3], hi[3];
};

static struct cells cells_around(struct vec p, double r, double inverse_edge) {
  double reach = r * (1 + 4 * DBL_EPSILON), at[3] = {p.x, p.y, p.z};
  struct cells cells;
  for (int k = 0; k < 3; k++) {
    cells.lo[k] = cell_coordinate(at[k] - reach, inverse_edge);
    cells.hi[k] = cell_coordinate(at[k] + reach, inverse_edge);
  }
  return cells;
}

bool grid_radius_is_resolved(struct box bounds, double r, struct problem *problem) {
  double largest = 0;
  for (int k = 0; k < 3; k++) {
    double lo = fabs((double)bounds.lo[k]), hi = fabs((double)bounds.hi[k]);
    largest = largest < lo ? lo : largest;
    largest = largest < hi ? hi : largest;
  }
  // Below the normal floats their spacing no longer falls with the coordinates.
  double spacing = FLT_EPSILON * (largest < (double)FLT_MIN ? (double)FLT_MIN : largest);
  double least = 100 * spacing;
  if (r >= least) return true;
  return problem_set(problem,
                     "radius %g is too small for a scene with coordinates up to %g: the vertices' "
                     "rounding would show in the density below %g",
                     r, largest, least);
}

static void cell_of(struct vec p, double inverse_edge, int64_t cell[3]) {
  cell[0] = cell_coordinate(p.x, inverse_edge);
  cell[1] = cell_coordinate(p.y, inverse_edge);
  cell[2] = cell_coordinate(p.z, inverse_edge);
}

// The cells of the photons' box. Cells rise with coordinates, so its corners have them.
static void grid_bound(struct grid *grid, const struct vec *position, int64_t count) {
  struct vec lo = {INFINITY, INFINITY, INFINITY}, hi = {-INFINITY, -INFINITY, -INFINITY};
  for (int64_t j = 0; j < count; j++) {
    struct vec p = position[j];
    lo = vec(p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y, p.z < lo.z ? p.z : lo.z);
    hi = vec(p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y, p.z > hi.z ? p.z : hi.z);
  }
  cell_of(lo, grid->inverse_edge, grid->lo);
  cell_of(hi, grid->inverse_edge, grid->hi);
}

// Buckets of their own for all cells of the box, as long as they are not more than the photons (to
// a power of two); then fewer along its longest side, but 16: a ball of radius r meets at most 11
// in a row, where cells are as narrow as the spacing of doubles.
static void grid_shape(struct grid *grid, int64_t count) {
  enum { LEAST_BITS = 4 };
  int most = 3 * LEAST_BITS;
  while (INT64_C(1) << most < count) most++;
  for (int k = 0; k < 3; k++) {
    uint64_t cells = (uint64_t)(grid->hi[k] - grid->lo[k]) + 1;
    for (grid->bits[k] = 0; grid->bits[k] < most && UINT64_C(1) << grid->bits[k] < cells;)
      grid->bits[k]++;
  }
  while (grid->bits[0] + grid->bits[1] + grid->bits[2] > most) {
    int longest = grid->bits[1] > grid->bits[2] ? 1 : 2;
    if (grid->bits[0] > grid->bits[longest]) longest = 0;
    grid->bits[longest]--;
  }
}

static uint32_t wrap(const struct grid *grid, int k, int64_t cell) {
  return (uint32_t)(cell - grid->lo[k]) & ((1u << grid->bits[k]) - 1);
}

// Of the first bucket of a row of cells along x.
static uint32_t row_of(const struct grid *grid, int64_t y, int64_t z) {
  return (wrap(grid, 2, z) << grid->bits[1] | wrap(grid, 1, y)) << grid->bits[0];
}

static void reserve_photons(struct grid *grid, int64_t count, int n_channels, struct arena *arena) {
  struct photons *sorted = &grid->sorted;
  grid->capacity = 2 * count;
  for (int k = 0; k < 3; k++)
    grid->position[k] = arena_new(arena, double, grid->capacity + GRID_ROOM);
  grid->photon = arena_new(arena, uint32_t, grid->capacity);
  grid->bucket = arena_new(arena, uint32_t, grid->capacity);
  sorted->wi = arena_new(arena, struct vec, grid->capacity);
  sorted->vertex = arena_new(arena, uint16_t, grid->capacity);
  sorted->kind = arena_new(arena, uint8_t, grid->capacity);
  for (int c = 0; c < n_channels; c++) sorted->flux[c] = arena_new(arena, double, grid->capacity);
}

static void reserve_buckets(struct grid *grid, struct arena *arena) {
  if (grid_buckets(grid) <= grid->bucket_capacity) return;
  grid->bucket_capacity = grid_buckets(grid);
  grid->first = arena_new(arena, uint32_t, grid->bucket_capacity + 1);
}

// How many photons each bucket has, in first[].
static void count_photons(struct grid *grid, const struct vec *position) {
  memset(grid->first, 0, ((size_t)grid_buckets(grid) + 1) * sizeof *grid->first);
  for (int64_t j = 0; j < grid->count; j++) {
    int64_t cell[3];
    cell_of(position[j], grid->inverse_edge, cell);
    grid->bucket[j] = row_of(grid, cell[1], cell[2]) + wrap(grid, 0, cell[0]);
    grid->first[grid->bucket[j]]++;
  }
}

// Each bucket is filled from its end backwards: stable.
static void order_photons(struct grid *grid) {
  uint32_t *first = grid->first, buckets = (uint32_t)grid_buckets(grid), sum = 0;
  for (uint32_t b = 0; b < buckets; b++) first[b] = sum += first[b];
  first[buckets] = sum;
  for (int64_t j = grid->count - 1; j >= 0; j--)
    grid->photon[--first[grid->bucket[j]]] = (uint32_t)j;
}

// Reads at random and writes in order: the other way round takes three times as long.
static void copy_photons(struct grid *grid, const struct photons *photons) {
  struct photons *sorted = &grid->sorted;
  const uint32_t *photon = grid->photon;
  int64_t n = grid->count;
  for (int64_t j = 0; j < n; j++) {
    struct vec p = photons->position[photon[j]];
    grid->position[0][j] = p.x;
    grid->position[1][j] = p.y;
    grid->position[2][j] = p.z;
  }
  for (int64_t j = 0; j < n && photons->wi; j++) sorted->wi[j] = photons->wi[photon[j]];
  for (int c = 0; c < photons->n_channels; c++)
    for (int64_t j = 0; j < n; j++) sorted->flux[c][j] = photons->flux[c][photon[j]];
  for (int64_t j = 0; j < n && photons->kind; j++) sorted->kind[j] = photons->kind[photon[j]];
  grid->deepest = 0;
  for (int64_t j = 0; j < n && photons->vertex; j++) {
    uint16_t vertex = photons->vertex[photon[j]];
    sorted->vertex[j] = vertex;
    grid->deepest = grid->deepest < vertex ? vertex : grid->deepest;
  }
}

void grid_build(struct grid *grid, const struct photons *photons, double r, struct arena *arena) {
  assert(photons->count < UINT32_MAX);
  grid->r = r;
  grid->inverse_edge = 1 / r;
  grid->count = grid->sorted.count = photons->count;
  grid->sorted.n_channels = photons->n_channels;
  if (grid->count > grid->capacity)
    reserve_photons(grid, photons->count, photons->n_channels, arena);
  grid_bound(grid, photons->position, photons->count);
  grid_shape(grid, photons->count);
  reserve_buckets(grid, arena);
  count_photons(grid, photons->position);
  order_photons(grid);
  copy_photons(grid, photons);
}

// Cells lo..hi of a ball that are in the photons' box.
static struct cells cells_within(const struct grid *grid, struct cells cells) {
  for (int k = 0; k < 3; k++) {
    if (cells.lo[k] < grid->lo[k]) cells.lo[k] = grid->lo[k];
    if (cells.hi[k] > grid->hi[k]) cells.hi[k] = grid->hi[k];
  }
  return cells;
}

enum { MOST_RANGES = 2 * 16 * 16 };

static int add_range(const struct grid *grid, uint32_t begin, uint32_t end,
                     struct grid_range *range) {
  *range = (struct grid_range){grid->first[begin], grid->first[end]};
  return range->begin < range->end;
}

// Where the photons of the cells are; neighbours along x are one range, two around a corner.
static int ranges_of(const struct grid *grid, struct cells cells,
                     struct grid_range range[MOST_RANGES]) {
  int n = 0;
  uint32_t begin = wrap(grid, 0, cells.lo[0]), end = wrap(grid, 0, cells.hi[0]) + 1;
  if (cells.lo[0] > cells.hi[0]) return 0;
  for (int64_t z = cells.lo[2]; z <= cells.hi[2]; z++)
    for (int64_t y = cells.lo[1]; y <= cells.hi[1]; y++) {
      uint32_t row = row_of(grid, y, z);
      if (begin < end) {
        n += add_range(grid, row + begin, row + end, &range[n]);
        continue;
      }
      n += add_range(grid, row + begin, row + (1u << grid->bits[0]), &range[n]);
      n += add_range(grid, row, row + end, &range[n]);
    }
  return n;
}

int grid_find(const struct grid *grid, struct vec p, double r, uint32_t *at, double *distance2) {
  if (grid->count == 0) return 0;
  struct cells near = cells_within(grid, cells_around(p, r, grid->inverse_edge));
  struct grid_range range[MOST_RANGES];
  int n = ranges_of(grid, near, range);
  return LEVEL_TABLE(grid_level)->within(grid, range, n, p, r * r, at, distance2);
}

// ---- cells that are seen ----

enum { SEEN_BITS = 64 * sizeof((struct grid_seen *)0)->bit / sizeof(uint64_t) };

// Deterministic 64-bit mixing of a cell's coordinates modulo 2^32 (the finaliser of splitmix64).
static uint32_t seen_bit(int64_t x, int64_t y, int64_t z) {
  uint64_t h = (uint64_t)(uint32_t)x | (uint64_t)y << 32;
  h ^= (uint64_t)(uint32_t)z * UINT64_C(0x9e3779b97f4a7c15);
  h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
  return (uint32_t)(h >> 32) % SEEN_BITS;
}

void grid_seen_mark(struct grid_seen *seen, const struct vec *p, int n, double r) {
  memset(seen->bit, 0, sizeof seen->bit);
  seen->inverse_edge = 1 / r;
  for (int j = 0; j < n; j++) {
    struct cells near = cells_around(p[j], r, seen->inverse_edge);
    for (int64_t z = near.lo[2]; z <= near.hi[2]; z++)
      for (int64_t y = near.lo[1]; y <= near.hi[1]; y++)
        for (int64_t x = near.lo[0]; x <= near.hi[0]; x++) {
          uint32_t bit = seen_bit(x, y, z);
          seen->bit[bit / 64] |= UINT64_C(1) << bit % 64;
        }
  }
}

bool grid_seen_keep(const void *data, struct vec p) {
  const struct grid_seen *seen = data;
  int64_t cell[3];
  cell_of(p, seen->inverse_edge, cell);
  uint32_t bit = seen_bit(cell[0], cell[1], cell[2]);
  return seen->bit[bit / 64] >> bit % 64 & 1;
}
