// Sums have one shape.
#include "numeric/sum.h"

#include "base/simd.h"
#include "numeric/rng.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { N = 100 };

static void draw(const char *name, double x[N]) {
  struct rng_key key = rng_key(rng_hash_name(name), 1, RNG_TEST);
  for (uint64_t j = 0; j < N; j++) {
    double v;
    rng_fill(key, 1, &j, 1, 0, &x[j], &v);
  }
}

// Written out from the header's words, lane by lane.
static void item_j_goes_to_lane_j_mod_8_and_lanes_to_one_tree(void **state) {
  (void)state;
  double x[N];
  draw(__func__, x);
  for (int n = 0; n <= N; n++) {
    double lane[8];
    for (int l = 0; l < 8; l++) {
      lane[l] = 0;
      for (int j = l; j < n; j += 8) lane[l] += x[j];
    }
    double even = (lane[0] + lane[4]) + (lane[2] + lane[6]);
    double odd = (lane[1] + lane[5]) + (lane[3] + lane[7]);
    assert_true(sum_array(x, n) == even + odd);
  }
}

// The shape is part of the result: on these numbers a running sum has other bits.
static void the_shape_can_be_told_from_a_running_sum(void **state) {
  (void)state;
  double x[N], running = 0;
  draw(__func__, x);
  int different = 0;
  for (int n = 0; n < N; n++) {
    different += sum_array(x, n) != running;
    running += x[n];
  }
  assert_true(different > N / 4);
}

static void sums_are_right(void **state) {
  (void)state;
  double x[N];
  for (int j = 0; j < N; j++) x[j] = j + 1;
  for (int n = 0; n <= N; n++) assert_true(sum_array(x, n) == n * (n + 1) / 2);
  draw(__func__, x);
  long double want = 0;
  for (int j = 0; j < N; j++) want += x[j];
  // Each of at most 13 + 3 additions rounds a partial sum below the total.
  assert_true(fabsl(sum_array(x, N) - want) <= 16 * 0x1p-53L * want);
}

static void products_have_the_shape_at_every_level(void **state) {
  (void)state;
  double a[N], b[N], product[N];
  draw("a", a);
  draw("b", b);
  for (int j = 0; j < N; j++) product[j] = a[j] * b[j];
  for (int level = 0; level <= (int)simd_best(); level++) {
    simd_choose((enum simd)level);
    for (int n = 0; n <= N; n++) assert_true(sum_products(a, b, n) == sum_array(product, n));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(item_j_goes_to_lane_j_mod_8_and_lanes_to_one_tree),
      cmocka_unit_test(the_shape_can_be_told_from_a_running_sum),
      cmocka_unit_test(sums_are_right),
      cmocka_unit_test(products_have_the_shape_at_every_level),
  };
  return cmocka_run_group_tests_name("sum", tests, NULL, NULL);
}
