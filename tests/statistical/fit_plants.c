// What the fit must notice. Each planted defect is many standard errors away at this size (the
// smallest, reuse, multiplies a variance by more than 100), so a run that does not disagree has a
// probability far below 1e-4; and without defect nothing is found.
#include "tests/statistical/fit_synthetic.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct arena arena;

static const struct synthetic base = {.name = "fit: plants",
                                      .alpha = 2.0 / 3,
                                      .iterations = 1000,
                                      .runs = 32,
                                      .photons_1 = 50,
                                      .curvature = 0.5,
                                      .closed_form = true};

static struct fit fit_of(const struct synthetic *s) { return synthetic_fit(s, 1, &arena); }

static void assert_rejects(const struct fit_row *row, const char *name) {
  const struct fit_test *test = synthetic_test(row, name);
  assert_non_null(test);
  if (!test->rejects) fail_msg("%s: p = %g", name, test->p);
  assert_int_equal(row->verdict, VERDICT_DISAGREE);
}

static void test_no_defect(void **state) {
  (void)state;
  struct fit fit = fit_of(&base);
  assert_int_equal(fit.verdict, VERDICT_AGREE);
  assert_int_equal(fit.row[0].verdict, VERDICT_AGREE);
  assert_int_equal(fit.row[1].verdict, VERDICT_AGREE);
}

// Updated before the first pass: rho'_i = alpha rho_i.
static double before_first(double alpha, double rho, uint64_t i) {
  (void)i;
  return alpha * rho;
}

static void test_zero_based_index(void **state) {
  (void)state;
  struct synthetic s = base;
  s.r2 = before_first;
  struct fit fit = fit_of(&s);
  assert_int_equal(fit.verdict, VERDICT_DISAGREE);
  assert_rejects(&fit.row[0], "coefficient");
  assert_rejects(&fit.row[1], "coefficient");
}

// The law for volumes, r^3, on a surface: r^2 goes as rho^(2/3).
static double cubed(double alpha, double rho, uint64_t i) {
  (void)alpha, (void)i;
  return cbrt(rho * rho);
}

static void test_volume_law(void **state) {
  (void)state;
  struct synthetic s = base;
  s.r2 = cubed;
  struct fit fit = fit_of(&s);
  assert_rejects(&fit.row[0], "rate");
  assert_rejects(&fit.row[1], "rate");
  // The rate alone gives it away, 0.11 too large; without its first discs it is known to 0.0175.
  s.closed_form = false, s.runs = 400;
  fit = fit_of(&s);
  assert_rejects(&fit.row[0], "rate");
}

static double never_shrinks(double alpha, double rho, uint64_t i) {
  (void)alpha, (void)rho, (void)i;
  return 1;
}

static void test_fixed_radius(void **state) {
  (void)state;
  struct synthetic s = base;
  s.r2 = never_shrinks;
  struct fit fit = fit_of(&s);
  assert_rejects(&fit.row[0], "rate");
  assert_rejects(&fit.row[1], "rate");
}

static double shrinks(double alpha, double rho, uint64_t i) {
  (void)rho;
  return law_find("knaus-zwicker")->rho(alpha, i);
}

// Theory's own radius is constant: variance falls as 1/N and bias, which does not fall, has the
// rate 0, with and without closed form. One that shrinks all the same is found out. The standard
// errors of the rates are sqrt(2 / ((K - 1) N)) = 0.008 and sqrt(V / (K N)) / |b| = 0.003.
static void test_constant_radius(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: constant radius", s.law = "fixed", s.reference_se = 0.001;
  for (int k = 0; k < 2; k++) {
    s.closed_form = k == 0;
    struct fit fit = fit_of(&s);
    assert_int_equal(fit.row[0].verdict, VERDICT_AGREE);
    assert_int_equal(fit.row[1].verdict, VERDICT_AGREE);
    assert_true(fit.row[0].rate_theory == 1 && fabs(fit.row[0].rate - 1) < 0.05);
    assert_true(fit.row[1].rate_theory == 0 && fabs(fit.row[1].rate) < 0.05);
    struct synthetic wrong = s;
    wrong.r2 = shrinks;
    fit = fit_of(&wrong);
    assert_rejects(&fit.row[0], "rate");
    assert_rejects(&fit.row[1], "rate");
    s.curvature = 0;
    fit = fit_of(&s);
    assert_int_equal(fit.row[1].verdict, VERDICT_NOT_DETECTED);
    s.curvature = base.curvature;
  }
}

// A truncated Gaussian that was not normalised: 0.989 of what it should be.
static void test_unnormalised_kernel(void **state) {
  (void)state;
  struct synthetic s = base;
  s.factor = 0.989;
  struct fit fit = fit_of(&s);
  assert_rejects(&fit.row[1], "coefficient");
  s.factor = 0.5312;
  fit = fit_of(&s);
  assert_rejects(&fit.row[0], "coefficient");
}

static void test_reused_seed(void **state) {
  (void)state;
  struct synthetic s = base;
  s.reuse = true;
  struct fit fit = fit_of(&s);
  assert_rejects(&fit.row[0], "independence");
  assert_rejects(&fit.row[1], "independence");
}

// A13: at least 95 % of 200; at the family-wise 1 % five failures have probability 0.05, ten 2e-5.
static void test_zero_bias(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: zero bias", s.curvature = 0, s.iterations = 300, s.runs = 20;
  int not_detected = 0;
  for (uint64_t e = 1; e <= 200; e++) {
    struct arena scratch = arena;
    struct fit fit = synthetic_fit(&s, e, &scratch);
    not_detected += fit.row[1].verdict == VERDICT_NOT_DETECTED;
    assert_false(isfinite(fit.row[1].rate));
    assert_false(isfinite(fit.row[1].rate_theory));
  }
  assert_in_range(not_detected, 190, 200);
}

// Nothing is known without closed form, and the bias is a hundredth of what could be seen.
static void test_nothing_to_see(void **state) {
  (void)state;
  struct synthetic s = base;
  s.closed_form = false, s.curvature = 1e-4, s.runs = 8, s.iterations = 200;
  struct fit fit = fit_of(&s);
  assert_int_equal(fit.row[1].verdict, VERDICT_NOT_DETECTED);
  assert_true(fit.row[1].upper_bound >= 1e-4 / 2);
  s.runs = 1;
  fit = fit_of(&s);
  assert_int_equal(fit.row[0].verdict, VERDICT_NOT_RESOLVABLE);
  assert_int_equal(fit.verdict, VERDICT_NOT_RESOLVABLE);
}

// One iteration has no rate, but its coefficients are tested all the same.
static void test_one_iteration(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: one iteration", s.iterations = 1, s.runs = 1000;
  struct fit fit = fit_of(&s);
  assert_int_equal(fit.verdict, VERDICT_NOT_RESOLVABLE);
  s.factor = 0.5312;
  fit = fit_of(&s);
  assert_rejects(&fit.row[0], "coefficient");
  assert_rejects(&fit.row[1], "coefficient");
}

// Nothing arrives where theory expects 1600 photons in the first iterations alone.
static void test_black(void **state) {
  (void)state;
  struct synthetic s = base;
  s.black = true;
  struct fit fit = fit_of(&s);
  assert_rejects(&fit.row[0], "silence");
  assert_rejects(&fit.row[1], "silence");
  s.photons_1 = 1e-6; // now it is no wonder
  fit = fit_of(&s);
  assert_int_equal(fit.verdict, VERDICT_NOT_RESOLVABLE);
  assert_true(synthetic_test(&fit.row[0], "silence")->p > 0.9);
  s.closed_form = false; // and here nothing is expected
  fit = fit_of(&s);
  assert_int_equal(fit.verdict, VERDICT_NOT_RESOLVABLE);
  assert_null(synthetic_test(&fit.row[0], "silence"));
}

// Where theory says that no light falls, some does.
static void test_light_in_the_dark(void **state) {
  (void)state;
  struct synthetic s = base;
  struct prediction dark = synthetic_prediction(&s, &arena);
  const double *zero = arena_new(&arena, double, (ptrdiff_t)s.iterations);
  dark.truth = 0, dark.unbiased = true, dark.divergent = dark.rest = zero;
  struct fit fit = synthetic_fit_with(&s, &dark, 1, &arena);
  assert_rejects(&fit.row[0], "silence");
  assert_rejects(&fit.row[1], "silence");
  s.black = true;
  fit = synthetic_fit_with(&s, &dark, 1, &arena);
  assert_int_equal(fit.row[0].verdict, VERDICT_NOT_RESOLVABLE);
  assert_int_equal(fit.row[0].n_tests, 0);
}

// The radius is halved for a while in the middle, where it turns no slope: no contradiction to a
// rate that holds in the limit, but then none is to be had from this.
static double dented(double alpha, double rho, uint64_t i) {
  (void)alpha;
  return i >= 330 && i < 410 ? rho / 1.3 : rho;
}

static void test_no_rate_without_fit(void **state) {
  (void)state;
  struct synthetic s = base;
  s.closed_form = false, s.runs = 200, s.r2 = dented;
  struct fit fit = fit_of(&s);
  assert_true(synthetic_test(&fit.row[0], "lack-of-fit")->rejects);
  assert_false(synthetic_test(&fit.row[0], "rate")->rejects);
  assert_int_equal(fit.row[0].verdict, VERDICT_NOT_RESOLVABLE);
  assert_false(isfinite(fit.row[0].rate) || isfinite(fit.row[0].rate_se));
  assert_false(isfinite(fit.row[0].rate_lo) || isfinite(fit.row[0].rate_hi));
  assert_int_equal(fit.row[1].verdict, VERDICT_AGREE); // which does not make up for it
  assert_int_equal(fit.verdict, VERDICT_NOT_RESOLVABLE);
}

// Without closed form two terms stand for what a first disc as wide as its light is high needs all
// powers of: by the first iterations alone the rates would be 0.55 and 0.28. That is no
// contradiction to a limit, and no agreement either.
static void test_large_discs(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: large discs", s.closed_form = false, s.reference_se = 1e-5, s.peak = 1;
  s.photons_1 = 200, s.runs = 100, s.iterations = 300;
  int too_large = 0;
  for (uint64_t e = 1; e <= 10; e++) {
    struct arena scratch = arena;
    struct fit fit = synthetic_fit(&s, e, &scratch);
    assert_int_not_equal(fit.verdict, VERDICT_DISAGREE);
    assert_int_not_equal(fit.row[1].verdict, VERDICT_AGREE);
    for (int r = 0; r < 2; r++)
      too_large += fit.row[r].why && strstr(fit.row[r].why, "first discs are too large");
  }
  assert_true(too_large >= 10);
}

// Theory expects a bias of seven standard errors or so, and there is none.
static void test_missed_bias(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: missed bias", s.iterations = 300, s.curvature = 0.13;
  struct prediction theory = synthetic_prediction(&s, &arena);
  s.curvature = 0;
  for (uint64_t e = 1; e <= 50; e++) {
    struct arena scratch = arena;
    struct fit fit = synthetic_fit_with(&s, &theory, e, &scratch);
    assert_true(fit.row[1].expected_snr > 6 && fit.row[1].expected_snr < 9);
    assert_int_not_equal(fit.row[1].verdict, VERDICT_AGREE);
    assert_int_not_equal(fit.verdict, VERDICT_AGREE);
  }
}

// The first bias is 0.125, the last 0.045. A reference off by 0.05 hides how it falls, one off by
// 0.0002 does not; the photons are the same.
static void test_noisy_reference(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: noisy reference", s.gaussian = true, s.closed_form = false;
  s.photons_1 = 5000, s.iterations = 30, s.reference_se = 0.0002;
  struct fit fit = fit_of(&s);
  assert_int_equal(fit.row[1].verdict, VERDICT_AGREE);
  assert_null(fit.row[1].why);
  s.reference_se = 0.05;
  fit = fit_of(&s);
  assert_int_equal(fit.row[1].verdict, VERDICT_NOT_RESOLVABLE);
  assert_non_null(fit.row[1].why);
  assert_non_null(strstr(fit.row[1].why, "the reference is too noisy"));
}

// Samples of a reference that all miss the light: their mean is 0, and so is its standard error.
static void test_dark_reference(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: dark reference", s.closed_form = false;
  struct prediction theory = synthetic_prediction(&s, &arena);
  theory.truth = theory.truth_se = 0;
  struct fit fit = synthetic_fit_with(&s, &theory, 1, &arena);
  assert_int_equal(fit.row[0].verdict, VERDICT_AGREE);
  assert_int_equal(fit.row[1].verdict, VERDICT_NOT_RESOLVABLE);
  assert_non_null(fit.row[1].why);
  assert_non_null(strstr(fit.row[1].why, "the reference found no light"));
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"a run without defect agrees", test_no_defect, 0, 0, 0},
      {"an index from 0 disagrees", test_zero_based_index, 0, 0, 0},
      {"the law of volumes on a surface disagrees", test_volume_law, 0, 0, 0},
      {"a radius that does not shrink disagrees", test_fixed_radius, 0, 0, 0},
      {"a constant radius that theory expects agrees, with rates 1 and 0", test_constant_radius, 0,
       0, 0},
      {"a kernel that is not normalised disagrees", test_unnormalised_kernel, 0, 0, 0},
      {"iterations with the same photons are not independent", test_reused_seed, 0, 0, 0},
      {"where there is no bias none is detected", test_zero_bias, 0, 0, 0},
      {"too few runs say so", test_nothing_to_see, 0, 0, 0},
      {"one iteration has no rate but is tested", test_one_iteration, 0, 0, 0},
      {"black where there is light disagrees, unless none was to be expected", test_black, 0, 0, 0},
      {"light where there is none disagrees", test_light_in_the_dark, 0, 0, 0},
      {"a bias that theory expects and that is not there never agrees", test_missed_bias, 0, 0, 0},
      {"a reference that hides the rate is named", test_noisy_reference, 0, 0, 0},
      {"a rate that only the first discs turn does not disagree", test_large_discs, 0, 0, 0},
      {"a reference that found no light is none", test_dark_reference, 0, 0, 0},
      {"where the model does not fit no rate is stated", test_no_rate_without_fit, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fit_plants", tests, NULL, NULL);
}
