// Resamples of runs: which are drawn, their moments, percentiles; and what cannot be resampled.
#define _GNU_SOURCE // mkdtemp
#include "analysis/resample.h"
#include "analysis/fit_methods.h"
#include "fit_fixture.h"

enum { RUNS = 23 };

// In 999 resamples each run is drawn 999 times, give or take sqrt(999 (1 - 1 / 23)) = 30.9, and
// twice or more often as a multinomial number of variance 1 - 1 / 23 is: the mean square of all
// 22977 counts is 1.957 give or take 0.01. Four standard deviations, level 6e-5 a comparison.
static void whole_runs_are_drawn_with_replacement(void **state) {
  (void)state;
  double drawn[RUNS] = {0}, squares = 0, normals = 0, normal_squares = 0;
  for (int b = 1; b <= RESAMPLES; b++) {
    double count[RUNS], again[RUNS], normal, normal_again, sum = 0;
    resample_runs(b, RUNS, count, &normal);
    resample_runs(b, RUNS, again, &normal_again);
    assert_memory_equal(count, again, sizeof count);
    assert_true(normal == normal_again);
    for (int k = 0; k < RUNS; k++) {
      assert_true(count[k] >= 0 && count[k] == floor(count[k]));
      sum += count[k], drawn[k] += count[k], squares += count[k] * count[k];
    }
    assert_true(sum == RUNS);
    normals += normal, normal_squares += normal * normal;
  }
  for (int k = 0; k < RUNS; k++) assert_true(fabs(drawn[k] - RESAMPLES) < 4 * 30.9);
  assert_true(fabs(squares / (RESAMPLES * RUNS) - (2 - 1.0 / RUNS)) < 0.04);
  assert_true(fabs(normals / RESAMPLES) < 4 / sqrt(RESAMPLES));
  assert_true(fabs(normal_squares / RESAMPLES - 1) < 4 * sqrt(2.0 / RESAMPLES));
}

// Of the runs as they are, and of two of them alone.
static void moments_are_those_of_the_runs_drawn(void **state) {
  (void)state;
  const double x[3] = {2.385, -1.171, -1.214}, all[3] = {1, 1, 1}, two[3] = {2, 0, 1};
  struct resampled moments = resample_moments(3, all, x);
  double mean = (2 * x[0] + x[2]) / 3;
  double square = (2 * x[0] * x[0] + x[2] * x[2]) / 3 - mean * mean;
  assert_true(fabs(moments.mean) < 1e-15);
  moments = resample_moments(3, two, x);
  assert_true(fabs(moments.mean - mean) < 1e-15);
  assert_true(fabs(moments.variance - square * 2.25) < 1e-14);
}

// The mean of all resamples' variances, within four of its own standard errors.
static void the_variance_of_a_resample_is_unbiased(void **state) {
  (void)state;
  double x[RUNS], sum = 0, squares = 0, sums = 0, sums_squares = 0;
  for (int k = 0; k < RUNS; k++) x[k] = k * k - (RUNS - 1) * (2 * RUNS - 1) / 6.0;
  for (int k = 0; k < RUNS; k++) sum += x[k], squares += x[k] * x[k];
  assert_true(fabs(sum) < 1e-9);
  for (int b = 1; b <= RESAMPLES; b++) {
    double count[RUNS], normal;
    resample_runs(b, RUNS, count, &normal);
    double variance = resample_moments(RUNS, count, x).variance;
    sums += variance, sums_squares += variance * variance;
  }
  double mean = sums / RESAMPLES;
  double se = sqrt((sums_squares / RESAMPLES - mean * mean) / RESAMPLES);
  assert_true(fabs(mean - squares / (RUNS - 1)) < 4 * se);
  assert_true(se < 0.01 * mean); // without the correction it would be 9 % less
}

// 1..999 in another order: one in forty of 1000 gaps lies beyond 25 and 975.
static void percentiles_are_values(void **state) {
  (void)state;
  double value[RESAMPLES];
  struct spread_of_resamples spread;
  for (int b = 0; b < RESAMPLES; b++) value[b] = 1 + 500 * b % RESAMPLES;
  assert_true(resample_spread(value, RUNS, &spread));
  assert_true(spread.lo == 25 && spread.hi == 975);
  double variance = RESAMPLES * (RESAMPLES + 1) / 12.0 * RUNS / (RUNS - 1);
  assert_true(fabs(spread.se - sqrt(variance)) < 1e-9);
  value[500] = NAN;
  assert_false(resample_spread(value, RUNS, &spread));
}

static void says(struct results *results, const char *what) {
  struct problem problem = {0};
  struct fit fit;
  assert_false(fit_results_by(fit_method_find("bootstrap"), results, &arena, &fit, &problem));
  if (!strstr(problem.text, what)) fail_msg("expected '%s' in '%s'", what, problem.text);
  if (strchr(problem.text, '\n')) fail_msg("%s", problem.text);
}

static void too_few_runs_and_runs_not_kept_are_refused(void **state) {
  (void)state;
  struct synthetic s = base;
  s.runs = 19;
  struct prediction theory = synthetic_prediction(&s, &arena);
  struct results *results = synthetic_results(&s, theory.family.rho, 1, &arena);
  struct problem problem = {0};
  says(results, "cell 0 has 19 runs, and a bootstrap needs 20: raise `runs`");
  results->series[0].run_average = NULL;
  says(results, "cell 0 keeps moments, and a bootstrap needs its runs: say `keep: runs`");
  results->experiment.cell[0].quantities = 0; // nothing is fitted
  assert_true(fit_can_bootstrap(results, &problem));
  s.runs = 20;
  assert_true(fit_can_bootstrap(synthetic_results(&s, theory.family.rho, 1, &arena), &problem));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(whole_runs_are_drawn_with_replacement),
      cmocka_unit_test(moments_are_those_of_the_runs_drawn),
      cmocka_unit_test(the_variance_of_a_resample_is_unbiased),
      cmocka_unit_test(percentiles_are_values),
      cmocka_unit_test(too_few_runs_and_runs_not_kept_are_refused),
  };
  return cmocka_run_group_tests_name("resample", tests, make_folder, remove_folder);
}
