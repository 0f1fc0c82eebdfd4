// The photon tree finds what brute force finds: the k nearest in order, ties by photon number, and
// all within a radius of any size.
#include "density/knn.h"
#include "numeric/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct arena arena;

// Every third on a lattice of a few points, where many photons and distances are the same; every
// fifth in one plane.
static struct vec *cloud(int n) {
  struct vec *p = arena_new(&arena, struct vec, n);
  struct rng_key key = rng_key(rng_hash_name("knn"), 1, RNG_TEST);
  for (uint64_t j = 0; j < (uint64_t)n; j++) {
    double u[4];
    rng_fill(key, 1, &j, 1, 0, &u[0], &u[1]);
    rng_fill(key, 1, &j, 1, 1, &u[2], &u[3]);
    p[j] = vec(2 * u[0] - 1, 2 * u[1] - 1, 0.3 * u[2]);
    if (j % 3 == 0) p[j] = vec(floor(3 * p[j].x) / 3, floor(3 * p[j].y) / 3, 0);
    if (j % 5 == 0) p[j].z = 0.125;
  }
  return p;
}

struct found {
  double d2;
  uint32_t photon;
};

static int nearer(const void *a, const void *b) {
  const struct found *x = a, *y = b;
  if (x->d2 != y->d2) return x->d2 < y->d2 ? -1 : 1;
  return (x->photon > y->photon) - (x->photon < y->photon);
}

static bool accept_some(void *data, uint32_t photon) {
  (void)data;
  return photon % 4 != 1;
}

// All that count, sorted.
static int brute_force(const struct vec *position, int n, struct vec p, bool filtered,
                       struct found *out) {
  int count = 0;
  for (uint32_t j = 0; j < (uint32_t)n; j++) {
    if (filtered && !accept_some(NULL, j)) continue;
    struct vec d = vec_sub(position[j], p);
    out[count++] = (struct found){vec_dot(d, d), j};
  }
  qsort(out, (size_t)count, sizeof *out, nearer);
  return count;
}

// Among the photons, on them, far away.
static struct vec query(const struct vec *position, int n, int q) {
  struct vec at = position[(q * 37) % n];
  return q % 3 == 0 ? at : q % 3 == 1 ? vec_along(vec(0.01, 0.02, 0), at, 0.9) : vec_scale(at, 30);
}

static void the_nearest_are_those_of_brute_force(void **state) {
  (void)state;
  static const int sizes[] = {1, 2, 7, 8, 9, 10, 17, 100, 3000}, ks[] = {1, 2, 5, 50, 4000};
  struct found *truth = arena_new(&arena, struct found, 3000);
  uint32_t *photon = arena_new(&arena, uint32_t, 4000);
  double *distance2 = arena_new(&arena, double, 4000);
  struct knn_filter filter = {accept_some, NULL};
  struct knn knn = {0}; // grows and shrinks
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
    int n = sizes[s];
    struct vec *position = cloud(n);
    knn_build(&knn, position, n, &arena);
    for (int q = 0; q < 60; q++) {
      struct vec p = query(position, n, q);
      int count = brute_force(position, n, p, q % 2, truth), k = ks[q % 5];
      int found = knn_nearest(&knn, p, k, q % 2 ? &filter : NULL, photon, distance2);
      assert_int_equal(found, k < count ? k : count);
      for (int j = 0; j < found; j++) {
        assert_int_equal(photon[j], truth[j].photon);
        assert_true(distance2[j] == truth[j].d2);
      }
    }
  }
}

static void all_within_a_radius_are_those_of_brute_force(void **state) {
  (void)state;
  enum { N = 3000 };
  static const double radii[] = {0, 1e-200, 0.01, 1.0 / 3, 0.5, 100};
  struct vec *position = cloud(N);
  struct found *truth = arena_new(&arena, struct found, N);
  uint32_t *photon = arena_new(&arena, uint32_t, N);
  double *distance2 = arena_new(&arena, double, N);
  struct knn knn = {0};
  knn_build(&knn, position, N, &arena);
  int total = 0;
  for (int q = 0; q < 120; q++) {
    struct vec p = query(position, N, q);
    double r = radii[q % 6];
    brute_force(position, N, p, false, truth);
    int found = knn_within(&knn, p, r, photon, distance2), expected = 0;
    while (expected < N && truth[expected].d2 < r * r) expected++;
    assert_int_equal(found, expected);
    struct found *own = arena_new(&arena, struct found, N);
    for (int j = 0; j < found; j++) own[j] = (struct found){distance2[j], photon[j]};
    qsort(own, (size_t)found, sizeof *own, nearer);
    for (int j = 0; j < found; j++) assert_int_equal(own[j].photon, truth[j].photon);
    total += found;
  }
  assert_true(total > 10000);
}

static void no_photons_are_no_problem(void **state) {
  (void)state;
  struct knn knn = {0};
  uint32_t photon;
  double distance2;
  knn_build(&knn, NULL, 0, &arena);
  assert_int_equal(knn_nearest(&knn, vec(0, 0, 0), 3, NULL, &photon, &distance2), 0);
  assert_int_equal(knn_within(&knn, vec(0, 0, 0), 3, &photon, &distance2), 0);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_nearest_are_those_of_brute_force),
      cmocka_unit_test(all_within_a_radius_are_those_of_brute_force),
      cmocka_unit_test(no_photons_are_no_problem),
  };
  return cmocka_run_group_tests_name("knn", tests, NULL, NULL);
}
