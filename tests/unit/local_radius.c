// The expected radius of local statistics: sums over all counts of a few passes, many photons, and
// another program's simulations.
#include "analysis/local_radius.h"
#include "analysis/expected_radius.h"
#include "analysis/prediction.h"
#include "analysis/special.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct arena arena;

struct density {
  double p, bend; // of a photon in the first disc; how much denser its middle is
};

static double fraction(const void *of, double s) {
  const struct density *density = of;
  return density->p * s * (1 + density->bend * (1 - s));
}

static const struct density densities[] = {{0.02, 0}, {0.3, 0.25}, {0.5, -0.1}};

static struct local_radius radius_of(const char *law, double alpha, double emitted,
                                     const struct density *density) {
  return (struct local_radius){law_find(law), alpha, emitted, fraction, density};
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

// The grid's step leaves 1e-6 of the mean (local_radius.c), and ten times that of the square.
static void assert_enumerated(const struct local_radius *radius, uint64_t n) {
  for (int power = 1; power <= 2; power++) {
    double moment[4];
    local_radius_moment(radius, power, n, moment, arena);
    for (uint64_t i = 1; i <= n; i++) {
      double expected = enumerate(radius, power, (int)i - 1, 0, 1);
      if (!(fabs(moment[i - 1] / expected - 1) < (power == 1 ? 1e-6 : 1e-5)))
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
        struct local_radius few = radius_of(law, alpha[a], 6, &densities[k]);
        assert_enumerated(&few, 4);
      }
      struct local_radius many = radius_of(law, alpha[a], 40, &densities[2]);
      assert_enumerated(&many, 3);
    }
}

// Uniform light and lambda photons: the closed form but for a part of order 1 / lambda, whose
// coefficient theory's simulations bound (theory 2.4: 0.08 at most).
static void many_photons_give_the_closed_form(void **state) {
  (void)state;
  const struct density density = {0.001, 0};
  for (int l = 0; l < 2; l++) {
    struct local_radius radius = radius_of(l ? "pbrt" : "hachisuka", 2.0 / 3, 3e5, &density);
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
    const struct density density = {row[k].lambda / 1e6, 0};
    struct local_radius radius = radius_of("hachisuka", 2.0 / 3, 1e6, &density);
    local_radius_moment(&radius, 1, PASSES + 1, mean, arena);
    double got = mean[PASSES] / radius.law->rho(radius.alpha, PASSES + 1);
    if (!(fabs(got - row[k].mean) < 5 * row[k].mean_se))
      fail_msg("lambda = %g: %g, not %g", row[k].lambda, got, row[k].mean);
  }
}

// At the foot of a Lambertian light at height 1 a disc of radius r holds r^2 / (1 + r^2) of the
// photons (theory 5 ii).
static double at_foot(const void *of, double s) {
  double r2 = *(const double *)of * s;
  return r2 / (1 + r2);
}

// One iteration's variance has a part p / (pi r^2)^2: that of the expected radii is predicted, 9 %
// below those of the law at the end.
static void predictions_are_at_the_expected_radii(void **state) {
  (void)state;
  enum { N = 200 };
  static const struct integrator_type sppm = {.name = "sppm", .photons = true};
  const struct cell cell = {.integrator = &sppm,
                            .reference_radius = &reference_radii[0],
                            .kernel = kernel_find("box"),
                            .law = law_find("hachisuka"),
                            .alpha = 0.5,
                            .radius = 0.5,
                            .photons = 1900,
                            .direct = DIRECT_PHOTONS,
                            .depth = 1};
  const struct probe probe = {.hit = true, .n = vec(0, 0, 1), .scale = 1, .scale_rgb = {1, 1, 1}};
  const double r1_2 = 0.25;
  struct scene scene;
  struct problem problem = {0};
  if (!scene_read("scenes/plane-point-light.pbrt", &arena, &scene, &problem))
    fail_msg("%s", problem.text);
  const struct local_radius radius = {cell.law, cell.alpha, 1900, at_foot, &r1_2};
  double s[N];
  local_radius_moment(&radius, 1, N, s, arena);
  assert_true(s[N - 1] < 0.93 * cell.law->rho(cell.alpha, N));
  assert_true(fabs(expected_first_disc(&scene, &cell, &probe, 0.5, arena) - 380) < 1e-9);

  struct family_table table = family_table_new(cell.law, N, &arena);
  struct family family = family_new(&table, cell.alpha, &arena);
  struct prediction p = prediction_new(&scene, &cell, &probe, &family, &arena);
  for (int j = 0; j < N; j++) {
    double expected = at_foot(&r1_2, s[j]) / (s[j] * s[j]) / at_foot(&r1_2, 1);
    assert_true(fabs(p.divergent[j] / p.divergent[0] / expected - 1) < 1e-9);
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
      cmocka_unit_test(predictions_are_at_the_expected_radii),
      cmocka_unit_test(gauss_rule_is_exact_for_polynomials),
  };
  return cmocka_run_group_tests_name("local_radius", tests, NULL, NULL);
}
