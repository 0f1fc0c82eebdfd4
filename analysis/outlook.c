#include "analysis/outlook.h"

#include "analysis/fit_bias.h"

#include <math.h>

// So many that nothing expected is lost in noise; what comes out is scaled back.
static const double many = 1e12;

// What each iteration is expected to measure.
struct expected {
  double *variance, *bias, *kurtosis; // [n]
};

static struct expected expected_new(uint64_t n, struct arena *arena) {
  return (struct expected){arena_new(arena, double, (ptrdiff_t)n),
                           arena_new(arena, double, (ptrdiff_t)n),
                           arena_new(arena, double, (ptrdiff_t)n)};
}

static void from_theory(const struct prediction *theory, struct expected *expected) {
  for (uint64_t j = 0; j < theory->n; j++) {
    expected->variance[j] = theory->divergent[j] + theory->rest[j];
    expected->bias[j] = theory->unbiased ? 0 : theory->bias[j];
    expected->kurtosis[j] = theory->kurtosis ? theory->kurtosis[j] : 0;
  }
}

// A bias that a pilot does not see by this many standard errors says nothing of its rate.
static const double least_snr = 2;

// The fits of a few runs, at theory's rates. False: they say nothing. The bias stays 0 if it is not
// seen.
static bool from_pilot(const struct prediction *theory, const struct series *pilot,
                       struct expected *expected, struct arena *arena) {
  struct variance_fit v = fit_variance(theory, pilot->iteration, arena);
  double runs = pilot->iteration[0].n;
  if (v.why) return false;
  for (uint64_t j = 0; j < theory->n; j++) {
    expected->variance[j] = v.expected[j];
    expected->kurtosis[j] = (v.dispersion[j] - 2 / (runs - 1)) * runs;
  }
  for (uint64_t j = 0; theory->known_bias && j < theory->n; j++)
    expected->bias[j] = theory->bias[j];
  if (theory->known_bias || !pilot->richardson) return true;
  struct variance_fit of_difference = fit_variance(theory, pilot->richardson, arena);
  if (of_difference.why) return true;
  struct bias_fit b =
      fit_bias(theory, pilot->richardson, &of_difference, of_difference.expected, arena);
  bool seen = b.measured && b.snr >= least_snr;
  for (uint64_t j = 0; seen && j < theory->n; j++) expected->bias[j] = b.expected[j];
  return true;
}

static struct moments moments_expected(double mean, double variance, double kurtosis) {
  return (struct moments){.n = many,
                          .mean = mean,
                          .m2 = variance * (many - 1),
                          .m4 = many * variance * variance * (3 + kurtosis)};
}

struct outlook outlook_new(const struct prediction *given, const struct series *pilot,
                           struct arena scratch) {
  struct outlook outlook = {INFINITY, given->unbiased ? NAN : INFINITY, NAN};
  struct prediction theory = *given;
  struct expected expected = expected_new(theory.n, &scratch);
  theory.truth = theory.truth_se = 0;
  if (theory.closed_form)
    from_theory(&theory, &expected);
  else if (!pilot || !from_pilot(&theory, pilot, &expected, &scratch))
    return outlook;
  struct moments *iteration = arena_new(&scratch, struct moments, (ptrdiff_t)theory.n);
  for (uint64_t j = 0; j < theory.n; j++)
    iteration[j] = moments_expected(expected.bias[j], expected.variance[j], expected.kurtosis[j]);
  struct variance_fit v = fit_variance(&theory, iteration, &scratch);
  if (v.why) return outlook;
  outlook.variance_se = v.rate_se * sqrt(many);
  double last = fabs(expected.bias[theory.n - 1]);
  if (theory.unbiased || (last == 0 && theory.bias_kind != BIAS_ENDS)) return outlook;
  struct bias_fit b = fit_bias(&theory, iteration, &v, v.expected, &scratch);
  if (b.measured) outlook.bias_se = b.rate_se_theory * sqrt(many);
  if (last > 0) outlook.bias = last;
  return outlook;
}

double outlook_se(double one_run, double runs) {
  return runs > 1 ? one_run / sqrt(runs - 1) : INFINITY;
}

double outlook_runs(double one_run, double se) {
  double ratio = one_run / se;
  return ceil(ratio * ratio) + 1;
}
