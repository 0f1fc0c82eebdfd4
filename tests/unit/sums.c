// The sums of rho_i against 60-digit values (theory, Appendix A), long direct sums, and the slopes
// an ordinary straight line sees in the exact curves (theory 3.4).
#include "analysis/sums.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

static void assert_relative(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance * fabs(expected)))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

static const struct golden {
  double alpha;
  uint64_t n;
  double plus, minus;
} golden[] = {
    {0.5, 2, 1.75, 2.3333333333333333},
    {0.5, 19, 8.0296550095663406, 51.512916563001198},
    {0.5, 20, 8.2803963848054991, 55.501089631950008},
    {0.5, 1000, 69.391722605708992, 18703.991919818874},
    {0.5, 1000000000000000, 71364962.646110871, 1.8683304054659783e+22},
    {2.0 / 3, 2, 1.8333333333333333, 2.2},
    {2.0 / 3, 10, 6.6362534442518859, 15.723683407165197},
    {2.0 / 3, 19, 10.675127902578806, 35.844587386739022},
    {2.0 / 3, 20, 11.080965499331433, 38.308627209568786},
    {2.0 / 3, 100, 34.496706616292327, 317.25823610549358},
    {2.0 / 3, 1000, 164.75212587394374, 6777.61332683002},
    {2.0 / 3, 1000000, 16614.491742587449, 67705971.700101989},
    {2.0 / 3, 1000000000000000, 16615982509.987076, 6.770589697132018e+19},
    {0.8, 1000, 336.11024497360893, 3092.59199539541},
    {0.8, 1000000000, 21270677.429721407, 48971952621.359867},
    {0.1, 100, 6.6685457243902005, 3192.2506149915096},
    {0.1, 1000000000, 73.494780256405695, 63035771629838233.0},
    {1e-12, 19, 3.5477396571491783, 189.99999999943043},
    {1e-12, 1000, 7.4854708605775391, 500499.99999650427},
    {1e-12, 1000000000000000, 35.115992060427963, 4.999999999826925e+29},
};

static void test_golden(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof golden / sizeof *golden; k++) {
    assert_relative(sums_plus(golden[k].alpha, golden[k].n), golden[k].plus, 1e-14);
    assert_relative(sums_minus(golden[k].alpha, golden[k].n), golden[k].minus, 4e-15);
  }
}

static void test_alpha_at_its_ends(void **state) {
  (void)state;
  assert_relative(sums_plus(0, 1000), 7.485470860550345, 1e-14); // H_1000
  assert_relative(sums_plus(5e-324, 1000), 7.485470860550345, 1e-14);
  assert_relative(sums_minus(0, 1000), 500500, 1e-15);
  assert_relative(sums_plus(1, 1000), 1000, 1e-14);
  assert_relative(sums_minus(1, 1000), 1000, 1e-15);
}

static void test_direct_sums(void **state) {
  (void)state;
  const struct law *law = law_find("knaus-zwicker");
  const double alphas[] = {0.1, 0.5, 2.0 / 3, 0.9};
  for (int k = 0; k < 4; k++) {
    assert_relative(sums_plus(alphas[k], 5000), sums_direct(law, alphas[k], 1, 5000), 2e-14);
    assert_relative(sums_minus(alphas[k], 5000), sums_direct(law, alphas[k], -1, 5000), 2e-14);
  }
}

static void test_general_power(void **state) {
  (void)state;
  const struct law *law = law_find("knaus-zwicker");
  const double powers[] = {0.5, 2.0 / 3, 4.0 / 3, 2};
  const double alphas[] = {0, 0.25, 0.5, 2.0 / 3, 1}; // 0.5 with p = 2: the logarithm
  for (int a = 0; a < 5; a++)
    for (int p = 0; p < 4; p++)
      assert_relative(sums_power(alphas[a], powers[p], 100000),
                      sums_direct(law, alphas[a], powers[p], 100000), 2e-13);
  assert_relative(sums_power(0.7, 1, 1000000), sums_plus(0.7, 1000000), 2e-13);
}

// K_2 = (Gamma(1 - 2a) / Gamma(1 - a)^2 - 1) / a^2; below a = 1/2 it is the whole sum, and what is
// missing after n terms is the tail of w^(2a - 2).
static void test_constant_of_squares(void **state) {
  (void)state;
  const double alphas[] = {0.3, 0.6, 0.8};
  for (int k = 0; k < 3; k++) {
    double a = alphas[k], n = 1e12, b = 2 * (a - 1), w = n + (1 + a) / 2;
    double constant = (tgamma(1 - 2 * a) / pow(tgamma(1 - a), 2) - 1) / (a * a);
    double tail = pow(w, b + 1) / (b + 1) / pow(tgamma(1 + a), 2);
    double rest = sums_power(a, 2, (uint64_t)n) - tail;
    // The rest is what a double leaves of a difference of numbers as large as the tail.
    assert_true(fabs(rest - constant) <= 1e-9 + 1e-12 * fabs(tail));
  }
}

// Ordinary least squares of ln y on ln n over ten points a decade.
static double slope(double (*curve)(double alpha, uint64_t n), double alpha, int from, int to) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0, last = 0;
  for (int j = 10 * from; j <= 10 * to; j++) {
    double n = round(pow(10, j / 10.0));
    if (n == last) continue;
    last = n;
    double x = log(n), y = log(curve(alpha, (uint64_t)n));
    sx += x, sy += y, sxx += x * x, sxy += x * y, count++;
  }
  return (sxy - sx * sy / count) / (sxx - sx * sx / count);
}

static void assert_slope(double measured, double expected) {
  if (!(fabs(measured - expected) <= 2e-4)) fail_msg("%.6f, not %.4f", measured, expected);
}

static double variance(double alpha, uint64_t n) {
  return sums_minus(alpha, n) / (double)n / (double)n;
}
static double bias_2d(double alpha, uint64_t n) { return sums_plus(alpha, n) / (double)n; }
static double bias_3d(double alpha, uint64_t n) {
  return sums_power(alpha, 2.0 / 3, n) / (double)n;
}
static double bias_1d(double alpha, uint64_t n) { return sums_power(alpha, 2, n) / (double)n; }

static void test_straight_lines(void **state) {
  (void)state;
  static const struct {
    double alpha;
    int from, to;
    double variance, bias_2d, bias_3d, bias_1d;
  } rows[] = {
      {0.5, 0, 2, -.5925, -.3584, -.2465, -.6323},
      {0.5, 1, 3, -.5162, -.4493, -.3069, -.7852},
      {0.5, 2, 4, -.5018, -.4838, -.3269, -.8563},
      {4. / 7, 1, 3, -.5866, -.3886, -.2639, -.7053},
      {2. / 3, 0, 2, -.7363, -.2424, -.1645, -.4532},
      {2. / 3, 1, 3, -.6801, -.3053, -.2061, -.5759},
      {2. / 3, 2, 4, -.6683, -.3265, -.2189, -.6287},
      {2. / 3, 3, 5, -.6668, -.3318, -.2216, -.6500},
      {.7, 1, 3, -.7126, -.2756, -.1857, -.5254},
      {.75, 1, 3, -.7612, -.2306, -.1550, -.4455},
      {.8, 1, 3, -.8096, -.1852, -.1242, -.3616},
      {.9, 1, 3, -.9055, -.0932, -.0623, -.1847},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    double a = rows[k].alpha;
    int from = rows[k].from, to = rows[k].to;
    assert_slope(slope(variance, a, from, to), rows[k].variance);
    assert_slope(slope(bias_2d, a, from, to), rows[k].bias_2d);
    assert_slope(slope(bias_3d, a, from, to), rows[k].bias_3d);
    assert_slope(slope(bias_1d, a, from, to), rows[k].bias_1d);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      {"S+ and S- are the 60-digit values up to 1e15 terms", test_golden, 0, 0, 0},
      {"alpha may be zero, the smallest number, or one", test_alpha_at_its_ends, 0, 0, 0},
      {"closed forms equal direct sums of 5000 terms", test_direct_sums, 0, 0, 0},
      {"sums of any power equal direct sums of 1e5 terms", test_general_power, 0, 0, 0},
      {"the constant of the sum of squares is the one with Gammas", test_constant_of_squares, 0, 0,
       0},
      {"a straight line through the exact curves has the slopes of theory", test_straight_lines, 0,
       0, 0},
  };
  return cmocka_run_group_tests_name("sums", tests, NULL, NULL);
}
