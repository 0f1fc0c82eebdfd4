// The curves that the fit writes for figures: averages and bins of single iterations, measured and
// predicted.
#define _GNU_SOURCE // mkdtemp
#include "fit_fixture.h"

static const struct fit_point *point_at(const struct fit *fit, enum quantity quantity,
                                        enum curve_series series, int c) {
  for (int p = 0; p < fit->n_points; p++) {
    const struct fit_point *point = &fit->point[p];
    if (point->row->quantity == quantity && point->series == series && c-- == 0) return point;
  }
  fail_msg("no such point");
  return NULL;
}

// Checkpoints at N / 2 and N, for variance and bias, of single iterations and their average.
static void test_curves(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  const char *text = written(&fit, fit_write_curves);
  assert_int_equal(count_lines(text), 1 + 8);
  for (int k = 0; k < CELL_KEYS; k++) { // the first columns, in this order
    size_t length = strlen(cell_keys[k].name);
    assert_memory_equal(text, cell_keys[k].name, length);
    assert_int_equal(text[length], ',');
    text += length + 1;
  }
  const char *rest = "x,y,quantity,series,first,N,measured,lower,upper,pooled,predicted\n";
  assert_memory_equal(text, rest, strlen(rest));
  assert_non_null(strstr(text, ",variance,iteration,151,300,"));
  assert_non_null(strstr(text, ",bias,average,1,300,"));
  assert_int_equal(fit.n_points, 8);
  for (int p = 0; p < 8; p++) {
    const struct fit_point *point = &fit.point[p];
    assert_true(point->lower < point->measured && point->measured < point->upper);
  }
}

// Averages are made of their iterations: with m of them in a bin, the bias of the average is the
// sum of m bias / N, and its variance, as independent iterations have it, that of m variance / N^2.
static void test_bins_make_the_average(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  double variance = 0, bias = 0;
  for (int c = 0; c < 2; c++) {
    const struct fit_point *of_variance = point_at(&fit, QUANTITY_VARIANCE, CURVE_ITERATION, c);
    const struct fit_point *of_bias = point_at(&fit, QUANTITY_BIAS, CURVE_ITERATION, c);
    const struct fit_point *average = point_at(&fit, QUANTITY_VARIANCE, CURVE_AVERAGE, c);
    double n = (double)of_bias->n;
    assert_true(of_bias->first == (c == 0 ? 1 : 151) && of_variance->first == of_bias->first);
    assert_true(average->first == 1 && average->n == of_variance->n);
    variance += (n - (double)of_variance->first + 1) * of_variance->measured;
    bias += (n - (double)of_bias->first + 1) * of_bias->measured;
    assert_true(fabs(variance / (n * n) / average->pooled - 1) < 1e-12);
    double measured = point_at(&fit, QUANTITY_BIAS, CURVE_AVERAGE, c)->measured;
    assert_true(fabs(bias / n / measured - 1) < 1e-12);
  }
}

static double late(double alpha, double rho, uint64_t i) {
  (void)alpha;
  return i <= 150 ? 1e-12 : rho;
}

// At the first checkpoint no photon was found, and the fit begins later.
static void test_curve_that_begins_dark(void **state) {
  (void)state;
  struct synthetic s = base;
  s.closed_form = false, s.r2 = late;
  struct prediction theory = synthetic_prediction(&s, &arena);
  theory.first = 200;
  struct fit fit = synthetic_fit_with(&s, &theory, 1, &arena);
  for (int k = 0; k < N_CURVE_SERIES; k++) {
    const struct fit_point *dark = point_at(&fit, QUANTITY_VARIANCE, k, 0);
    const struct fit_point *lit = point_at(&fit, QUANTITY_VARIANCE, k, 1);
    assert_true(dark->measured == 0 && isnan(dark->lower));
    assert_true(lit->lower < lit->measured);
  }
  assert_int_equal(fit.row[0].first, 201);
  // This bin begins at 151, before what is predicted.
  assert_true(isnan(point_at(&fit, QUANTITY_VARIANCE, CURVE_ITERATION, 1)->predicted));
}

// A photon that was hardly to be expected (0.002 in all): no interval rather than one without it.
static void test_interval_of_a_lucky_photon(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: lucky", s.photons_1 = 1e-4, s.iterations = 10, s.runs = 2, s.curvature = 0;
  int found = 0;
  for (uint64_t e = 1; e <= 3000; e++) {
    struct arena scratch = arena;
    struct fit fit = synthetic_fit(&s, e, &scratch);
    for (int p = 0; p < fit.n_points; p++) {
      const struct fit_point *point = &fit.point[p];
      assert_false(point->measured < point->lower || point->measured > point->upper);
      found += point->row->quantity == QUANTITY_VARIANCE && point->measured > 0;
    }
  }
  assert_true(found > 0);
}

// With two runs of one iteration the variance has one degree of freedom, nearly: the interval is
// Cauchy's, 12.7 standard errors to either side, and not 1.96.
static void test_interval_of_two_values(void **state) {
  (void)state;
  struct synthetic s = base;
  s.gaussian = true, s.iterations = 1, s.runs = 2, s.photons_1 = 1e4;
  struct fit fit = synthetic_fit(&s, 1, &arena);
  for (int k = 0; k < N_CURVE_SERIES; k++) {
    const struct fit_point *point = point_at(&fit, QUANTITY_BIAS, k, 0);
    double se = sqrt(point_at(&fit, QUANTITY_VARIANCE, k, 0)->measured / 2);
    assert_true(fabs((point->upper - point->lower) / 2 / se - 12.706) < 0.01);
  }
}

// The predicted curves are theory 3.2's: (A S- + C N) / N^2 and b_1 S+ / N, for the quadratic
// profile; of the m single iterations of a bin (A (S- from first to N) + C m) / m and the like. C =
// (R_2 Laplacian / 4 q - mu^2) / N_e; with r_1 = 1 and E = 1 - d^2 / 2 the box has A = 1 /
// lambda_1, b_1 = -1/4 and the middle term -A / 4; mu^2 / N_e is 1e-9.
static void test_predicted_curves(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  const struct law *law = law_find("knaus-zwicker");
  for (int p = 0; p < 8; p++) {
    const struct fit_point *point = &fit.point[p];
    double m = (double)(point->n - point->first + 1), minus = 0, plus = 0;
    for (uint64_t i = point->first; i <= point->n; i++) {
      minus += 1 / law->rho(base.alpha, i);
      plus += law->rho(base.alpha, i);
    }
    double variance = (minus - m / 4) / 50 / m;
    if (point->series == CURVE_AVERAGE) variance /= m;
    double expected = point->row->quantity == QUANTITY_BIAS ? -0.25 * plus / m : variance;
    assert_true(fabs(point->predicted / expected - 1) < 1e-6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      {"curves.csv has a line per checkpoint, quantity and series", test_curves, 0, 0, 0},
      {"the bins of single iterations make up the average", test_bins_make_the_average, 0, 0, 0},
      {"a curve may begin before any light", test_curve_that_begins_dark, 0, 0, 0},
      {"an interval holds what was measured or is not stated", test_interval_of_a_lucky_photon, 0,
       0, 0},
      {"two values have Cauchy's interval", test_interval_of_two_values, 0, 0, 0},
      {"the predicted curves are those of theory 3.2", test_predicted_curves, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fit_curves", tests, make_folder, remove_folder);
}
