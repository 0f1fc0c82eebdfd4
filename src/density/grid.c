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

// A point within r of p differs by at most r in each coordinate, rounding included: d2 < r2 implies
// |dx| <= r (1 + 2 eps), so cells are searched in a box that is wider than that.
static double widened(double r) { return r * (1 + 4 * DBL_EPSILON); }

// The cells of a ball, from lo to hi in each coordinate.
struct cells {
  int64_t lo[3], hi[3];
};

static struct cells cells_around(struct vec p, double r, double inverse_edge) {
  double reach = widened(r), at[3] = {p.x, p.y, p.z};
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
static void find_box(struct grid *grid, const struct vec *position) {
  double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
  SIMD_TABLE(grid_level)->bound(position, grid->count, lo, hi);
  for (int k = 0; k < 3; k++) {
    grid->lo[k] = cell_coordinate(lo[k], grid->inverse_edge);
    grid->hi[k] = cell_coordinate(hi[k], grid->inverse_edge);
    grid->lo_cell[k] = (double)grid->lo[k];
    grid->hi_cell[k] = (double)grid->hi[k];
  }
}

// Buckets of their own for all cells of the box, as long as they are not more than four times the
// photons (to a power of two); then fewer along its longest side, but 16: a ball of radius r meets
// at most 11 in a row, where cells are as narrow as the spacing of doubles.
static void choose_buckets(struct grid *grid) {
  enum { LEAST_BITS = 4 };
  int most = 3 * LEAST_BITS;
  while (INT64_C(1) << most < 4 * grid->count) most++;
  for (int k = 0; k < 3; k++) {
    uint64_t cells = (uint64_t)grid->hi[k] - (uint64_t)grid->lo[k] + 1;
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
  return (uint32_t)((uint64_t)cell - (uint64_t)grid->lo[k]) & ((1u << grid->bits[k]) - 1);
}

// Of the first bucket of a row of cells along x.
static uint32_t row_of(const struct grid *grid, int64_t y, int64_t z) {
  return (wrap(grid, 2, z) << grid->bits[1] | wrap(grid, 1, y)) << grid->bits[0];
}

static void reserve_photons(struct grid *grid, int64_t count, struct arena *arena) {
  if (count <= grid->capacity) return;
  grid->capacity = 2 * count;
  int64_t room = grid->capacity + GRID_ROOM;
  for (int k = 0; k < 3; k++) {
    grid->position[k] = arena_new(arena, double, room);
    grid->wi[k] = arena_new(arena, double, room);
    if (k < grid->n_channels) grid->flux[k] = arena_new(arena, double, room);
  }
  grid->vertex = arena_new(arena, uint16_t, room);
  grid->kind = arena_new(arena, uint8_t, room);
  grid->photon = arena_new(arena, uint32_t, room);
  grid->bucket = arena_new(arena, uint32_t, room);
}

static void reserve_buckets(struct grid *grid, struct arena *arena) {
  if (grid_buckets(grid) <= grid->bucket_capacity) return;
  grid->bucket_capacity = grid_buckets(grid);
  grid->first = arena_new(arena, uint32_t, grid->bucket_capacity + 1);
}

// Whether the box's cells can be told apart in 31 bits each way, and in doubles.
static bool is_narrow(const struct grid *grid) {
  for (int k = 0; k < 3; k++)
    if (grid->lo[k] < -(INT64_C(1) << 51) || grid->hi[k] > INT64_C(1) << 51 ||
        (uint64_t)grid->hi[k] - (uint64_t)grid->lo[k] >= UINT64_C(1) << 31)
      return false;
  return true;
}

static void find_buckets(struct grid *grid, const struct vec *position) {
  if (is_narrow(grid)) {
    SIMD_TABLE(grid_level)->buckets(grid, position, grid->count, grid->bucket);
    return;
  }
  for (int64_t j = 0; j < grid->count; j++) {
    int64_t cell[3];
    cell_of(position[j], grid->inverse_edge, cell);
    grid->bucket[j] = row_of(grid, cell[1], cell[2]) + wrap(grid, 0, cell[0]);
  }
}

// Each bucket is filled from its end backwards: stable.
static void sort_numbers(struct grid *grid) {
  uint32_t *first = grid->first, buckets = (uint32_t)grid_buckets(grid), sum = 0;
  memset(first, 0, (size_t)buckets * sizeof *first);
  for (int64_t j = 0; j < grid->count; j++) first[grid->bucket[j]]++;
  for (uint32_t b = 0; b < buckets; b++) first[b] = sum += first[b];
  first[buckets] = sum;
  for (int64_t j = grid->count - 1; j >= 0; j--)
    grid->photon[--first[grid->bucket[j]]] = (uint32_t)j;
}

static void copy_vectors(const struct grid *grid, const struct vec *from, double *to[3]) {
  for (int64_t j = 0; from && j < grid->count; j++) {
    struct vec a = from[grid->photon[j]];
    to[0][j] = a.x;
    to[1][j] = a.y;
    to[2][j] = a.z;
  }
}

// Reads at random and writes in order: the other way round takes three times as long.
static void copy_photons(struct grid *grid, const struct photons *photons) {
  const uint32_t *photon = grid->photon;
  int64_t n = grid->count;
  copy_vectors(grid, photons->position, grid->position);
  copy_vectors(grid, photons->wi, grid->wi);
  for (int c = 0; c < grid->n_channels; c++)
    for (int64_t j = 0; j < n; j++) grid->flux[c][j] = photons->flux[c][photon[j]];
  for (int64_t j = 0; photons->kind && j < n; j++) grid->kind[j] = photons->kind[photon[j]];
  grid->deepest = 0;
  for (int64_t j = 0; photons->vertex && j < n; j++) {
    int vertex = photons->vertex[photon[j]];
    grid->vertex[j] = (uint16_t)vertex;
    grid->deepest = grid->deepest < vertex ? vertex : grid->deepest;
  }
}

void grid_build(struct grid *grid, const struct photons *photons, double r, struct arena *arena) {
  assert(photons->count < UINT32_MAX);
  grid->r = r;
  grid->inverse_edge = 1 / r;
  grid->count = photons->count;
  grid->n_channels = photons->n_channels;
  reserve_photons(grid, photons->count, arena);
  find_box(grid, photons->position);
  choose_buckets(grid);
  reserve_buckets(grid, arena);
  find_buckets(grid, photons->position);
  sort_numbers(grid);
  copy_photons(grid, photons);
}

static int64_t floor_of(double x) {
  int64_t truncated = (int64_t)x;
  return truncated - (x < (double)truncated);
}

// Of the box's cells along axis k those from x - reach to x + reach, at least one: the bucket of
// the first and how many.
static uint32_t cells_along(const struct grid *grid, int k, double x, double reach, uint32_t *n) {
  double lo = (x - reach) * grid->inverse_edge, hi = (x + reach) * grid->inverse_edge;
  double first = grid->lo_cell[k], last = grid->hi_cell[k];
  lo = lo > first ? lo : first;
  hi = hi > first ? hi : first;
  int64_t begin = floor_of(lo < last ? lo : last);
  *n = (uint32_t)(floor_of(hi < last ? hi : last) - begin) + 1;
  return wrap(grid, k, begin);
}

static int add_range(const struct grid *grid, uint32_t begin, uint32_t end,
                     struct grid_range *range) {
  *range = (struct grid_range){grid->first[begin], grid->first[end]};
  return range->begin < range->end;
}

// Neighbours along x are one range, two around a corner.
int grid_ranges(const struct grid *grid, struct vec p, double r,
                struct grid_range range[GRID_RANGES]) {
  double reach = widened(r);
  uint32_t n[3], x = cells_along(grid, 0, p.x, reach, &n[0]),
                 y = cells_along(grid, 1, p.y, reach, &n[1]),
                 z = cells_along(grid, 2, p.z, reach, &n[2]);
  uint32_t row_length = 1u << grid->bits[0], rest = x + n[0] > row_length ? row_length - x : n[0];
  uint32_t y_mask = (1u << grid->bits[1]) - 1, z_mask = (1u << grid->bits[2]) - 1;
  int found = 0;
  for (uint32_t k = 0; k < n[2]; k++)
    for (uint32_t j = 0; j < n[1]; j++) {
      uint32_t row = (((z + k) & z_mask) << grid->bits[1] | ((y + j) & y_mask)) << grid->bits[0];
      found += add_range(grid, row + x, row + x + rest, &range[found]);
      if (rest < n[0]) found += add_range(grid, row, row + n[0] - rest, &range[found]);
    }
  return found;
}

int grid_find(const struct grid *grid, struct vec p, double r, uint32_t *at, double *distance2) {
  struct grid_range range[GRID_RANGES];
  if (grid->count == 0) return 0;
  int n = grid_ranges(grid, p, r, range);
  return SIMD_TABLE(grid_level)->within(grid, range, n, p, r * r, at, distance2);
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
