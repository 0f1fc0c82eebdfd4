// The photon grid finds what lies within r, each photon once, in an order of its own that neither
// the table's size nor dropped cells change; the gather adds up what theory 1.1 says.
#include "density/grid.h"
#include "density/gather.h"
#include "numeric/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

static struct arena arena;

// n photons in a cube of half side `half` around zero; a third of them on a lattice of integer
// multiples of r, where distances fall exactly on r and positions exactly on cell borders.
static struct photons photons_cloud(const char *name, int n, double half, double r) {
  struct photons photons = {.count = n, .capacity = n, .n_channels = 1};
  photons.position = arena_new(&arena, struct vec, n);
  photons.wi = arena_new(&arena, struct vec, n);
  photons.vertex = arena_new(&arena, uint16_t, n);
  photons.flux[0] = arena_new(&arena, double, n);
  struct rng_key key = rng_key(rng_hash_name(name), 1, RNG_TEST);
  for (uint64_t j = 0; j < (uint64_t)n; j++) {
    double u[4];
    rng_fill(key, 1, &j, 1, 0, &u[0], &u[1]);
    rng_fill(key, 1, &j, 1, 1, &u[2], &u[3]);
    struct vec p = vec(half * (2 * u[0] - 1), half * (2 * u[1] - 1), half * (2 * u[2] - 1));
    if (j % 3 == 0) p = vec(floor(p.x / r) * r, floor(p.y / r) * r, floor(p.z / r) * r);
    photons.position[j] = p;
    photons.wi[j] = vec(0, 0, 1);
    photons.flux[0][j] = 1 + u[3];
  }
  return photons;
}

static int brute_force(const struct photons *photons, struct vec p, double r, unsigned char *in) {
  int found = 0;
  for (int64_t j = 0; j < photons->count; j++) {
    struct vec d = vec_sub(photons->position[j], p);
    in[j] = vec_dot(d, d) < r * r;
    found += in[j];
  }
  return found;
}

static void check_photons(struct photons photons, double r) {
  int n = (int)photons.count;
  struct grid grid = {0};
  grid_build(&grid, &photons, r, &arena);
  uint32_t *at = arena_new(&arena, uint32_t, n + GRID_ROOM);
  double *distance2 = arena_new(&arena, double, n + GRID_ROOM);
  unsigned char *in = arena_new(&arena, unsigned char, n);
  int total = 0;
  for (int q = 0; q < 200; q++) {
    struct vec p = photons.position[(q * 37) % n];
    if (q % 2) p = vec_add(p, vec(0.3 * r, -0.7 * r, 0.11 * r));
    int expected = brute_force(&photons, p, r, in), found = grid_find(&grid, p, r, at, distance2);
    assert_int_equal(found, expected);
    total += found;
    for (int k = 0; k < found; k++) {
      assert_true(in[grid.photon[at[k]]]);
      in[grid.photon[at[k]]] = 0; // a second time would fail
    }
  }
  assert_true(total > 200); // the queries are not about nothing
}

static void check_cloud(const char *name, int n, double half, double r) {
  check_photons(photons_cloud(name, n, half, r), r);
}

static void finds_what_brute_force_finds(void **state) {
  (void)state;
  check_cloud("dense", 3000, 1, 0.25);
  check_cloud("sparse", 3000, 1, 0.07);
  check_cloud("one cell", 500, 0.2, 0.5);
  check_cloud("small radius far from zero scale", 3000, 1e-6, 1e-7);
  check_cloud("huge", 3000, 1e6, 1e5);
}

// In a medium without end photons go anywhere. A third of them is 2^32 cells away, so that their
// cells have the same numbers; beyond 2^53 cells doubles are farther apart than cells, beyond 2^62
// all are in one cell, and where squares overflow nothing is near.
static void photons_may_lie_anywhere(void **state) {
  (void)state;
  static const double far[] = {0x1p31, 0x1p32, 0x1p45, 0x1p52, 0x1p54, 0x1p62, 0x1p63, 1e30, 1e307};
  double r = 0.25;
  for (size_t k = 0; k < sizeof far / sizeof *far; k++) {
    struct photons photons = photons_cloud("anywhere", 999, 1, r);
    for (int64_t j = 0; j < photons.count; j++) {
      struct vec *p = &photons.position[j];
      double x = (j % 2 ? 1 : -1) * far[k] * r + (j % 3 == 1 ? 0x1p32 * r : 0);
      *p = vec_add(*p, j % 5 ? vec(x, 0, x) : vec(0, -x, 0));
    }
    check_photons(photons, r);
  }
}

// The filter keeps all that a query may find there, and not everything.
static void what_is_seen_far_away_is_kept(void **state) {
  (void)state;
  double r = 0.25;
  struct photons photons = photons_cloud("kept", 3000, 10, r);
  for (int64_t j = 0; j < photons.count; j++) photons.position[j].y -= 0x1p40 * r;
  struct grid_seen seen;
  grid_seen_mark(&seen, &photons.position[7], 1, r);
  int kept = 0;
  for (int64_t j = 0; j < photons.count; j++) {
    struct vec d = vec_sub(photons.position[j], photons.position[7]);
    bool keep = grid_seen_keep(&seen, photons.position[j]);
    assert_true(keep || !(vec_dot(d, d) < r * r));
    kept += keep;
  }
  assert_true(kept < 30);
}

static void order_does_not_depend_on_photons_elsewhere(void **state) {
  (void)state;
  double r = 0.1;
  struct photons all = photons_cloud("elsewhere", 4000, 1, r);
  struct vec p = vec(0.05, -0.02, 0.31);
  struct grid_seen seen;
  grid_seen_mark(&seen, &p, 1, r);
  struct photons some = photons_cloud("elsewhere", 4000, 1, r);
  some.count = 0;
  for (int64_t j = 0; j < all.count; j++)
    if (grid_seen_keep(&seen, all.position[j])) some.position[some.count++] = all.position[j];
  assert_true(some.count < all.count / 4); // the filter is worth its name
  struct grid grid_all = {0}, grid_some = {0};
  grid_build(&grid_all, &all, r, &arena);
  grid_build(&grid_some, &some, r, &arena);
  uint32_t photon[4000 + GRID_ROOM];
  double d_all[4000 + GRID_ROOM], d_some[4000 + GRID_ROOM];
  int n = grid_find(&grid_all, p, r, photon, d_all);
  assert_int_equal(grid_find(&grid_some, p, r, photon, d_some), n);
  assert_true(n > 1);
  assert_memory_equal(d_all, d_some, (size_t)n * sizeof *d_all);
}

static void photons_at_exactly_r_are_outside_and_at_zero_inside(void **state) {
  (void)state;
  struct photons photons = photons_cloud("border", 3, 1, 1);
  photons.position[0] = vec(0.5, 0, 0);
  photons.position[1] = vec(0, 0, 0);
  photons.position[2] = vec(0, -0.5 * (1 - 1e-15), 0);
  struct grid grid = {0};
  grid_build(&grid, &photons, 0.5, &arena);
  uint32_t photon[3 + GRID_ROOM];
  double distance2[3 + GRID_ROOM];
  assert_int_equal(grid_find(&grid, vec(0, 0, 0), 0.5, photon, distance2), 2);
}

static void no_photons_are_no_problem(void **state) {
  (void)state;
  struct photons photons = {.n_channels = 1};
  struct grid grid = {0};
  grid_build(&grid, &photons, 0.1, &arena);
  assert_int_equal(grid_find(&grid, vec(0, 0, 0), 0.1, NULL, NULL), 0);
}

static void unresolved_radii_are_refused(void **state) {
  (void)state;
  struct box room = {{-1000, 0, 0}, {1000, 1, 1}};
  struct problem problem = {0};
  // 100 float spacings at 1000: 100 * 2^-23 * 1000 = 0.0119.
  assert_true(grid_radius_is_resolved(room, 0.0121, &problem));
  assert_string_equal(problem.text, "");
  assert_false(grid_radius_is_resolved(room, 0.0118, &problem));
  assert_non_null(strstr(problem.text, "too small"));
  // Subnormal floats are 2^-149 = 1.4e-45 apart, whatever they are.
  struct box speck = {{-1e-42f, 0, 0}, {1e-42f, 0, 0}};
  struct problem of_speck = {0};
  assert_true(grid_radius_is_resolved(speck, 1.41e-43, &of_speck));
  assert_false(grid_radius_is_resolved(speck, 1.39e-43, &of_speck));
}

// Reflects the same everywhere, so that the sums are known.
static void value_one(const struct bsdf *bsdf, struct vec wo, struct vec wi,
                      enum transport transport, double f[3]) {
  (void)bsdf, (void)transport;
  f[0] = f[1] = f[2] = wo.z * wi.z > 0;
}
static const struct bsdf_type one = {.value = value_one};

static void gather_is_the_kernel_weighted_sum_for_every_kernel(void **state) {
  (void)state;
  double r = 0.3;
  struct photons photons = photons_cloud("gather", 3000, 1, r);
  for (int64_t j = 0; j < photons.count; j++) {
    photons.position[j].z = 0;
    if (j % 5 == 0) photons.wi[j].z = -1; // arrived on the other side
  }
  struct grid grid = {0};
  grid_build(&grid, &photons, r, &arena);
  struct eye_point point = {
      .hit = true, .p = vec(0.1, 0.05, 0), .wo = vec(0, 0, 1), .weight = {2.385}};
  point.bsdf = (struct bsdf){
      .type = &one, .s = vec(1, 0, 0), .t = vec(0, 1, 0), .n = vec(0, 0, 1), .ng = vec(0, 0, 1)};
  struct gather gather = {0};
  for (int k = 0; k < n_kernels; k++) {
    // Two discs share the photons; the smaller one must not see those beyond it.
    double c = kernels[k].constants(2).c;
    struct disc disc[2] = {disc_of(&kernels[k], c, r, 2, 1000),
                           disc_of(&kernels[k], c, 0.2, 2, 1000)};
    double out[2] = {0}, expected[2] = {0};
    gather_point(&gather, &grid, &point, 64, disc, 2, NULL, out, 1, &arena);
    for (int64_t j = 0; j < photons.count; j++) {
      struct vec d = vec_sub(photons.position[j], point.p);
      for (int e = 0; e < 2; e++)
        if (photons.wi[j].z > 0)
          expected[e] += 2.385 * photons.flux[0][j] / 1000 / (disc[e].r * disc[e].r) *
                         kernel_value(&kernels[k], 2, vec_dot(d, d) / (disc[e].r * disc[e].r));
    }
    for (int e = 0; e < 2; e++) {
      assert_true(expected[e] > 0);
      // A few hundred positive terms: rounding of at most a few hundred eps.
      assert_true(fabs(out[e] / expected[e] - 1) < 1e-13);
    }
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(finds_what_brute_force_finds),
      cmocka_unit_test(photons_may_lie_anywhere),
      cmocka_unit_test(what_is_seen_far_away_is_kept),
      cmocka_unit_test(order_does_not_depend_on_photons_elsewhere),
      cmocka_unit_test(photons_at_exactly_r_are_outside_and_at_zero_inside),
      cmocka_unit_test(no_photons_are_no_problem),
      cmocka_unit_test(unresolved_radii_are_refused),
      cmocka_unit_test(gather_is_the_kernel_weighted_sum_for_every_kernel),
  };
  return cmocka_run_group_tests_name("grid", tests, NULL, NULL);
}
