// Leads, crossovers and errors at a time, of curves that are powers of time and known spreads.
#include "analysis/pace.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

enum { RUNS = 3, POINTS = 5, MOST = RUNS * POINTS };

struct curve {
  double time_s[MOST], error[MOST];
  struct pace pace;
};

// Errors constant time^-power at factor * 4^j seconds, run k times (1 + (k - 1) spread): the mean
// is the curve itself, its standard error spread / sqrt(3) of it.
static void curve_of(struct curve *curve, double constant, double power, double first_s,
                     double spread) {
  for (int k = 0; k < RUNS; k++)
    for (int j = 0; j < POINTS; j++) {
      double t = first_s * pow(4, j);
      curve->time_s[k * POINTS + j] = t;
      curve->error[k * POINTS + j] = constant * pow(t, -power) * (1 + (k - 1) * spread);
    }
  curve->pace = (struct pace){RUNS, POINTS, curve->time_s, curve->error};
}

static void assert_relative(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance * fabs(expected)))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

static void powers_are_met_between_points(void **state) {
  (void)state;
  struct curve curve;
  curve_of(&curve, 0.37, 0.61, 0.013, 0.2);
  for (double t = 0.013; t < 3.3; t *= 1.37) {
    struct pace_error at = pace_at(&curve.pace, t);
    assert_relative(at.mean, 0.37 * pow(t, -0.61), 1e-12);
    assert_relative(at.se, at.mean * 0.2 / sqrt(3), 1e-9);
  }
}

// Each run is asked at the time itself, however fast it was: runs on one curve have no spread.
static void runs_keep_their_own_times(void **state) {
  (void)state;
  const double time_s[] = {1, 10, 1.5, 12}, error[] = {1, 0.1, 1 / 1.5, 1.0 / 12};
  struct pace pace = {2, 2, time_s, error};
  struct pace_span span;
  assert_true(pace_span(&pace, &span));
  assert_true(span.from_s == 1.5 && span.to_s == 10);
  struct pace_error at = pace_at(&pace, 4);
  assert_relative(at.mean, 0.25, 1e-12);
  assert_true(at.se < 1e-12);
}

// 1 / t and 0.5 t^-1/2 cross at t = 4. With standard errors s of either, in units of the mean, and
// 4 degrees of freedom (Welch's for two equal spreads) the ratio is significant from ln(ratio) =
// t(0.975, 4) s sqrt(2) on: t(0.975, 4) = 2.776445 of tables; ln(ratio) = ln(t / 4) / 2.
static void a_crossover_has_its_interval(void **state) {
  (void)state;
  const double spread = 0.11;
  struct curve steep, flat;
  struct pace_lead lead[PACE_LEADS];
  curve_of(&steep, 1, 1, 0.05, spread);
  curve_of(&flat, 0.5, 0.5, 0.05, spread);
  double wide = exp(2 * 2.776445 * spread / sqrt(3) * sqrt(2));
  assert_int_equal(pace_leads(&steep.pace, &flat.pace, lead), 2);
  assert_true(lead[0].ahead == 1 && lead[1].ahead == 0);
  assert_relative(lead[0].from_s, 0.05, 1e-12);
  assert_relative(lead[0].to_s, 4 / wide, 1e-5);
  assert_true(isnan(lead[0].crossed_s));
  assert_relative(lead[1].crossed_s, 4, 1e-9);
  assert_relative(lead[1].from_s, 4 * wide, 1e-5);
  assert_relative(lead[1].to_s, 0.05 * 256, 1e-12);
  assert_int_equal(pace_leads(&flat.pace, &steep.pace, lead), 2); // the same, seen from the other
  assert_true(lead[0].ahead == 0 && lead[1].ahead == 1);
  assert_relative(lead[1].crossed_s, 4, 1e-9);
}

static void a_lead_throughout_has_no_crossover(void **state) {
  (void)state;
  struct curve good, bad;
  struct pace_lead lead[PACE_LEADS];
  curve_of(&good, 1, 1, 0.05, 0.1);
  curve_of(&bad, 3, 1, 0.07, 0.1);
  assert_int_equal(pace_leads(&bad.pace, &good.pace, lead), 1);
  assert_int_equal(lead[0].ahead, 1);
  assert_relative(lead[0].from_s, 0.07, 1e-12); // of the common span
  assert_relative(lead[0].to_s, 0.05 * 256, 1e-12);
}

// A difference of 20 % with a spread of 30 % is none, and curves that never overlap say nothing.
static void what_cannot_be_told_apart_has_no_lead(void **state) {
  (void)state;
  struct curve one, other;
  struct pace_lead lead[PACE_LEADS];
  curve_of(&one, 1, 1, 0.05, 0.3);
  curve_of(&other, 1.2, 1, 0.05, 0.3);
  assert_int_equal(pace_leads(&one.pace, &other.pace, lead), 0);
  curve_of(&other, 100, 1, 100, 0.01);
  assert_int_equal(pace_leads(&one.pace, &other.pace, lead), 0);
  other.pace.n_points = 0;
  assert_int_equal(pace_leads(&one.pace, &other.pace, lead), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(powers_are_met_between_points),
      cmocka_unit_test(runs_keep_their_own_times),
      cmocka_unit_test(a_crossover_has_its_interval),
      cmocka_unit_test(a_lead_throughout_has_no_crossover),
      cmocka_unit_test(what_cannot_be_told_apart_has_no_lead),
  };
  return cmocka_run_group_tests_name("pace", tests, NULL, NULL);
}
