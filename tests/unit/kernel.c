// Kernels: closed forms against quadrature and against the table of theory 1.2.
#include "density/kernel.h"

#include "base/simd.h"
#include "numeric/elementary.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_integration.h>

// The integrand of a moment: t^(d-1+power) psi(t)^exponent over [0, 1], psi / psi(0) from the row.
struct moment {
  const struct kernel *kernel;
  int power, exponent;
};

static double integrand(double t, void *data) {
  const struct moment *m = data;
  double t2 = t * t, w;
  kernel_weigh(m->kernel, &t2, 1, &w, 1);
  return pow(t, m->power) * (m->exponent == 2 ? w * w : w);
}

// In d dimensions, per unit of psi(0)^exponent: sphere's measure times the radial integral.
static double radial_integral(const struct kernel *kernel, int d, int power, int exponent) {
  static const double sphere[] = {0, 2, 2 * M_PI, 4 * M_PI};
  struct moment m = {kernel, d - 1 + power, exponent};
  gsl_function f = {integrand, &m};
  gsl_integration_workspace *space = gsl_integration_workspace_alloc(200);
  double result, error;
  int status =
      gsl_integration_qag(&f, 0, 1, 0, 1e-12, 200, GSL_INTEG_GAUSS41, space, &result, &error);
  gsl_integration_workspace_free(space);
  assert_int_equal(status, 0);
  return sphere[d] * result;
}

static void near(double got, double want, double relative, const char *kernel, int d,
                 const char *what) {
  if (!(fabs(got - want) <= relative * fabs(want)))
    fail_msg("%s, d = %d: %s is %.17g, not %.17g", kernel, d, what, got, want);
}

static void constants_are_the_integrals_of_the_shape(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++)
    for (int d = 1; d <= 3; d++) {
      const struct kernel *kernel = &kernels[k];
      struct kernel_constants c = kernel->constants(d);
      near(c.c * radial_integral(kernel, d, 0, 1), 1, 1e-10, kernel->name, d, "the integral");
      near(c.mu2, c.c * radial_integral(kernel, d, 2, 1) / d, 1e-10, kernel->name, d, "mu2");
      near(c.roughness, c.c * c.c * radial_integral(kernel, d, 0, 2), 1e-10, kernel->name, d, "R");
      near(c.roughness2, c.c * c.c * radial_integral(kernel, d, 2, 2), 1e-10, kernel->name, d,
           "R2");
    }
}

// Theory 1.2; eight digits where it prints eight. NAN: not printed there.
static void constants_are_those_of_the_table(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int d;
    double c, mu2, roughness, roughness2;
  } table[] = {
      {"box", 1, 0.5, 1.0 / 3, 0.5, .16666667},
      {"epanechnikov", 1, 0.75, 0.2, 0.6, .08571429},
      {"biweight", 1, 15.0 / 16, 1.0 / 7, 5.0 / 7, .06493506},
      {"triweight", 1, 35.0 / 32, 1.0 / 9, 350.0 / 429, .05439005},
      {"cone", 1, 1, 1.0 / 6, 2.0 / 3, .06666667},
      {"gaussian", 1, 1.20006678, .1081485, .85085374, .04724990},
      {"quintic", 1, 1, 5.0 / 42, 0.783549784, NAN},
      {"box", 2, 1 / M_PI, 0.25, 1 / M_PI, .15915494},
      {"epanechnikov", 2, 2 / M_PI, 1.0 / 6, 4 / (3 * M_PI), .10610330},
      {"biweight", 2, 3 / M_PI, 1.0 / 8, 9 / (5 * M_PI), .09549297},
      {"triweight", 2, 4 / M_PI, 0.1, 16 / (7 * M_PI), .09094568},
      {"cone", 2, 3 / M_PI, 0.15, 3 / (2 * M_PI), .09549297},
      {"gaussian", 2, 1.44848571, .1054942, .73228847, .08127500},
      {"quintic", 2, 7 / (2 * M_PI), 5.0 / 48, 287 / (132 * M_PI), NAN},
      {"box", 3, 3 / (4 * M_PI), 0.2, 3 / (4 * M_PI), .14323945},
      {"epanechnikov", 3, 15 / (8 * M_PI), 1.0 / 7, 15 / (14 * M_PI), .11368210},
      {"biweight", 3, 105 / (32 * M_PI), 1.0 / 9, .50640209, .11686202},
      {"triweight", 3, 315 / (64 * M_PI), 1.0 / 11, .70117213, .12373626},
      {"cone", 3, 3 / M_PI, 2.0 / 15, .38197186, .10913482},
      {"gaussian", 3, 1.76605756, .1019800, .64295368, .10689023},
      {"quintic", 3, 1.336901522, 7.0 / 75, 0.666892601, NAN},
  };
  for (size_t k = 0; k < sizeof table / sizeof table[0]; k++) {
    const struct kernel *kernel = kernel_find(table[k].name);
    assert_non_null(kernel);
    struct kernel_constants c = kernel->constants(table[k].d);
    // Half a unit of the last printed digit, or exact.
    near(c.c, table[k].c, 1e-8, table[k].name, table[k].d, "c");
    near(c.mu2, table[k].mu2, 6e-7, table[k].name, table[k].d, "mu2");
    near(c.roughness, table[k].roughness, 1e-8, table[k].name, table[k].d, "R");
    if (!isnan(table[k].roughness2))
      near(c.roughness2, table[k].roughness2, 1e-7, table[k].name, table[k].d, "R2");
  }
}

static void shapes_start_at_one_and_never_rise(void **state) {
  (void)state;
  enum { N = 1000 };
  double t2[N], w[N];
  for (int j = 0; j < N; j++) t2[j] = (double)j / N;
  for (int k = 0; k < n_kernels; k++) {
    kernel_weigh(&kernels[k], t2, 1, w, N);
    assert_true(w[0] == 1);
    for (int j = 1; j < N; j++) assert_true(w[j] <= w[j - 1] && w[j] > 0);
  }
}

// A value does not depend on how many are asked for: one at a time, or in arrays.
static void shapes_of_arrays_are_shapes_of_their_elements(void **state) {
  (void)state;
  enum { N = 19 };
  double t2[N], w[N], one;
  for (int j = 0; j < N; j++) t2[j] = 0.9999 * j / N;
  for (int k = 0; k < n_kernels; k++)
    for (int n = 0; n <= N; n++) {
      for (int j = 0; j < N; j++) w[j] = 2.385;
      kernel_weigh(&kernels[k], t2, 1, w, n);
      for (int j = 0; j < n; j++) {
        kernel_weigh(&kernels[k], &t2[j], 1, &one, 1);
        assert_true(w[j] == one);
      }
      for (int j = n; j < N; j++) assert_true(w[j] == 2.385);
    }
}

// The plain formulas, one value at a time; a kernel that is added has none here: NaN.
static double formula(const char *name, double t2) {
  double t = sqrt(t2), rest = 1 - t;
  const struct {
    const char *name;
    double value;
  } row[] = {
      {"box", 1},
      {"cone", 1 - t},
      {"epanechnikov", 1 - t2},
      {"biweight", (1 - t2) * (1 - t2)},
      {"triweight", (1 - t2) * (1 - t2) * (1 - t2)},
      {"gaussian", num_exp(-4.5 * t2)},
      {"quintic", rest * rest * rest * (1 + 3 * t + 6 * t2)},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++)
    if (strcmp(row[k].name, name) == 0) return row[k].value;
  return NAN;
}

static void shapes_have_the_same_bits_at_every_level(void **state) {
  (void)state;
  enum { N = 2000 };
  static double d2[N], w[N], scalar[N];
  double r = 0.7;
  for (int j = 0; j < N; j++) d2[j] = 0.55 * j / N;
  d2[1] = r * r, d2[2] = INFINITY, d2[3] = NAN;
  for (int k = 0; k < n_kernels; k++) {
    simd_choose(SIMD_SCALAR);
    kernel_weigh(&kernels[k], d2, r, scalar, N);
    for (int level = 0; level <= (int)simd_best(); level++) {
      simd_choose((enum simd)level);
      int within = kernel_weigh(&kernels[k], d2, r, w, N), expected = 0;
      for (int j = 0; j < N; j++) {
        double t2 = d2[j] * (1 / (r * r)), plain = formula(kernels[k].name, t2);
        expected += t2 < 1;
        assert_true(w[j] == scalar[j]);
        assert_true(isnan(plain) || w[j] == (t2 < 1 ? plain : 0));
      }
      assert_int_equal(within, expected);
    }
  }
}

static void values_are_zero_from_the_support_on(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++)
    for (int d = 1; d <= 3; d++) {
      assert_true(kernel_value(&kernels[k], d, 0) == kernels[k].constants(d).c);
      assert_true(kernel_value(&kernels[k], d, 0.999) > 0);
      assert_true(kernel_value(&kernels[k], d, 1) == 0);
      assert_true(kernel_value(&kernels[k], d, 1.0000001) == 0);
    }
  // Three standard deviations in the support: at |u| = 1/2, exp(-9/8).
  double c = 9 / (2 * M_PI * (1 - exp(-4.5)));
  near(kernel_value(kernel_find("gaussian"), 2, 0.25), c * exp(-1.125), 1e-14, "gaussian", 2,
       "the value at 1/2");
}

static void names_find_their_rows(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++) assert_ptr_equal(kernel_find(kernels[k].name), &kernels[k]);
  assert_null(kernel_find("boxx"));
  assert_null(kernel_find(""));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(constants_are_the_integrals_of_the_shape),
      cmocka_unit_test(constants_are_those_of_the_table),
      cmocka_unit_test(shapes_start_at_one_and_never_rise),
      cmocka_unit_test(shapes_of_arrays_are_shapes_of_their_elements),
      cmocka_unit_test(shapes_have_the_same_bits_at_every_level),
      cmocka_unit_test(values_are_zero_from_the_support_on),
      cmocka_unit_test(names_find_their_rows),
  };
  return cmocka_run_group_tests_name("kernel", tests, NULL, NULL);
}
