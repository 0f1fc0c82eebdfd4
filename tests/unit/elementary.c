// The elementary functions against 60-digit values and against long double libm.
#include "numeric/elementary.h"
#include "numeric/pair.h"
#include "numeric/rng.h"
#include "tests/unit/elementary_golden.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static double sine(double x, double y) {
  (void)y;
  double s, c;
  num_sincos(x, &s, &c);
  return s;
}

static double cosine(double x, double y) {
  (void)y;
  double s, c;
  num_sincos(x, &s, &c);
  return c;
}

static double sine_turns(double x, double y) {
  (void)y;
  double s, c;
  num_sincos_turns(x, &s, &c);
  return s;
}

static double cosine_turns(double x, double y) {
  (void)y;
  double s, c;
  num_sincos_turns(x, &s, &c);
  return c;
}

static double exponential(double x, double y) { return (void)y, num_exp(x); }
static double logarithm(double x, double y) { return (void)y, num_log(x); }
static double cube_root(double x, double y) { return (void)y, num_cbrt(x); }
static double arc_cosine(double x, double y) { return (void)y, num_acos(x); }
static double reciprocal_gamma(double x, double y) { return (void)y, num_rgamma1p(x); }

// Twice pi in the long double is good to 2^-64 relative; the argument is reduced exactly.
static const long double tau = 6.283185307179586476925286766559005768L;

static long double reference_sine_turns(long double u, long double unused) {
  (void)unused;
  u -= rintl(u);
  if (fabsl(u) > 0.25L) u = copysignl(0.5L, u) - u;
  return sinl(tau * u);
}

static long double reference_cosine_turns(long double u, long double unused) {
  return reference_sine_turns(0.25L - fabsl(u - rintl(u)), unused);
}

static long double reference_exp(long double x, long double y) { return (void)y, expl(x); }
static long double reference_log(long double x, long double y) { return (void)y, logl(x); }
static long double reference_cbrt(long double x, long double y) { return (void)y, cbrtl(x); }
static long double reference_sin(long double x, long double y) { return (void)y, sinl(x); }
static long double reference_cos(long double x, long double y) { return (void)y, cosl(x); }
static long double reference_acos(long double x, long double y) { return (void)y, acosl(x); }
static long double reference_rgamma(long double x, long double y) {
  return (void)y, 1 / tgammal(1 + x);
}

// How arguments are drawn for the comparison with libm; logarithmic: between powers of two.
enum draw { LINEAR, LOGARITHMIC, UNUSED };

// `bound`: ulp, what the header's users may count on; the analysis of the last additions gives
// 1/2 plus what a rounded second term contributes.
static const struct row {
  const char *name;
  double (*function)(double x, double y);
  long double (*reference)(long double x, long double y);
  double bound;
  struct {
    enum draw draw;
    double lo, hi;
  } x, y;
} rows[N_FUNCTIONS] = {
    [EXP] = {"exp", exponential, reference_exp, 0.7, {LINEAR, -708, 709}, {UNUSED, 0, 0}},
    [LOG] = {"log", logarithm, reference_log, 0.51, {LOGARITHMIC, -1022, 1023}, {UNUSED, 0, 0}},
    // powl loses bits where |y ln x| is large: the golden values cover that.
    [POW] = {"pow", num_pow, powl, 0.7, {LOGARITHMIC, -20, 50}, {LINEAR, -1, 1}},
    [CBRT] = {"cbrt", cube_root, reference_cbrt, 0.7, {LOGARITHMIC, -1022, 1023}, {UNUSED, 0, 0}},
    [SIN] = {"sin", sine, reference_sin, 0.9, {LINEAR, -1e5, 1e5}, {UNUSED, 0, 0}},
    [COS] = {"cos", cosine, reference_cos, 0.9, {LINEAR, -1e5, 1e5}, {UNUSED, 0, 0}},
    [SIN_TURNS] =
        {"sin of turns", sine_turns, reference_sine_turns, 0.9, {LINEAR, -1, 1}, {UNUSED, 0, 0}},
    [COS_TURNS] = {"cos of turns",
                   cosine_turns,
                   reference_cosine_turns,
                   0.9,
                   {LINEAR, -1, 1},
                   {UNUSED, 0, 0}},
    [ATAN2] = {"atan2", num_atan2, atan2l, 0.6, {LINEAR, -2, 2}, {LINEAR, -2, 2}},
    [ACOS] = {"acos", arc_cosine, reference_acos, 0.6, {LINEAR, -1, 1}, {UNUSED, 0, 0}},
    [RGAMMA1P] =
        {"1/Gamma(1+a)", reciprocal_gamma, reference_rgamma, 1, {LINEAR, 0, 1}, {UNUSED, 0, 0}},
};

static double ulp_of(double x) {
  int exponent;
  frexp(x, &exponent);
  return ldexp(1, (exponent < -1021 ? -1021 : exponent) - 53);
}

static void agree_with_60_digit_values(void **state) {
  (void)state;
  double worst[N_FUNCTIONS] = {0};
  for (size_t k = 0; k < sizeof golden / sizeof golden[0]; k++) {
    const struct golden *g = &golden[k];
    const struct row *row = &rows[g->function];
    double got = row->function(g->x, g->y);
    double error = fabs((got - g->hi) - g->lo) / ulp_of(g->hi);
    // A subnormal result is rounded a second time.
    double bound = fabs(g->hi) < 0x1p-1022 ? row->bound + 0.5 : row->bound;
    if (!(error <= bound))
      fail_msg("%s(%a, %a) = %a, not %a: %.3f ulp", row->name, g->x, g->y, got, g->hi, error);
    if (error > worst[g->function]) worst[g->function] = error;
  }
  for (int f = 0; f < N_FUNCTIONS; f++) print_message("%-14s %.3f ulp\n", rows[f].name, worst[f]);
}

static double drawn(enum draw draw, double lo, double hi, double u) {
  double x = lo + (hi - lo) * u;
  return draw == LOGARITHMIC ? ldexp(1 + (x - floor(x)), (int)floor(x)) : x;
}

enum { N_DRAWN = 20000 };

static uint64_t hash_bits(uint64_t hash, double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (hash ^ bits) * 0x100000001b3;
}

static void agree_with_long_double_libm(void **state) {
  (void)state;
  struct rng_key key = rng_key(rng_hash_name(__func__), 1, RNG_TEST);
  uint64_t hash = 0;
  for (int f = 0; f < N_FUNCTIONS; f++) {
    const struct row *row = &rows[f];
    double worst = 0;
    for (uint64_t j = 0; j < N_DRAWN; j++) {
      double u, v;
      rng_fill(key, (uint64_t)f, &j, 1, 0, &u, &v);
      double x = drawn(row->x.draw, row->x.lo, row->x.hi, u);
      double y = drawn(row->y.draw, row->y.lo, row->y.hi, v);
      double got = row->function(x, y);
      long double want = row->reference(x, y);
      double error = (double)fabsl(got - want) / ulp_of((double)want);
      if (!(error <= row->bound))
        fail_msg("%s(%a, %a) = %a: %.3f ulp", row->name, x, y, got, error);
      if (error > worst) worst = error;
      hash = hash_bits(hash, got);
    }
    print_message("%-14s %.3f ulp\n", row->name, worst);
  }
  print_message("checksum of the results %016llx\n", (unsigned long long)hash);
}

static void same_bits(double got, double want, const char *what) {
  if (want != want ? got == got : memcmp(&got, &want, sizeof got) != 0)
    fail_msg("%s is %a, not %a", what, got, want);
}
#define SAME(got, want) same_bits((got), (want), #got)

static void special_values_are_those_of_c(void **state) {
  (void)state;
  SAME(num_exp(-INFINITY), 0);
  SAME(num_exp(INFINITY), INFINITY);
  SAME(num_exp(NAN), NAN);
  SAME(num_exp(-0.0), 1);
  SAME(num_exp(709.79), INFINITY);
  SAME(num_exp(-745.2), 0);
  SAME(num_log(0), -INFINITY);
  SAME(num_log(-0.0), -INFINITY);
  SAME(num_log(-1), NAN);
  SAME(num_log(NAN), NAN);
  SAME(num_log(INFINITY), INFINITY);
  SAME(num_log(1), 0);
  SAME(num_pow(0, 0), 1);
  SAME(num_pow(NAN, 0), 1);
  SAME(num_pow(1, NAN), 1);
  SAME(num_pow(1, INFINITY), 1);
  SAME(num_pow(0, 0.3), 0);
  SAME(num_pow(0, -0.3), INFINITY);
  SAME(num_pow(INFINITY, 0.3), INFINITY);
  SAME(num_pow(INFINITY, -0.3), 0);
  SAME(num_pow(0.3, INFINITY), 0);
  SAME(num_pow(0.3, -INFINITY), INFINITY);
  SAME(num_pow(2.3, 1e300), INFINITY);
  SAME(num_pow(2.3, -1e300), 0);
  SAME(num_pow(NAN, 0.5), NAN);
  SAME(num_pow(0.5, NAN), NAN);
  SAME(num_pow(2, 10), 1024);
  SAME(num_cbrt(-0.0), -0.0);
  SAME(num_cbrt(-INFINITY), -INFINITY);
  SAME(num_cbrt(NAN), NAN);
  SAME(num_cbrt(-27), -3);
  SAME(num_acos(1), 0);
  SAME(num_acos(-1), 0x1.921fb54442d18p+1);
  SAME(num_acos(0), 0x1.921fb54442d18p+0);
  SAME(num_acos(1.0000001), NAN);
  SAME(num_acos(NAN), NAN);
  SAME(num_rgamma1p(0), 1);
  SAME(num_rgamma1p(1), 1);
}

static void atan2_knows_signed_zeros_and_infinities(void **state) {
  (void)state;
  const double special[] = {0.0, -0.0, 2.385, -2.385, INFINITY, -INFINITY, NAN};
  const int n = sizeof special / sizeof special[0];
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      SAME(num_atan2(special[i], special[j]), atan2(special[i], special[j]));
}

static void turns_are_exact_at_quarters_and_periodic(void **state) {
  (void)state;
  for (int k = -9; k <= 9; k++) {
    double s, c, period_s, period_c;
    num_sincos_turns(0.25 * k, &s, &c);
    assert_true(s == (k % 4 == 0 || k % 2 == 0 ? 0 : (k + 100) % 4 == 1 ? 1 : -1));
    assert_true(c == (k % 2 != 0 ? 0 : (k + 100) % 4 == 0 ? 1 : -1));
    num_sincos_turns(0.171875, &s, &c); // 11/64: exact also after adding k
    num_sincos_turns(0.171875 + k, &period_s, &period_c);
    assert_true(s == period_s && c == period_c);
  }
}

// Rejects contraction (a product that is not rounded) and wider registers as well.
static void the_product_of_two_doubles_is_exact_as_a_pair(void **state) {
  (void)state;
  struct rng_key key = rng_key(rng_hash_name(__func__), 1, RNG_TEST);
  for (uint64_t j = 0; j < 10000; j++) {
    double u, v;
    rng_fill(key, 1, &j, 1, 0, &u, &v);
    struct pair p = pair_product(u, v);
    __extension__ typedef __int128 wide;
    wide product = (wide)(u * 0x1p53) * (wide)(v * 0x1p53); // an integer below 2^106
    assert_true((wide)(p.hi * 0x1p106) + (wide)(p.lo * 0x1p106) == product);
    struct pair s = pair_sum(u, -0x1p-20 * v);
    assert_true((wide)(s.hi * 0x1p73) + (wide)(s.lo * 0x1p73) ==
                (wide)(u * 0x1p73) - (wide)(v * 0x1p53));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(agree_with_60_digit_values),
      cmocka_unit_test(agree_with_long_double_libm),
      cmocka_unit_test(special_values_are_those_of_c),
      cmocka_unit_test(atan2_knows_signed_zeros_and_infinities),
      cmocka_unit_test(turns_are_exact_at_quarters_and_periodic),
      cmocka_unit_test(the_product_of_two_doubles_is_exact_as_a_pair),
  };
  return cmocka_run_group_tests_name("elementary", tests, NULL, NULL);
}
