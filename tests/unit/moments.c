// Moments over runs: against two passes in long double, and the same bits from every split.
#include "moments/moments.h"

#include "numeric/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 3, MOST = 1000 };

// Skewed and of different scales, so that no moment vanishes: column w has mean about 3^w.
static void draw_values(const char *name, double x[MOST][WIDTH]) {
  struct rng_key key = rng_key(rng_hash_name(name), 1, RNG_TEST);
  for (uint64_t j = 0; j < MOST; j++)
    for (uint32_t w = 0; w < WIDTH; w++) {
      double u, v;
      rng_fill(key, 1, &j, 1, w, &u, &v);
      x[j][w] = pow(3, w) * (u * u + 0.3 * v);
    }
}

static struct moments two_passes(const double *x, int n, int stride) {
  long double mean = 0, m2 = 0, m3 = 0, m4 = 0;
  for (int j = 0; j < n; j++) mean += x[j * stride];
  mean /= n;
  for (int j = 0; j < n; j++) {
    long double y = x[j * stride] - mean;
    m2 += y * y;
    m3 += y * y * y;
    m4 += y * y * y * y;
  }
  return (struct moments){n, (double)mean, (double)m2, (double)m3, (double)m4};
}

static void tree_of(double x[MOST][WIDTH], int first, int n, struct moments root[WIDTH],
                    struct arena arena) {
  struct moments_tree tree = moments_tree_new(WIDTH, &arena);
  for (int j = first; j < first + n; j++) {
    struct moments leaf[WIDTH];
    for (int w = 0; w < WIDTH; w++) leaf[w] = moments_of(x[j][w]);
    moments_tree_push(&tree, leaf, &arena);
  }
  moments_tree_root(&tree, root);
}

static void near(double got, double want, double scale, const char *what, int n) {
  if (!(fabs(got - want) <= 1e-13 * scale))
    fail_msg("n = %d: %s is %.17g, not %.17g", n, what, got, want);
}

static void the_tree_gives_the_moments_of_two_passes(void **state) {
  static double x[MOST][WIDTH];
  draw_values(__func__, x);
  const int sizes[] = {1, 2, 3, 5, 16, 31, 64, 100, 999, 1000};
  for (int s = 0; s < 10; s++) {
    struct moments root[WIDTH];
    tree_of(x, 0, sizes[s], root, *(struct arena *)*state);
    for (int w = 0; w < WIDTH; w++) {
      struct moments want = two_passes(&x[0][w], sizes[s], WIDTH);
      double sd = sqrt(want.m2 / want.n);
      assert_true(root[w].n == want.n);
      near(root[w].mean, want.mean, want.mean, "the mean", sizes[s]);
      near(root[w].m2, want.m2, want.m2, "M2", sizes[s]);
      near(root[w].m3, want.m3, sd * want.m2, "M3", sizes[s]); // signed: on the scale of |y|^3
      near(root[w].m4, want.m4, want.m4, "M4", sizes[s]);
    }
  }
}

// Blocks of 2^b runs, each reduced on its own (another thread, machine or day), then pushed.
static void every_split_into_blocks_gives_the_same_bits(void **state) {
  static double x[MOST][WIDTH];
  draw_values(__func__, x);
  const int sizes[] = {1, 16, 17, 100, 128, 1000};
  for (int s = 0; s < 6; s++)
    for (int block = 1; block <= 256; block *= 2) {
      struct arena arena = *(struct arena *)*state;
      struct moments whole[WIDTH], split[WIDTH], part[WIDTH];
      tree_of(x, 0, sizes[s], whole, arena);
      struct moments_tree tree = moments_tree_new(WIDTH, &arena);
      for (int j = 0; j < sizes[s]; j += block) {
        int n = sizes[s] - j < block ? sizes[s] - j : block; // only the last block may be short
        tree_of(x, j, n, part, arena);
        moments_tree_push(&tree, part, &arena);
      }
      moments_tree_root(&tree, split);
      assert_memory_equal(whole, split, sizeof whole);
    }
}

// The root may be read at any time (a checkpoint) and the tree goes on.
static void reading_the_root_changes_nothing(void **state) {
  static double x[MOST][WIDTH];
  draw_values(__func__, x);
  struct arena arena = *(struct arena *)*state;
  struct moments_tree tree = moments_tree_new(WIDTH, &arena);
  for (int j = 0; j < 77; j++) {
    struct moments leaf[WIDTH], root[WIDTH], want[WIDTH];
    for (int w = 0; w < WIDTH; w++) leaf[w] = moments_of(x[j][w]);
    moments_tree_push(&tree, leaf, &arena);
    moments_tree_root(&tree, root);
    tree_of(x, 0, j + 1, want, arena);
    assert_memory_equal(root, want, sizeof root);
  }
}

// Theory 7: the naive sum of squares gives 0 here; 1e-6 +- 3 % (1.4 % is one sd of a variance).
static void a_small_spread_on_a_huge_mean_survives(void **state) {
  struct arena arena = *(struct arena *)*state;
  struct rng_key key = rng_key(rng_hash_name(__func__), 1, RNG_TEST);
  struct moments_tree tree = moments_tree_new(1, &arena);
  static double x[10000];
  const double tau = 6.283185307179586;
  double naive = 0, naive2 = 0;
  for (uint64_t j = 0; j < 10000; j++) {
    double u, v;
    rng_fill(key, 1, &j, 1, 0, &u, &v);
    x[j] = 1e6 + 1e-3 * sqrt(-2 * log(1 - u)) * cos(tau * v);
    struct moments leaf = moments_of(x[j]);
    moments_tree_push(&tree, &leaf, &arena);
    naive += x[j];
    naive2 += x[j] * x[j];
  }
  struct moments root, want = two_passes(x, 10000, 1);
  moments_tree_root(&tree, &root);
  assert_true(fabs(moments_variance(root) - 1e-6) < 7e-8); // 5 sd
  // A mean near 1e6 is rounded by at most half an ulp, 5.8e-11: 5.8e-8 sd, in every merge.
  assert_true(fabs(root.m2 - want.m2) < 1e-7 * want.m2);
  assert_true(fabs((naive2 - naive * naive / 10000) / 9999 - 1e-6) > 1e-6); // the hazard is real
}

static void equal_values_have_no_spread(void **state) {
  struct arena arena = *(struct arena *)*state;
  struct moments_tree tree = moments_tree_new(1, &arena);
  for (int j = 0; j < 1000; j++) {
    struct moments leaf = moments_of(0.1), root;
    moments_tree_push(&tree, &leaf, &arena);
    moments_tree_root(&tree, &root);
    assert_true(root.n == j + 1 && root.mean == 0.1);
    assert_true(root.m2 == 0 && root.m3 == 0 && root.m4 == 0);
  }
}

static void nothing_is_the_neutral_element(void **state) {
  struct arena arena = *(struct arena *)*state;
  struct moments some = {3, 2.385, 1.1, -0.7, 2.9}, none = {0};
  struct moments left = moments_merge(none, some), right = moments_merge(some, none);
  assert_memory_equal(&left, &some, sizeof some);
  assert_memory_equal(&right, &some, sizeof some);
  struct moments_tree tree = moments_tree_new(1, &arena);
  moments_tree_root(&tree, &some);
  assert_memory_equal(&some, &none, sizeof some);
}

static void variance_and_standard_error_are_unbiased_ones(void **state) {
  (void)state;
  struct moments m = moments_merge(moments_merge(moments_of(1), moments_of(2)), moments_of(6));
  assert_true(m.mean == 3 && m.m2 == 14 && m.m3 == 18 && m.m4 == 98);
  assert_true(moments_variance(m) == 7);
  assert_true(moments_se2(m) == 7.0 / 3);
}

static int reserve(void **state) {
  static struct arena arena;
  arena = arena_reserve();
  *state = &arena;
  return 0;
}

static int release(void **state) {
  arena_release(*(struct arena *)*state);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_tree_gives_the_moments_of_two_passes),
      cmocka_unit_test(every_split_into_blocks_gives_the_same_bits),
      cmocka_unit_test(reading_the_root_changes_nothing),
      cmocka_unit_test(a_small_spread_on_a_huge_mean_survives),
      cmocka_unit_test(equal_values_have_no_spread),
      cmocka_unit_test(nothing_is_the_neutral_element),
      cmocka_unit_test(variance_and_standard_error_are_unbiased_ones),
  };
  return cmocka_run_group_tests_name("moments", tests, reserve, release);
}
