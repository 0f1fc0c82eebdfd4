// Pixel filters: every row's samples against its density, integrated numerically, and the error
// function that the Gaussian needs against 60-digit values.
#include "numeric/elementary.h"
#include "scene/scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// ---- densities, not normalised, |x| <= r ----
static double box(double x, double r, double sigma) { return (void)x, (void)r, (void)sigma, 1; }
static double triangle(double x, double r, double sigma) { return (void)sigma, r - fabs(x); }
static double gaussian(double x, double r, double sigma) {
  return exp(-x * x / (2 * sigma * sigma)) - exp(-r * r / (2 * sigma * sigma));
}

static const struct {
  const char *name;
  double (*density)(double x, double r, double sigma);
  double radius, sigma; // by default
} known[] = {{"box", box, 0.5, 0}, {"gaussian", gaussian, 1.5, 0.5}, {"triangle", triangle, 2, 0}};
enum { N_KNOWN = sizeof known / sizeof *known };

static int number_of(const char *name) {
  for (int k = 0; k < N_KNOWN; k++)
    if (!strcmp(known[k].name, name)) return k;
  fail_msg("filter \"%s\" has no density here", name);
  return -1;
}

// Gauss's rule of 5 points on 64 parts: of degree 9, so exact to rounding on each smooth half.
static double integral(int k, double from, double to, double r, double sigma) {
  static const double at[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                               0.9061798459386640};
  static const double weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                   0.4786286704993665, 0.2369268850561891};
  double sum = 0, half = (to - from) / 128;
  for (int i = 0; i < 64; i++)
    for (int j = 0; j < 5; j++)
      sum += weight[j] * half * known[k].density(from + (2 * i + 1 + at[j]) * half, r, sigma);
  return sum;
}

static double share_below(int k, double x, double r, double sigma) {
  double left = integral(k, -r, x < 0 ? x : 0, r, sigma);
  double right = x > 0 ? integral(k, 0, x, r, sigma) : 0;
  return (left + right) / (2 * integral(k, 0, r, r, sigma));
}

static struct filter filter_default(const struct filter_type *type) {
  struct problem problem = {{0}};
  struct params none = {.directive = "PixelFilter", .problem = &problem};
  struct filter filter = {.type = type};
  assert_true(type->read(&filter, &none));
  return filter;
}

// The share of the density below a sample is the number it was made from, in x and y.
static void check_quantiles(const struct filter *filter) {
  int k = number_of(filter->type->name);
  for (int i = 0; i < 400; i++) {
    double u[2] = {i / 400.0, (399 - i + 0.385) / 400}, offset[2];
    filter->type->sample(filter, u, offset);
    for (int axis = 0; axis < 2; axis++) {
      double r = filter->radius[axis];
      assert_true(offset[axis] >= -r && offset[axis] <= r);
      // Rounding of the sums and of u, magnified where 1 - u is all that is left: a few 1e-16 each.
      double share = share_below(k, offset[axis], r, filter->sigma);
      if (!(fabs(share - u[axis]) <= 1e-13))
        fail_msg("%s: %.17g of the density is below the sample of %.17g", filter->type->name, share,
                 u[axis]);
      double got = filter->type->density(filter, axis, offset[axis]), peak = 1 / r;
      double wanted = known[k].density(offset[axis], r, filter->sigma) /
                      (2 * integral(k, 0, r, r, filter->sigma));
      if (!(fabs(got - wanted) <= 1e-11 * peak))
        fail_msg("%s: density %.17g, not %.17g", filter->type->name, got, wanted);
    }
  }
}

static void there_is_no_density_beyond_the_radius(void **state) {
  (void)state;
  for (int k = 0; filter_types[k]; k++) {
    struct filter filter = filter_default(filter_types[k]);
    for (int axis = 0; axis < 2; axis++) {
      double r = filter.radius[axis];
      assert_true(filter.type->density(&filter, axis, 1.001 * r) == 0);
      assert_true(filter.type->density(&filter, axis, -1.001 * r) == 0);
      // Two pixels of a box do not both hold the line between them.
      assert_true(filter.type->density(&filter, axis, r) == 0);
    }
  }
}

static void samples_follow_the_density_of_every_filter(void **state) {
  (void)state;
  for (int k = 0; filter_types[k]; k++) {
    struct filter filter = filter_default(filter_types[k]);
    check_quantiles(&filter);
    filter.radius[0] = 3.7, filter.radius[1] = 0.43;
    check_quantiles(&filter);
  }
}

// From nearly a parabola to a spike with long tails.
static void a_gaussian_may_be_wide_or_narrow(void **state) {
  (void)state;
  static const double sigma[] = {0.06, 0.3, 2.385, 7};
  for (int k = 0; k < 4; k++) {
    struct filter filter = filter_default(filter_find("gaussian"));
    filter.sigma = sigma[k];
    check_quantiles(&filter);
  }
}

static void radii_are_pbrts(void **state) {
  (void)state;
  for (int k = 0; filter_types[k]; k++) {
    struct filter filter = filter_default(filter_types[k]);
    int row = number_of(filter.type->name);
    assert_true(filter.radius[0] == known[row].radius && filter.radius[1] == known[row].radius);
    assert_true(filter.sigma == known[row].sigma);
  }
}

static void the_error_function_is_right_to_a_few_ulp(void **state) {
  (void)state;
  static const double golden[][2] = {
      {0x0.0p+0, 0x0.0p+0},
      {0x0.0000000000001p-1022, 0x0.0000000000001p-1022},
      {0x1.56e1fc2f8f359p-997, 0x1.82e6d98711d3ap-997},
      {0x1.12e0be826d695p-30, 0x1.362a9ffc610ddp-30},
      {0x1.999999999999ap-4, 0x1.cca5ea24fb334p-4},
      {0x1.0000000000000p-2, 0x1.1af54e232d609p-2},
      {0x1.0000000000000p-1, 0x1.0a7ef5c18edd2p-1},
      {0x1.8000000000000p-1, 0x1.6c1c9759d0e5fp-1},
      {0x1.0000000000000p+0, 0x1.af767a741088bp-1},
      {0x1.199999999999ap+0, 0x1.c2aa3d27302c0p-1},
      {0x1.8000000000000p+0, 0x1.eea5557137ae0p-1},
      {0x1.0000000000000p+1, 0x1.fd9ae142795e3p-1},
      {0x1.3147ae147ae14p+1, 0x1.ff9e81d4ea9f3p-1},
      {0x1.8000000000000p+1, 0x1.fffd1ac4135f9p-1},
      {0x1.d99999999999ap+1, 0x1.fffffa642eefcp-1},
      {0x1.2000000000000p+2, 0x1.fffffffe4fa30p-1},
      {0x1.4000000000000p+2, 0x1.fffffffffc9e8p-1},
      {0x1.799999999999ap+2, 0x1.fffffffffffffp-1},
      {0x1.7ffffbce4217dp+2, 0x1.0000000000000p+0},
      {0x1.8000000000000p+2, 0x1.0000000000000p+0},
      {0x1.a000000000000p+2, 0x1.0000000000000p+0},
      {30, 0x1.0000000000000p+0},
      {-0x1.3333333333333p-2, -0x1.50838881dea0fp-2},
      {-0x1.6000000000000p+1, -0x1.fff2cfb0453d9p-1},
  };
  for (size_t k = 0; k < sizeof golden / sizeof *golden; k++) {
    double got = num_erf(golden[k][0]), wanted = golden[k][1];
    // exp: 1 ulp; its argument x^2 is rounded: up to x^2 / 2 ulp; the sum: a few.
    double ulp = nextafter(fabs(wanted), INFINITY) - fabs(wanted);
    if (!(fabs(got - wanted) <= (6 + 36 / 2) * ulp))
      fail_msg("erf(%.17g) = %.17g, not %.17g", golden[k][0], got, wanted);
  }
  assert_true(isnan(num_erf(NAN)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(samples_follow_the_density_of_every_filter),
      cmocka_unit_test(there_is_no_density_beyond_the_radius),
      cmocka_unit_test(a_gaussian_may_be_wide_or_narrow),
      cmocka_unit_test(radii_are_pbrts),
      cmocka_unit_test(the_error_function_is_right_to_a_few_ulp),
  };
  return cmocka_run_group_tests_name("filter", tests, NULL, NULL);
}
