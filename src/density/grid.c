#include "density/grid.h"

#include <assert.h>
#include <float.h>
#include <string.h>

static const double last_cell = 0x1p62;

// Deterministic 64-bit mixing of a cell's coordinates (the finaliser of splitmix64).
static uint32_t hash_cell(struct grid_cell cell) {
  uint64_t h = (uint64_t)cell.x | (uint64_t)cell.y << 32;
  h ^= (uint64_t)cell.z * UINT64_C(0x9e3779b97f4a7c15);
  h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
  return (uint32_t)(h >> 32);
}

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

// Modulo 2^32, see struct grid_cell.
static struct grid_cell cell_numbered(int64_t x, int64_t y, int64_t z) {
  return (struct grid_cell){(uint32_t)x, (uint32_t)y, (uint32_t)z};
}

static inline struct grid_cell cell_of(struct vec p, double inverse_edge) {
  return cell_numbered(cell_coordinate(p.x, inverse_edge), cell_coordinate(p.y, inverse_edge),
                       cell_coordinate(p.z, inverse_edge));
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

static void grid_reserve(struct grid *grid, int64_t count, struct arena *arena) {
  if (count > grid->capacity) {
    grid->capacity = 2 * count;
    grid->position = arena_new(arena, struct vec, grid->capacity);
    grid->cell = arena_new(arena, struct grid_cell, grid->capacity);
    grid->photon = arena_new(arena, uint32_t, grid->capacity);
    grid->bucket = arena_new(arena, uint32_t, grid->capacity);
  }
  uint32_t buckets = 16;
  while (buckets < count) buckets *= 2;
  if (buckets > grid->bucket_capacity) {
    grid->bucket_capacity = buckets;
    grid->first = arena_new(arena, uint32_t, (ptrdiff_t)buckets + 1);
  }
  grid->mask = buckets - 1;
}

void grid_build(struct grid *grid, const struct photons *photons, double r, struct arena *arena) {
  assert(photons->count < UINT32_MAX);
  grid_reserve(grid, photons->count, arena);
  grid->r = r;
  grid->inverse_edge = 1 / r;
  grid->count = photons->count;
  uint32_t *first = grid->first;
  memset(first, 0, ((size_t)grid->mask + 2) * sizeof *first);
  for (int64_t j = 0; j < photons->count; j++) {
    grid->bucket[j] = hash_cell(cell_of(photons->position[j], grid->inverse_edge)) & grid->mask;
    first[grid->bucket[j]]++;
  }
  // Exclusive prefix sums, then each bucket is filled from its end backwards: stable.
  uint32_t sum = 0;
  for (uint32_t b = 0; b <= grid->mask; b++) first[b] = sum += first[b];
  first[grid->mask + 1] = sum;
  for (int64_t j = photons->count - 1; j >= 0; j--) {
    uint32_t at = --first[grid->bucket[j]];
    grid->position[at] = photons->position[j];
    grid->cell[at] = cell_of(photons->position[j], grid->inverse_edge);
    grid->photon[at] = (uint32_t)j;
  }
}

// Photons of one cell within r of p, appended behind the first `found`.
static int find_in_cell(const struct grid *grid, struct grid_cell cell, struct vec p, double r2,
                        int found, uint32_t *photon, double *distance2) {
  uint32_t bucket = hash_cell(cell) & grid->mask;
  for (uint32_t at = grid->first[bucket]; at < grid->first[bucket + 1]; at++) {
    struct vec d = vec_sub(grid->position[at], p);
    double d2 = vec_dot(d, d);
    struct grid_cell own = grid->cell[at];
    if (!(d2 < r2) || own.x != cell.x || own.y != cell.y || own.z != cell.z) continue;
    photon[found] = grid->photon[at];
    distance2[found++] = d2;
  }
  return found;
}

int grid_find(const struct grid *grid, struct vec p, double r, uint32_t *photon,
              double *distance2) {
  struct cells near = cells_around(p, r, grid->inverse_edge);
  int found = 0;
  if (grid->count == 0) return 0;
  for (int64_t z = near.lo[2]; z <= near.hi[2]; z++)
    for (int64_t y = near.lo[1]; y <= near.hi[1]; y++)
      for (int64_t x = near.lo[0]; x <= near.hi[0]; x++)
        found = find_in_cell(grid, cell_numbered(x, y, z), p, r * r, found, photon, distance2);
  return found;
}

enum { SEEN_BITS = 64 * sizeof((struct grid_seen *)0)->bit / sizeof(uint64_t) };

void grid_seen_mark(struct grid_seen *seen, const struct vec *p, int n, double r) {
  memset(seen->bit, 0, sizeof seen->bit);
  seen->inverse_edge = 1 / r;
  for (int j = 0; j < n; j++) {
    struct cells near = cells_around(p[j], r, seen->inverse_edge);
    for (int64_t z = near.lo[2]; z <= near.hi[2]; z++)
      for (int64_t y = near.lo[1]; y <= near.hi[1]; y++)
        for (int64_t x = near.lo[0]; x <= near.hi[0]; x++) {
          uint32_t bit = hash_cell(cell_numbered(x, y, z)) % SEEN_BITS;
          seen->bit[bit / 64] |= UINT64_C(1) << bit % 64;
        }
  }
}

bool grid_seen_keep(const void *data, struct vec p) {
  const struct grid_seen *seen = data;
  uint32_t bit = hash_cell(cell_of(p, seen->inverse_edge)) % SEEN_BITS;
  return seen->bit[bit / 64] >> bit % 64 & 1;
}
