// The expected radius of local statistics: sums over all counts of a few passes, many photons, and
// another program's simulations.
#include "analysis/local_radius.h"
#include "analysis/special.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct arena arena;

struct light {
  double p, bend; // of a photon in the first disc; how much denser its middle is
};

static double fraction(const void *of, double s) {
  const struct light *light = of;
  return light->p * s * (1 + light->bend * (1 - s));
}

static const struct light lights[] = {{0.02, 0}, {0.3, 0.25}, {0.5, -0.1}};

static struct local_radius radius_of(const char *law, double alpha, double emitted,
                                     const struct light *light) {
  return (struct local_radius){law_find(law), alpha, emitted, fraction, light};
}

// E[s^power] after so many more passes, count by count.
static double enumerate(const struct local_radius *radius, int power, int passes, double n,
                        double s) {
  if (passes == 0) return power == 1 ? s : s * s;
  double sum = 0, p = radius->fraction(radius->of, s), ratio;
  for (double m = 0; m <= radius->emitted; m++) {
    double after = radius->law->count(radius->alpha, n, m, &ratio);
    sum += special_binomial(m, p, radius->emitted) *
           enumerate(radius, power, passes - 1, after, s * ratio);
  }
  return sum;
}

// The grid's step leaves 1e-5 (local_radius.c).
static void assert_enumerated(const struct local_radius *radius, uint64_t n) {
  for (int power = 1; power <= 2; power++) {
    double moment[4];
    local_radius_moment(radius, power, n, moment, arena);
    for (uint64_t i = 1; i <= n; i++) {
      double expected = enumerate(radius, power, (int)i - 1, 0, 1);
      if (!(fabs(moment[i - 1] / expected - 1) < 2e-5))
        fail_msg("%s, alpha %g, %g emitted: moment %d of iteration %d is %.9g, not %.9g",
                 radius->law->name, radius->alpha, radius->emitted, power, (int)i, moment[i - 1],
                 expected);
    }
  }
}

// Few photons, where each count matters, and 20, which are summed by Gauss' rule.
static void moments_are_sums_over_all_counts(void **state) {
  (void)state;
  const double alpha[] = {0.3, 2.0 / 3, 0.85};
  for (int a = 0; a < 3; a++)
    for (int l = 0; l < 2; l++) {
      const char *law = l ? "pbrt" : "hachisuka";
      for (int k = 0; k < 3; k++) {
        struct local_radius few = radius_of(law, alpha[a], 6, &lights[k]);
        assert_enumerated(&few, 4);
      }
      struct local_radius many = radius_of(law, alpha[a], 40, &lights[2]);
      assert_enumerated(&many, 3);
    }
}

// Uniform light and lambda photons: the closed form but for a part of order 1 / lambda, whose
// coefficient theory's simulations bound (theory 2.4: 0.08 at most).
static void many_photons_give_the_closed_form(void **state) {
  (void)state;
  const struct light light = {0.001, 0};
  for (int l = 0; l < 2; l++) {
    struct local_radius radius = radius_of(l ? "pbrt" : "hachisuka", 2.0 / 3, 3e5, &light);
    double mean[300];
    local_radius_moment(&radius, 1, 300, mean, arena);
    for (uint64_t i = 1; i <= 300; i++)
      assert_true(fabs(mean[i - 1] / radius.law->rho(radius.alpha, i) - 1) < 0.1 / 300);
  }
}

// 40000 realisations of 3000 passes by another program (tests/statistical/local.c): within five of
// their standard errors.
static void means_are_those_of_simulations(void **state) {
  (void)state;
  enum { PASSES = 3000 };
  static const struct {
    double lambda, mean, mean_se;
  } row[] = {{1, 1.18247, 0.00074}, {3, 1.01819, 0.00072}, {10, 0.99951, 0.00045}};
  double *mean = arena_new(&arena, double, PASSES + 1);
  for (int k = 0; k < 3; k++) {
    const struct light light = {row[k].lambda / 1e6, 0};
    struct local_radius radius = radius_of("hachisuka", 2.0 / 3, 1e6, &light);
    local_radius_moment(&radius, 1, PASSES + 1, mean, arena);
    double got = mean[PASSES] / radius.law->rho(radius.alpha, PASSES + 1);
    if (!(fabs(got - row[k].mean) < 5 * row[k].mean_se))
      fail_msg("lambda = %g: %g, not %g", row[k].lambda, got, row[k].mean);
  }
}

// Factorial moments of a binomial variable: n (n - 1) ... (n - k + 1) p^k.
static void gauss_rule_is_exact_for_polynomials(void **state) {
  (void)state;
  enum { NODES = 5 };
  const double p = 0.2385, trials = 37;
  double m[NODES], weight[NODES], expected = 1;
  special_gauss_binomial(NODES, p, trials, m, weight);
  for (int k = 0; k < 2 * NODES; k++) {
    double sum = 0;
    for (int j = 0; j < NODES; j++) {
      double product = weight[j];
      for (int f = 0; f < k; f++) product *= m[j] - f;
      sum += product;
    }
    assert_true(fabs(sum / expected - 1) < 1e-10);
    expected *= (trials - k) * p;
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(moments_are_sums_over_all_counts),
      cmocka_unit_test(many_photons_give_the_closed_form),
      cmocka_unit_test(means_are_those_of_simulations),
      cmocka_unit_test(gauss_rule_is_exact_for_polynomials),
  };
  return cmocka_run_group_tests_name("local_radius", tests, NULL, NULL);
}
