// Places: the rim of a disc far from the origin, discs far smaller than the scene, positions
// rounded.
#include "app/stability.h"
#include "density/grid.h"
#include "density/knn.h"
#include "numeric/rng.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { N_RIM = 12 };

// Within 1 +- delta of p along each axis, and both ways; the sums are exact as delta is at least
// the spacing of doubles there.
static void rim(double p, double delta, struct vec position[N_RIM]) {
  for (int j = 0; j < N_RIM; j++) {
    double away = (j % 2 ? 1 + delta : 1 - delta) * (j / 2 % 2 ? 1 : -1);
    double x[3] = {p, p, p};
    x[j / 4] += away;
    position[j] = vec(x[0], x[1], x[2]);
  }
}

// How many photons a way of searching places on the wrong side of the rim; a mask of those inside.
typedef unsigned find_inside(const struct vec position[N_RIM], double p, struct arena *arena);

static unsigned inside_by_grid(const struct vec position[N_RIM], double p, struct arena *arena) {
  struct photons photons = {.count = N_RIM, .position = (struct vec *)position};
  struct grid grid = {0};
  uint32_t at[N_RIM + GRID_ROOM];
  double distance2[N_RIM + GRID_ROOM];
  unsigned inside = 0;
  grid_build(&grid, &photons, 1, arena);
  int n = grid_find(&grid, vec(p, p, p), 1, at, distance2);
  for (int j = 0; j < n; j++) inside |= 1u << grid.photon[at[j]];
  return inside;
}

static unsigned inside_by_tree(const struct vec position[N_RIM], double p, struct arena *arena) {
  struct knn tree = {0};
  uint32_t photon[N_RIM];
  double distance2[N_RIM];
  unsigned inside = 0;
  knn_build(&tree, position, N_RIM, arena);
  int n = knn_within(&tree, vec(p, p, p), 1, photon, distance2);
  for (int j = 0; j < n; j++) inside |= 1u << photon[j];
  return inside;
}

// |a|^2 - 2 a b + |b|^2 cancels.
static unsigned inside_by_squares(const struct vec position[N_RIM], double p, struct arena *arena) {
  (void)arena;
  struct vec eye = vec(p, p, p);
  unsigned inside = 0;
  for (int j = 0; j < N_RIM; j++) {
    double d2 =
        vec_dot(position[j], position[j]) - 2 * vec_dot(position[j], eye) + vec_dot(eye, eye);
    if (d2 < 1) inside |= 1u << j;
  }
  return inside;
}

// The largest distance from the rim at which a photon is taken for one of the other side.
static double widest_mistake(find_inside *find, double p) {
  struct arena arena = arena_reserve();
  double mistake = 0;
  for (double delta = 0.5; p + 2 + delta > p + 2; delta *= 0.5) {
    struct arena scratch = arena;
    struct vec position[N_RIM];
    unsigned inside = 0;
    rim(p, delta, position);
    for (unsigned j = 0; j < N_RIM; j += 2) inside |= 1u << j;
    if (find(position, p, &scratch) == inside) continue;
    mistake = delta;
    break;
  }
  arena_release(arena);
  return mistake;
}

static double rim_by_grid(double unused, double level) {
  (void)unused;
  return widest_mistake(inside_by_grid, level);
}

static double rim_by_tree(double unused, double level) {
  (void)unused;
  return widest_mistake(inside_by_tree, level);
}

static double rim_by_squares(double unused, double level) {
  (void)unused;
  return widest_mistake(inside_by_squares, level);
}

static double nothing(double unused, double level) {
  (void)unused, (void)level;
  return 0;
}

// ---- all that brute force finds, and nothing else ----

enum { N_CLOUD = 3000, N_QUERIES = 60 };

// In [-1, 1).
static struct vec anywhere(uint64_t path) {
  double u[4];
  struct rng_key key = rng_key(rng_hash_name("stability"), 1, RNG_TEST);
  rng_fill(key, 1, &path, 1, 0, &u[0], &u[1]);
  rng_fill(key, 1, &path, 1, 1, &u[2], &u[3]);
  return vec(2 * u[0] - 1, 2 * u[1] - 1, 2 * u[2] - 1);
}

static struct vec query_at(int q, double half) { return vec_scale(anywhere((uint64_t)q), half); }

// In a scene of [-half, half]^3: a third anywhere, a third near one of the queries, a third near
// one on a lattice of cell borders; r = 1.
static void cloud(double half, struct vec position[N_CLOUD]) {
  for (int j = 0; j < N_CLOUD; j++) {
    struct vec q = query_at(j % N_QUERIES, half), away = anywhere(N_QUERIES + (uint64_t)j);
    position[j] = j % 3 == 0 ? vec_scale(away, half) : vec_along(q, away, 1.5);
    if (j % 3 == 2)
      position[j] = vec(floor(position[j].x), floor(position[j].y), floor(position[j].z));
  }
}

static int mistakes_at(const struct grid *grid, const struct vec *position, struct vec p) {
  static uint32_t at[N_CLOUD + GRID_ROOM];
  static double distance2[N_CLOUD + GRID_ROOM];
  static signed char surplus[N_CLOUD];
  int mistakes = 0, n = grid_find(grid, p, 1, at, distance2);
  memset(surplus, 0, sizeof surplus);
  for (int j = 0; j < n; j++) surplus[grid->photon[at[j]]]++;
  for (int j = 0; j < N_CLOUD; j++) {
    struct vec d = vec_sub(position[j], p);
    mistakes += surplus[j] != (vec_dot(d, d) < 1);
  }
  return mistakes;
}

// Photons missed, or found twice or wrongly, by query.
static double small_discs(double unused, double half) {
  (void)unused;
  struct arena arena = arena_reserve(), scratch = arena;
  struct vec *position = arena_new(&scratch, struct vec, N_CLOUD);
  struct photons photons = {.count = N_CLOUD, .position = position};
  struct grid grid = {0};
  double mistakes = 0;
  cloud(half, position);
  grid_build(&grid, &photons, 1, &scratch);
  for (int q = 0; q < N_QUERIES; q++) mistakes += mistakes_at(&grid, position, query_at(q, half));
  arena_release(arena);
  return mistakes / N_QUERIES;
}

static bool unresolved(double half) {
  float x = (float)half;
  struct problem problem = {0};
  return !grid_radius_is_resolved((struct box){{-x, -x, -x}, {x, x, x}}, 1, &problem);
}

// ---- photons on a lattice, as positions in float are: the disc of radius r spacings ----

static double points_in_disc(double x, double y, double r) {
  double count = 0;
  for (double i = ceil(x - r); i <= x + r; i++) {
    double half = sqrt(r * r - (i - x) * (i - x));
    count += floor(y + half) - ceil(y - half) + 1;
  }
  return count;
}

// Root mean square over places of the eye.
static double float_positions(double unused, double r) {
  (void)unused;
  enum { N = 400 };
  double sum = 0;
  for (uint64_t j = 0; j < N; j++) {
    struct vec p = anywhere(j);
    double ratio = points_in_disc(p.x, p.y, r) / (0x1.921fb54442d18p+1 * r * r);
    sum += (ratio - 1) * (ratio - 1);
  }
  return sqrt(sum / N);
}

// clang-format off
const struct stress stress_places[] = {
  {"rim", "grid", "distance/r", 1, 1e8, 10, 0, rim_by_grid, nothing, NULL},
  {"rim", "tree", "distance/r", 1, 1e8, 10, 0, rim_by_tree, nothing, NULL},
  {"rim", "expanded squares", "distance/r", 1, 1e8, 10, 0, rim_by_squares, NULL, NULL},
  {"small discs", "grid", "scene/r", 1, 1e10, 10, 0, small_discs, nothing, unresolved},
  {"radius", "positions in float", "r/spacing", 1, 1e4, 1.7782794100389228, 0,
   float_positions, NULL, NULL},
  {0},
};
// clang-format on
