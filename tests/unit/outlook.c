// What `plan` says of an experiment: theory's formulas for the standard errors, and what a fit of
// the runs then says.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run_fixture.h"

#include "analysis/fit.h"
#include "analysis/outlook.h"

#include <math.h>

static struct prediction predict(const char *name, const char *yaml,
                                 struct experiment *experiment) {
  *experiment = experiment_of(name, yaml);
  struct plan plan = plan_of(experiment);
  const struct cell *cell = &experiment->cell[0];
  struct probe *probe = arena_new(&arena, struct probe, 1);
  plan_probes(&plan.group[0], probe, arena);
  return prediction_new(&plan.scene[0].scene, cell, probe, prediction_family(cell, &arena), &arena);
}

static double relative(double a, double b) { return fabs(a / b - 1); }

// Theory 4.4: (2 / ((K - 1) N))^1/2, which wants many photons in a disc and many iterations: with
// 100 iterations the mean square deviation of ln i is 0.84 instead of 1; and for the bias (V_1 / (K
// b_1^2 I))^1/2, I = 12.3 of 100 iterations at alpha = 2/3, where V_i is as 1 / rho_i: the disc
// holds 2 % of the beam.
static void standard_errors_are_theorys(void **state) {
  (void)state;
  struct experiment experiment;
  struct prediction theory =
      predict("small",
              "scene: scenes/plane-quadratic-beam.pbrt\nradius: 0.1\nphotons: 100000\n"
              "depth: 1\nprobes: [[32, 32]]\niterations: 100\n",
              &experiment);
  struct outlook outlook = outlook_new(&theory, NULL, arena);
  double mean = 0, square = 0;
  for (int i = 1; i <= 100; i++) mean += log(i) / 100, square += log(i) * log(i) / 100;
  double spread = square - mean * mean;
  assert_true(relative(outlook.variance_se, sqrt(2 / (100 * spread))) < 0.03);
  double photons = 100000, inside = 2 * 0.01, bias = 0.25 * 0.01 / 2 * 4; // of the value
  double one_run = sqrt((1 / inside - 1) / photons / (bias * bias * 12.3));
  assert_true(relative(outlook.bias_se, one_run) < 0.03);
  double rho = law_find("knaus-zwicker")->rho(2.0 / 3, 100);
  assert_true(relative(outlook.bias, bias * theory.truth * rho) < 1e-3);
}

// 208 runs of 100 iterations; the fit's own standard errors stray by a few per cent.
static void a_fit_then_says_what_was_planned(void **state) {
  (void)state;
  struct experiment experiment;
  struct prediction theory =
      predict("planned", BEAM "parts: [{radius: 0.7, iterations: 100, runs: 208}]\n", &experiment);
  struct outlook outlook = outlook_new(&theory, NULL, arena);
  run_into(&experiment, path_in("planned"));
  struct results results = results_of(path_in("planned"));
  struct fit fit;
  struct problem problem = {0};
  assert_true(fit_results(&results, &arena, &fit, &problem));
  assert_true(relative(fit.row[0].rate_se, outlook_se(outlook.variance_se, 208)) < 0.1);
  assert_true(relative(fit.row[1].rate_se, outlook_se(outlook.bias_se, 208)) < 0.15);
}

// Where theory's constants are not known a fit has more to find. From 16 runs, of which only the
// variances and Richardson's biases are known: about the standard errors of a fit of 208 with an
// exact reference (one in three: what a pilot knows of the variance's two parts and of the bias).
static void a_pilot_says_what_a_fit_without_closed_form_will(void **state) {
  (void)state;
  struct experiment experiment;
  struct prediction theory = predict(
      "pilot", BEAM "parts: [{radius: 0.7, iterations: 100, runs: 16, reference: richardson}]\n",
      &experiment);
  run_into(&experiment, path_in("pilot"));
  struct results few = results_of(path_in("pilot"));
  struct results many =
      run("many", BEAM "parts: [{radius: 0.7, iterations: 100, runs: 208, seed: other}]\n");
  struct prediction shape =
      prediction_from_reference(theory.truth, 0, (struct terms){.d = 2}, &theory.family, &arena);
  struct outlook piloted = outlook_new(&shape, &few.series[0], arena);
  struct fit fit;
  fit_predicted(&many, &shape, &arena, &fit);
  assert_true(relative(outlook_se(piloted.variance_se, 208), fit.row[0].rate_se) < 0.33);
  assert_true(relative(outlook_se(piloted.bias_se, 208), fit.row[1].rate_se) < 0.33);
  assert_true(isinf(outlook_new(&shape, NULL, arena).variance_se));
}

// Where the bias ends at a shadow's edge the last iteration has none, but that its sum stays is to
// be seen: what the fit of 208 runs then knows is known ahead.
static void a_bias_that_ends_has_a_rate(void **state) {
  (void)state;
  struct experiment experiment;
  struct prediction theory =
      predict("ends",
              "scene: scenes/plane-shadow-edge.pbrt\ndepth: 1\nprobes: [[45, 32]]\nradius: 0.65\n"
              "photons: 250\niterations: 100\nruns: 208\n",
              &experiment);
  struct outlook outlook = outlook_new(&theory, NULL, arena);
  assert_true(theory.bias_kind == BIAS_ENDS && isnan(outlook.bias));
  assert_true(isfinite(outlook.bias_se));
  run_into(&experiment, path_in("ends"));
  struct results results = results_of(path_in("ends"));
  struct bias_fit b;
  struct variance_fit v = fit_variance(&theory, results.series[0].iteration, &arena);
  b = fit_bias(&theory, results.series[0].iteration, &v, v.expected, &arena);
  assert_true(relative(b.rate_se_theory, outlook_se(outlook.bias_se, 208)) < 0.15);
}

static void runs_and_errors_are_each_others_inverse(void **state) {
  (void)state;
  assert_true(outlook_runs(0.4, 0.004) == 10001);
  assert_true(relative(outlook_se(0.4, 10001), 0.004) < 1e-12);
  assert_true(isinf(outlook_se(0.4, 1)));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(standard_errors_are_theorys),
      cmocka_unit_test(a_fit_then_says_what_was_planned),
      cmocka_unit_test(a_pilot_says_what_a_fit_without_closed_form_will),
      cmocka_unit_test(a_bias_that_ends_has_a_rate),
      cmocka_unit_test(runs_and_errors_are_each_others_inverse),
  };
  return cmocka_run_group_tests_name("outlook", tests, make_folder, remove_folder);
}
