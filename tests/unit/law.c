// Radius laws: theory 2, golden values of Appendix A and acceptance test A1.
#include "density/law.h"

#include "numeric/elementary.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include <cmocka.h>
#include <string.h>

static const double alphas[] = {0,   5e-324,  1e-300, 1e-12, 0.1,         0.3,
                                0.5, 2.0 / 3, 0.8,    0.99,  1 - 0x1p-53, 1};
enum { N_ALPHAS = sizeof alphas / sizeof alphas[0] };

static const struct law *knaus_zwicker(void) {
  const struct law *law = law_find("knaus-zwicker");
  assert_non_null(law);
  return law;
}

// pbrt's law multiplies by alpha at once: at 0 it has no second radius, and next to it subnormal
// ones.
static bool has_radii(const struct law *law, double alpha) {
  return law->rho(alpha, 1000000000000000) >= DBL_MIN;
}

static void near(double got, double want, double relative, double alpha, uint64_t i) {
  if (!(fabs(got - want) <= relative * want))
    fail_msg("alpha = %g, i = %llu: %.17g, not %.17g: %.2g relative", alpha, (unsigned long long)i,
             got, want, (got - want) / want);
}

static void knaus_zwicker_has_the_golden_values_to_2e_15(void **state) {
  (void)state;
  // Appendix A; the last four values of alpha from 180-digit arithmetic.
  static const struct {
    double alpha;
    uint64_t i;
    double rho;
  } golden[] = {
      {0.5, 2, 0.75},
      {0.5, 10, 0.35239410400390625},
      {0.5, 19, 0.25717064127093181},
      {0.5, 20, 0.25074137523915851},
      {0.5, 100, 0.11269695801851284},
      {0.5, 1000, 0.035678022291708641},
      {0.5, 1000000, 0.0011283790260481255},
      {0.5, 1000000000, 3.5682482318595112e-5},
      {0.5, 1000000000000000, 3.5682482323055418e-8},
      {2.0 / 3, 2, 0.83333333333333331},
      {2.0 / 3, 10, 0.50851584026574285},
      {2.0 / 3, 19, 0.41271620008741715},
      {2.0 / 3, 20, 0.40583759675262686},
      {2.0 / 3, 100, 0.23838878553835977},
      {2.0 / 3, 1000, 0.1107609099759785},
      {2.0 / 3, 1000000, 0.011077320443511336},
      {2.0 / 3, 1000000000, 0.0011077321673093903},
      {2.0 / 3, 1000000000000000, 1.1077321674324709e-5},
      {0.7, 2, 0.84999999999999998},
      {0.7, 10, 0.5458591631985937},
      {0.7, 19, 0.45247154811101746},
      {0.7, 20, 0.4456844748893522},
      {0.7, 100, 0.27615508891397717},
      {0.7, 1000, 0.13853616347927961},
      {0.7, 1000000, 0.017442499078489594},
      {0.7, 1000000000, 0.0021958807638475741},
      {0.7, 1000000000000000, 3.4802364744437525e-5},
      {0.8, 2, 0.90000000000000002},
      {0.8, 10, 0.67209798656000006},
      {0.8, 19, 0.59333744961032245},
      {0.8, 20, 0.58740407511421923},
      {0.8, 100, 0.42709476334743241},
      {0.8, 1000, 0.26967245801247718},
      {0.8, 1000000, 0.067744072171190702},
      {0.8, 1000000000, 0.017016542930163892},
      {0.8, 1000000000000000, 0.0010736712740308359},
      {0.1, 2, 0.55},
      {0.1, 10, 0.13172835503953125},
      {0.1, 19, 0.074087564790501358},
      {0.1, 20, 0.070753624374928797},
      {0.1, 100, 0.016651893830559641},
      {0.1, 1000, 0.0020971996674732134},
      {0.1, 1000000, 4.1846516053629888e-6},
      {0.1, 1000000000, 8.3494780248056221e-9},
      {0.1, 1000000000000000, 3.3239870722035487e-14},
      {1e-12, 2, 0.5000000000005},
      {1e-12, 10, 0.1000000000002829},
      {1e-12, 19, 0.052631578947552374},
      {1e-12, 20, 0.050000000000177387},
      {1e-12, 100, 0.010000000000051774},
      {1e-12, 1000, 0.0010000000000074845},
      {1e-12, 1000000, 1.0000000000143927e-6},
      {1e-12, 1000000000, 1.0000000000213005e-9},
      {1e-12, 1000000000000000, 1.000000000035116e-15},
      {5e-324, 2, 0.5},
      {5e-324, 19, 0.052631578947368421053},
      {5e-324, 20, 0.05},
      {5e-324, 1000, 0.001},
      {5e-324, 1000000000000000, 1.0e-15},
      {1e-300, 2, 0.5},
      {1e-300, 19, 0.052631578947368421053},
      {1e-300, 20, 0.05},
      {1e-300, 1000, 0.001},
      {1e-300, 1000000000000000, 1.0e-15},
      {1 - 0x1p-53, 2, 0.99999999999999994449},
      {1 - 0x1p-53, 19, 0.99999999999999971714},
      {1 - 0x1p-53, 20, 0.99999999999999971159},
      {1 - 0x1p-53, 1000, 0.99999999999999927997},
      {1 - 0x1p-53, 1000000000000000, 0.99999999999999621236},
      {0.4616, 2, 0.73080000000000000515},
      {0.4616, 19, 0.22984653001558762999},
      {0.4616, 20, 0.22365906142756801111},
      {0.4616, 1000, 0.027384628778930875146},
      {0.4616, 1000000000000000, 9.4789629418412849035e-9},
  };
  // The product of i < 20 rounds up to 54 times. Beyond, six operations of at most 0.65 ulp each,
  // 9e-16: pow(w, alpha - 1) instead of pow(w, alpha)/w would not do.
  for (size_t k = 0; k < sizeof golden / sizeof golden[0]; k++) {
    double alpha = golden[k].alpha, bound = golden[k].i < 20 ? 2e-15 : 9e-16;
    near(knaus_zwicker()->rho(alpha, golden[k].i), golden[k].rho, bound, alpha, golden[k].i);
  }
}

// A 0-based index gives rho_2 = alpha, an update before the first pass alpha rho_1 (theory 2.1).
static void knaus_zwicker_counts_iterations_from_one(void **state) {
  (void)state;
  for (int k = 0; k < N_ALPHAS; k++) {
    double a = alphas[k];
    assert_true(knaus_zwicker()->rho(a, 1) == 1);
    assert_true(knaus_zwicker()->rho(a, 2) == (1 + a) / 2);
    near(knaus_zwicker()->rho(a, 3), (1 + a) * (2 + a) / 6, 4e-16, a, 3);
  }
}

// rho_(i+1) / rho_i = (i + alpha) / (i + 1), across the seam between product and closed form, and
// far out: two values right to 1.1e-15 (theory 2.5) and a rounded ratio.
static void knaus_zwicker_follows_its_recurrence(void **state) {
  (void)state;
  const uint64_t starts[] = {1, 1000, 1000000, 1000000000, 999999999999900};
  for (int k = 0; k < N_ALPHAS; k++)
    for (int s = 0; s < 5; s++)
      for (uint64_t i = starts[s]; i < starts[s] + 60; i++) {
        double here = knaus_zwicker()->rho(alphas[k], i);
        double want = here * ((double)i + alphas[k]) / ((double)i + 1);
        near(knaus_zwicker()->rho(alphas[k], i + 1), want, 2.6e-15, alphas[k], i + 1);
      }
}

// A million steps of the recurrence in double lose 2e-11 at most (theory 2.5); in float 7.6e-3.
static void a_million_steps_of_the_recurrence_reach_the_closed_form(void **state) {
  (void)state;
  for (int k = 0; k < N_ALPHAS; k++) {
    double rho = 1;
    for (uint64_t i = 1; i < 1000000; i++) rho *= ((double)i + alphas[k]) / ((double)i + 1);
    near(knaus_zwicker()->rho(alphas[k], 1000000), rho, 1e-9, alphas[k], 1000000);
  }
}

static void alpha_one_keeps_the_radius_and_alpha_zero_halves_the_area_at_once(void **state) {
  (void)state;
  const uint64_t iterations[] = {1, 2, 19, 20, 1000, 1000000000000000};
  for (int k = 0; k < 6; k++) {
    for (int l = 0; l < n_laws; l++) assert_true(laws[l].rho(1, iterations[k]) == 1);
    near(knaus_zwicker()->rho(0, iterations[k]), 1 / (double)iterations[k], 2e-15, 0,
         iterations[k]);
    near(law_find("power")->rho(0, iterations[k]), 1 / (double)iterations[k], 2e-15, 0,
         iterations[k]);
  }
}

// The power law is the asymptote of Knaus and Zwicker's up to 1/Gamma(1 + alpha) (theory 2.1).
static void the_power_law_is_the_asymptote_but_for_a_constant(void **state) {
  (void)state;
  const uint64_t i = 1000000000000;
  for (int k = 0; k < N_ALPHAS; k++) {
    double a = alphas[k], power = law_find("power")->rho(a, i);
    near(knaus_zwicker()->rho(a, i), power / tgamma(1 + a), 1e-11, a, i);
    near(power, (double)powl(i, a - 1), 1e-14, a, i);
  }
}

static void the_fixed_law_is_fixed(void **state) {
  (void)state;
  for (uint64_t i = 1; i < 100; i++) assert_true(law_find("fixed")->rho(0.5, i) == 1);
  assert_true(law_find("fixed")->measure_exponent(0.5) == 0);
}

// Between i and 1e3 i, rho falls by 1000^-exponent, but for a relative 1/i.
static void the_expected_exponent_is_the_one_seen(void **state) {
  (void)state;
  for (int l = 0; l < n_laws; l++)
    for (int k = 0; k < N_ALPHAS; k++) {
      if (!has_radii(&laws[l], alphas[k])) continue;
      double ratio = laws[l].rho(alphas[k], 1000000000000) / laws[l].rho(alphas[k], 1000000000);
      double seen = -log(ratio) / log(1000);
      assert_true(fabs(seen - laws[l].measure_exponent(alphas[k])) < 1e-9);
    }
}

// rho is the ratio of r^d: of lengths, areas and volumes. A fixed power of r fails in two of them.
static void radii_are_those_of_the_measure_in_every_dimension(void **state) {
  (void)state;
  const uint64_t iterations[] = {1, 2, 7, 20, 12345, 1000000000000000};
  for (int l = 0; l < n_laws; l++)
    for (int k = 0; k < N_ALPHAS; k++)
      for (int j = 0; j < 6 && has_radii(&laws[l], alphas[k]); j++)
        for (int d = 1; d <= 3; d++) {
          double r = law_radius(&laws[l], alphas[k], 0.05, d, iterations[j]) / 0.05;
          double measure = d == 1 ? r : d == 2 ? r * r : r * r * r;
          near(measure, laws[l].rho(alphas[k], iterations[j]), 2e-15, alphas[k], iterations[j]);
        }
}

static void radii_start_at_the_first_and_never_grow(void **state) {
  (void)state;
  for (int l = 0; l < n_laws; l++)
    for (int k = 0; k < N_ALPHAS; k++)
      for (int d = 1; d <= 3 && has_radii(&laws[l], alphas[k]); d++) {
        double before = law_radius(&laws[l], alphas[k], 0.2385, d, 1);
        assert_true(before == 0.2385);
        for (uint64_t i = 2; i < 200; i++) {
          double r = law_radius(&laws[l], alphas[k], 0.2385, d, i);
          assert_true(r > 0 && r <= before * (1 + 2e-15)); // theory A1's bound on rho
          before = r;
        }
      }
}

// rho_i i^e at i = 1e15 is the constant but for a relative 1/i, of 5 roundings more than rho.
static void the_asymptotic_constant_is_reached(void **state) {
  (void)state;
  const uint64_t i = 1000000000000000;
  for (int l = 0; l < n_laws; l++)
    for (int k = 0; k < N_ALPHAS; k++) {
      double a = alphas[k];
      if (!has_radii(&laws[l], a)) continue;
      double power = (double)powl(i, laws[l].measure_exponent(a));
      near(laws[l].rho(a, i) * power, laws[l].constant(a), 4e-15, a, i);
    }
}

static void only_alpha_zero_leaves_a_law_without_a_second_radius(void **state) {
  (void)state;
  for (int l = 0; l < n_laws; l++) {
    for (int k = 1; k < N_ALPHAS; k++) assert_true(laws[l].rho(alphas[k], 2) > 0);
    assert_true((laws[l].rho(0, 2) == 0) == (laws[l].count && laws[l].rho(0.5, 2) == 0.5));
  }
}

// ---- local statistics ----

// The counts of constant density, m proportional to r2, give the law's own rho: the first pass
// counted whole knaus-zwicker's, N = 0 at first alpha times it, one pass later (theory 2.4). Each
// pass rounds five times.
static void counts_of_constant_density_give_the_closed_form(void **state) {
  (void)state;
  int n_local = 0;
  for (int l = 0; l < n_laws; l++) {
    if (!laws[l].count) continue;
    n_local++;
    for (int k = 0; k < N_ALPHAS; k++) {
      double r2 = 1, n = 0, ratio;
      if (!has_radii(&laws[l], alphas[k])) continue;
      for (uint64_t i = 1; i <= 2000; i++) {
        near(r2, laws[l].rho(alphas[k], i), 2e-15 + (double)i * 5 * 0x1p-53, alphas[k], i);
        n = laws[l].count(alphas[k], n, 238.5 * r2, &ratio);
        r2 *= ratio;
      }
    }
  }
  assert_int_equal(n_local, 2);
}

static void the_first_pass_that_finds_photons_sets_the_start(void **state) {
  (void)state;
  double ratio;
  const struct law *hachisuka = law_find("hachisuka"), *pbrt = law_find("pbrt");
  assert_true(hachisuka->count(0.25, 0, 16, &ratio) == 20 &&
              ratio == 0.625); // (1 + a) M, (1 + a)/2
  assert_true(hachisuka->count(0.25, 20, 4, &ratio) == 21 && ratio == 0.875);
  assert_true(pbrt->count(0.25, 0, 16, &ratio) == 4 && ratio == 0.25);
  assert_true(pbrt->count(0.25, 4, 4, &ratio) == 5 && ratio == 0.625);
}

static void a_pass_without_photons_changes_nothing(void **state) {
  (void)state;
  for (int l = 0; l < n_laws; l++)
    for (int k = 0; laws[l].count && k < N_ALPHAS; k++)
      for (double n = 0; n < 100; n += 23.85) {
        double ratio = 0;
        assert_true(laws[l].count(alphas[k], n, 0, &ratio) == n && ratio == 1);
      }
}

// N'/r'^2 = N/r^2 + M/r^2 whatever is found: exact per realisation (theory 2.4). pbrt's first pass
// loses nothing either.
static void what_was_counted_over_the_area_only_grows_by_what_is_found(void **state) {
  (void)state;
  for (int l = 0; l < n_laws; l++)
    for (int k = 0; laws[l].count && k < N_ALPHAS; k++) {
      double n = 0, r2 = 0.25, ratio, sum = 0;
      if (alphas[k] < 0.1) continue; // such counts would shrink the area by alpha again and again
      for (int i = 1; i < 300; i++) {
        double m = (i * 7919) % 13, first = n == 0 && strcmp(laws[l].name, "pbrt") != 0 ? 2 : 1;
        sum += first * m / r2;
        n = laws[l].count(alphas[k], n, m, &ratio);
        r2 *= ratio;
        near(n / r2, sum, 1e-12, alphas[k], (uint64_t)i);
      }
    }
}

static void names_find_their_rows(void **state) {
  (void)state;
  for (int l = 0; l < n_laws; l++) assert_ptr_equal(law_find(laws[l].name), &laws[l]);
  assert_null(law_find("knaus"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(knaus_zwicker_has_the_golden_values_to_2e_15),
      cmocka_unit_test(knaus_zwicker_counts_iterations_from_one),
      cmocka_unit_test(knaus_zwicker_follows_its_recurrence),
      cmocka_unit_test(a_million_steps_of_the_recurrence_reach_the_closed_form),
      cmocka_unit_test(alpha_one_keeps_the_radius_and_alpha_zero_halves_the_area_at_once),
      cmocka_unit_test(the_power_law_is_the_asymptote_but_for_a_constant),
      cmocka_unit_test(the_fixed_law_is_fixed),
      cmocka_unit_test(the_expected_exponent_is_the_one_seen),
      cmocka_unit_test(radii_are_those_of_the_measure_in_every_dimension),
      cmocka_unit_test(radii_start_at_the_first_and_never_grow),
      cmocka_unit_test(the_asymptotic_constant_is_reached),
      cmocka_unit_test(only_alpha_zero_leaves_a_law_without_a_second_radius),
      cmocka_unit_test(counts_of_constant_density_give_the_closed_form),
      cmocka_unit_test(the_first_pass_that_finds_photons_sets_the_start),
      cmocka_unit_test(a_pass_without_photons_changes_nothing),
      cmocka_unit_test(what_was_counted_over_the_area_only_grows_by_what_is_found),
      cmocka_unit_test(names_find_their_rows),
  };
  return cmocka_run_group_tests_name("law", tests, NULL, NULL);
}
