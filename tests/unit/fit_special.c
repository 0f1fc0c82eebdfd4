// The distributions behind the tests, at sizes the fits meet: from a single draw to 1e9 of them.
#include "analysis/bins.h"
#include "analysis/special.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_cdf.h>
#include <math.h>

static void assert_near(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

static void test_deviate_inverts_quantile(void **state) {
  (void)state;
  for (double variance = 1e-9; variance < 20; variance *= 1.7)
    for (int z = -4; z <= 4; z++) {
      double lower = gsl_cdf_ugaussian_Q(-z);
      double ratio = special_gamma_quantile(lower, variance);
      assert_near(special_gamma_deviate(ratio, variance), z, 1e-5);
    }
}

// Quantiles of chi-squared from tables: 3 and 30 degrees of freedom.
static void test_quantile_of_chi_squared(void **state) {
  (void)state;
  assert_near(special_gamma_quantile(0.025, 2.0 / 3) * 3, 0.2158, 5e-5);
  assert_near(special_gamma_quantile(0.975, 2.0 / 3) * 3, 9.3484, 5e-5);
  assert_near(special_gamma_quantile(0.025, 2.0 / 30) * 30, 16.7908, 5e-5);
  assert_near(special_gamma_quantile(0.975, 2.0 / 30) * 30, 46.9792, 5e-5);
}

// With 1e9 draws a gamma is normal, but for a skewness of 6e-5.
static void test_deviate_of_many(void **state) {
  (void)state;
  for (int z = -4; z <= 4; z++)
    assert_near(special_gamma_deviate(1 + z * sqrt(1e-9), 1e-9), z, 2e-4);
}

// The two ways meet: from one to the other side of the seam a deviate changes by no more than that.
static void test_deviate_has_no_seam(void **state) {
  (void)state;
  for (int z = -4; z <= 4; z++) {
    double ratio = 1 + z * 0.01;
    double below = special_gamma_deviate(ratio, 0.9999999e-4);
    assert_near(special_gamma_deviate(ratio, 1.0000001e-4), below, 1e-4);
  }
}

// Chi-squared with 2 degrees of freedom is exponential: P(ratio > x) = e^-x at relative variance 1.
static void test_deviate_of_exponential(void **state) {
  (void)state;
  for (double x = 0.5; x < 40; x *= 2)
    assert_near(gsl_cdf_ugaussian_Q(special_gamma_deviate(x, 1)) / exp(-x), 1, 1e-9);
}

// Far beyond the range of doubles it still says how far, and goes on rising.
static void test_deviate_far_out(void **state) {
  (void)state;
  double last = special_gamma_deviate(2, 0.01);
  for (double ratio = 4; ratio < 1e6; ratio *= 4) {
    double z = special_gamma_deviate(ratio, 0.01);
    assert_true(isfinite(z) && z > last);
    last = z;
  }
  assert_true(special_gamma_deviate(0, 0.01) < -20);
}

static void test_tails(void **state) {
  (void)state;
  assert_near(special_two_sided(1.959963984540054), 0.05, 1e-15);
  assert_near(special_normal_quantile(0.025), 1.959963984540054, 1e-14);
  assert_near(special_chi2_upper(3.841458820694124, 1), 0.05, 1e-14);
  assert_near(special_chi2_upper(7, 2), exp(-3.5), 1e-15);
  assert_near(special_zeta(2), 1.6449340668482264, 1e-15);
}

// Tables of Student's t and of F, 5 % and 1 %; with one degree of freedom t is Cauchy's.
static void test_variance_that_was_estimated(void **state) {
  (void)state;
  assert_near(special_t_quantile(0.025, 4), 2.7764, 5e-5);
  assert_near(special_t_quantile(0.005, 10), 3.1693, 5e-5);
  assert_near(special_t_two_sided(-3, 1), 1 - 2 * atan(3) / 3.14159265358979323846, 1e-12);
  assert_near(special_f_upper(5 * 3.3258, 5, 10), 0.05, 5e-6);
  assert_near(special_f_upper(0, 5, 10), 1, 0);
}

// Where the normal and chi-squared take over nothing jumps.
static void test_many_degrees_of_freedom(void **state) {
  (void)state;
  for (int z = 1; z <= 5; z++) {
    double tail = special_t_two_sided(z, 9999), beyond = special_t_two_sided(z, 10001);
    assert_near(tail / beyond, 1, pow(z * z + 1, 2) / 4e4 + 1e-4);
  }
  for (double chi2 = 10; chi2 <= 60; chi2 += 10)
    assert_near(special_f_upper(chi2, 25, 9999) / special_f_upper(chi2, 25, 10001), 1, 0.05);
}

static void test_quadrature(void **state) {
  (void)state;
  double x[64], weight[64], sum = 0, power = 0;
  special_gauss_legendre(64, x, weight);
  for (int k = 0; k < 64; k++) sum += weight[k], power += weight[k] * pow(x[k], 127);
  assert_near(sum, 1, 1e-15);
  assert_near(power * 128, 1, 1e-12);
}

// Fitted directions carry nothing: the deviates 3, 4 along the direction (3, 4) leave no
// chi-squared.
static void test_projection(void **state) {
  (void)state;
  const double deviate[] = {3, 4, 2}, prior[SOLVE_MAX] = {0};
  const double direction[][SOLVE_MAX] = {{0.3}, {0.4}, {0}};
  struct chi2 chi2 = bins_chi2(3, deviate, direction, 1, prior);
  assert_near(chi2.value, 4, 1e-14);
  assert_near(chi2.dof, 2, 0);
  // A parameter with a prior takes no degree of freedom: 29 - 25 b^2 / (1 + ...) of its share.
  const double known[SOLVE_MAX] = {0.25};
  chi2 = bins_chi2(3, deviate, direction, 1, known);
  assert_near(chi2.value, 29 - 2.5 * 2.5 / (0.25 + 0.25), 1e-13);
  assert_near(chi2.dof, 3, 0);
}

static void test_bins_cover_all(void **state) {
  (void)state;
  struct arena arena = arena_reserve();
  double information[1000];
  for (int j = 0; j < 1000; j++) information[j] = 0.385;
  for (uint64_t first = 0; first < 990; first += 97) {
    struct bins bins = bins_new(information, first, 1000, 2, &arena);
    uint64_t start = first;
    for (int b = 0; b < bins.n; b++) {
      assert_true((double)(bins.end[b] - start) * 0.385 >= 2);
      start = bins.end[b];
    }
    assert_int_equal(start, 1000);
  }
  arena_release(arena);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      {"a gamma's deviate undoes its quantile, relative variance 1e-9 to 20",
       test_deviate_inverts_quantile, 0, 0, 0},
      {"quantiles of chi-squared are the tables'", test_quantile_of_chi_squared, 0, 0, 0},
      {"at relative variance 1e-9 it is normal", test_deviate_of_many, 0, 0, 0},
      {"the two ways to a deviate meet", test_deviate_has_no_seam, 0, 0, 0},
      {"at relative variance 1 it is exponential", test_deviate_of_exponential, 0, 0, 0},
      {"far tails rise on", test_deviate_far_out, 0, 0, 0},
      {"tails and constants are the known ones", test_tails, 0, 0, 0},
      {"t and F are the tables'", test_variance_that_was_estimated, 0, 0, 0},
      {"t becomes normal and F chi-squared", test_many_degrees_of_freedom, 0, 0, 0},
      {"64 nodes integrate x^127 over [0, 1]", test_quadrature, 0, 0, 0},
      {"chi-squared loses what was fitted", test_projection, 0, 0, 0},
      {"bins cover all iterations and hold enough", test_bins_cover_all, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fit_special", tests, NULL, NULL);
}
