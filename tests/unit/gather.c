// The gather, bit for bit: at every SIMD level the sum of theory 1.1 over the photons of a disc, in
// the order and shape that grid.h and numeric/sum.h say, written down here without them.
#include "density/gather.h"
#include "base/simd.h"
#include "numeric/rng.h"
#include "numeric/sum.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

enum { N = 3000, CHANNELS = 3, DEPTH = 9, LEFT_OUT = 2 };

static struct arena arena;
static const double edge = 0.3;

static double uniform(uint64_t path, uint32_t pair) {
  double u, unused;
  rng_fill(rng_key(rng_hash_name("gather"), 1, RNG_TEST), 1, &path, 1, pair, &u, &unused);
  return u;
}

// In a slab around z = 0, from all sides; one in seven along the plane, which no side is.
static struct photons photons_new(void) {
  struct photons photons = {.count = N, .n_channels = CHANNELS};
  photons.position = arena_new(&arena, struct vec, N);
  photons.wi = arena_new(&arena, struct vec, N);
  photons.vertex = arena_new(&arena, uint16_t, N);
  photons.kind = arena_new(&arena, uint8_t, N);
  for (int c = 0; c < CHANNELS; c++) photons.flux[c] = arena_new(&arena, double, N);
  for (uint64_t j = 0; j < N; j++) {
    photons.position[j] = vec(2 * uniform(j, 0) - 1, 2 * uniform(j, 1) - 1, 0.2 * uniform(j, 2));
    photons.wi[j] =
        vec_normalize(vec(uniform(j, 3) - 0.5, uniform(j, 4) - 0.5, uniform(j, 5) - 0.3));
    if (j % 7 == 0) photons.wi[j] = vec(0, 1, 0);
    photons.vertex[j] = (uint16_t)(12 * uniform(j, 6));
    photons.kind[j] = (uint8_t)(4 * uniform(j, 7));
    for (uint32_t c = 0; c < CHANNELS; c++) photons.flux[c][j] = 2.385 * uniform(j, 8 + c);
  }
  return photons;
}

static void value_sided(const struct bsdf *bsdf, struct vec wo, struct vec wi,
                        enum transport transport, double f[3]) {
  (void)transport;
  for (int c = 0; c < 3; c++) f[c] = bsdf->x[(wo.z > 0) == (wi.z > 0) ? c : 3 + c];
}

static void value_glossy(const struct bsdf *bsdf, struct vec wo, struct vec wi,
                         enum transport transport, double f[3]) {
  (void)transport;
  for (int c = 0; c < 3; c++) f[c] = wo.z * wi.z > 0 ? bsdf->x[c] * (wi.z + wi.x * wi.x) : 0;
}

static const struct bsdf_type sided = {.value = value_sided, .by_side = true},
                              sided_one_by_one = {.value = value_sided},
                              glossy = {.value = value_glossy};

static struct eye_point point_at(struct vec p, const struct bsdf_type *type, bool transmits) {
  const struct vec z = {0, 0, 1};
  struct eye_point point = {
      .hit = true,
      .vertex = 2,
      .p = p,
      .wo = {0.6, 0, 0.8},
      .weight = {1.5, 0.7, 0.3},
      .bsdf = {.type = type, .s = {1, 0, 0}, .t = {0, 1, 0}, .n = z, .ng = z}};
  for (int c = 0; c < 3; c++) point.bsdf.x[c] = 0.3 + 0.1 * c;
  for (int c = 0; c < 3; c++) point.bsdf.x[3 + c] = transmits && c != 1 ? 0.13 : 0;
  return point;
}

// ---- the definition ----
struct item {
  int64_t cell[3]; // z, y, x
  int photon;
};

static int compare_items(const void *a, const void *b) {
  const struct item *i = a, *j = b;
  for (int k = 0; k < 3; k++)
    if (i->cell[k] != j->cell[k]) return i->cell[k] < j->cell[k] ? -1 : 1;
  return i->photon - j->photon;
}

// The photons by cells of the grid (z, y, x), then as stored.
static void in_order(const struct photons *photons, int order[N]) {
  static struct item item[N];
  for (int j = 0; j < N; j++) {
    struct vec p = vec_scale(photons->position[j], 1 / edge);
    item[j] = (struct item){{(int64_t)floor(p.z), (int64_t)floor(p.y), (int64_t)floor(p.x)}, j};
  }
  qsort(item, N, sizeof *item, compare_items);
  for (int j = 0; j < N; j++) order[j] = item[j].photon;
}

static double square_distance(const struct photons *photons, int j, struct vec p) {
  struct vec d = vec_sub(photons->position[j], p);
  return vec_dot(d, d);
}

// Of disc e; largest: the radius of the largest. Returns how many photons count.
static int64_t define(const struct photons *photons, const int order[N],
                      const struct eye_point *point, const struct disc *disc, double largest,
                      unsigned left_out, double out[CHANNELS]) {
  double lane[CHANNELS][SUM_LANES] = {{0}}, f[3];
  int64_t count = 0;
  int item = 0;
  for (int k = 0; k < N; k++) {
    int j = order[k];
    double d2 = square_distance(photons, j, point->p), w;
    if (!(d2 < largest * largest) || photons->vertex[j] + point->vertex >= DEPTH) continue;
    bsdf_value(&point->bsdf, point->wo, photons->wi[j], TRANSPORT_RADIANCE, f);
    if (f[0] == 0 && f[1] == 0 && f[2] == 0) continue;
    count += kernel_weigh(disc->kernel, &d2, disc->r, &w, 1);
    double factor =
        photons->kind[j] & left_out ? 0 : bsdf_photon_factor(&point->bsdf, photons->wi[j]);
    for (int c = 0; c < CHANNELS; c++)
      lane[c][item % SUM_LANES] += w * (f[c] * factor * photons->flux[c][j]);
    item++;
  }
  for (int c = 0; c < CHANNELS; c++) out[c] = point->weight[c] * (disc->scale * sum_lanes(lane[c]));
  return count;
}

// ---- against it ----
enum { DISCS = 2, POINTS = 40 };

static struct photons photons;
static struct grid grid;
static int order[N];

// Returns how many photons counted.
static int64_t check(const struct eye_point *point, const struct kernel *kernel, double r,
                     unsigned left_out) {
  struct gather gather = {.left_out = left_out};
  double c = kernel->constants(2).c, out[DISCS][CHANNELS] = {{0}}, expected[CHANNELS];
  struct disc disc[DISCS] = {disc_of(kernel, c, 0.7 * r, 2, 1000), disc_of(kernel, c, r, 2, 1000)};
  int64_t count[DISCS] = {0};
  struct arena scratch = arena;
  gather_point(&gather, &grid, point, DEPTH, disc, DISCS, count, out[0], CHANNELS, &scratch);
  for (int e = 0; e < DISCS; e++) {
    assert_int_equal(define(&photons, order, point, &disc[e], r, left_out, expected), count[e]);
    assert_memory_equal(out[e], expected, sizeof expected);
  }
  return count[1];
}

static int64_t check_points(const struct bsdf_type *type, bool bent, unsigned left_out) {
  int64_t counted = 0;
  for (int k = 0; k < POINTS; k++) {
    uint64_t path = N + (uint64_t)k;
    struct vec p = vec(2 * uniform(path, 0) - 1, 2 * uniform(path, 1) - 1, 0.2 * uniform(path, 2));
    struct eye_point point = point_at(p, type, k % 2);
    if (k % 4 > 1) point.wo.z *= -1;
    if (bent) point.bsdf.ng = vec(0.28, 0, 0.96), point.bsdf.bent = true;
    counted += check(&point, &kernels[k % n_kernels], edge * (k % 3 ? 1 : 0.45), left_out);
  }
  return counted;
}

static void gathers_are_the_sum_at_every_level(void **state) {
  (void)state;
  const struct bsdf_type *const types[] = {&sided, &sided_one_by_one, &glossy};
  for (int level = 0; level <= (int)simd_best(); level++) {
    simd_choose((enum simd)level);
    for (int t = 0; t < 3; t++) {
      assert_true(check_points(types[t], false, 0) > 100 * POINTS / 10);
      check_points(types[t], true, 0);
      check_points(types[t], false, LEFT_OUT);
    }
  }
  simd_choose(simd_best());
}

static void check_count(const struct grid *own, int n, bool transmits, struct arena scratch) {
  struct gather gather = {0};
  struct eye_point point = point_at(vec(0.2, 0, 0), &sided, transmits);
  struct kernel_constants constants = kernels[0].constants(2);
  struct disc disc = disc_of(&kernels[0], constants.c, 1, 2, 1);
  double out[CHANNELS] = {0};
  int64_t count = 0, expected = 0;
  for (int j = 0; j < n; j++) expected += transmits ? photons.wi[j].z != 0 : photons.wi[j].z > 0;
  gather_point(&gather, own, &point, 1000, &disc, 1, &count, out, CHANNELS, &scratch);
  assert_int_equal(count, expected);
}

// Discs of 0 to 40 photons in two rows of cells, one behind the other: every bound of ranges and
// lanes.
static void discs_of_any_number_of_photons(void **state) {
  (void)state;
  for (int n = 0; n <= 40; n++) {
    struct photons some = photons;
    struct grid own = {0};
    struct arena scratch = arena;
    some.count = n;
    some.position = arena_new(&scratch, struct vec, n);
    for (int j = 0; j < n; j++) some.position[j] = vec(0.01 * j, 0, j % 3 ? 0 : -1e-3);
    grid_build(&own, &some, 1, &scratch);
    for (int level = 0; level <= (int)simd_best(); level++) {
      simd_choose((enum simd)level);
      check_count(&own, n, true, scratch);
      check_count(&own, n, false, scratch);
    }
  }
  simd_choose(simd_best());
}

int main(void) {
  arena = arena_reserve();
  photons = photons_new();
  grid_build(&grid, &photons, edge, &arena);
  in_order(&photons, order);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gathers_are_the_sum_at_every_level),
      cmocka_unit_test(discs_of_any_number_of_photons),
  };
  return cmocka_run_group_tests_name("gather", tests, NULL, NULL);
}
