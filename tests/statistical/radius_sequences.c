// The squared radii in the log of local statistics against their expectation by theory, at 1, 3, 10
// and 100 photons in the first disc.
#define _GNU_SOURCE // mkdtemp, nftw
#include "analysis/local_radius.h"
#include "tests/unit/run_fixture.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

// From one photon pass: 500 photons on the beam's disc of radius 1, r_1^2 = lambda / 500.
#define RADII                                                                                      \
  "scene: scenes/plane-uniform-beam.pbrt\nintegrator: sppm\nlaw: [hachisuka, pbrt]\n"              \
  "radius: [0.0447213595499958, 0.07745966692414834, 0.1414213562373095, 0.4472135954999579]\n"    \
  "photons: 500\ndepth: 1\nprobes: [[32, 32]]\nquantity: none\niterations: 100\nruns: 208\n"

// The rules as the papers and pbrt's sources have them: not ours, which may be wrong.
static double keep(double alpha, double n, double m, double *ratio) {
  *ratio = (n + alpha * m) / (n + m);
  return n + alpha * m;
}
static double count_first(double alpha, double n, double m, double *ratio) {
  *ratio = 1;
  return m == 0 ? n : keep(alpha, n == 0 ? m : n, m, ratio);
}
static double count_from_zero(double alpha, double n, double m, double *ratio) {
  *ratio = 1;
  return m == 0 ? n : keep(alpha, n, m, ratio);
}
static const struct law rules[] = {{.name = "hachisuka", .count = count_first},
                                   {.name = "pbrt", .count = count_from_zero}};

static double uniform(const void *of, double s) { return *(const double *)of * s; }

// Iterations 3, 10 and 100 of eight cells. Deviations of r^2 are 0.14, 0.14, 0.09 and 0.025 of its
// mean, so with 208 runs a mean that is off by 7, 7, 5 or 1.3 % is found with probability 0.95:
// not the fluctuations at 3 photons or more, but those at one (18 %), a start with N = 0 (33 %),
// an alpha off by 0.03 (13 % at i = 100), or counts that are not the disc's own.
static void mean_radii_are_theorys(void **state) {
  (void)state;
  enum { LAST = 100 };
  static const int iterations[] = {3, 10, LAST};
  double limit = gsl_cdf_ugaussian_Qinv(1e-6 / (8 * 3) / 2);
  struct results results = run("radius_sequences", RADII);
  assert_int_equal(results.n_series, 8);
  for (int s = 0; s < results.n_series; s++) {
    const struct cell *cell = &results.experiment.cell[s];
    double p = cell->radius * cell->radius, mean[LAST], square[LAST];
    const struct law *rule = &rules[strcmp(cell->law->name, rules[0].name) != 0];
    const struct local_radius radius = {rule, cell->alpha, 500, uniform, &p};
    local_radius_moment(&radius, 1, LAST, mean, arena);
    local_radius_moment(&radius, 2, LAST, square, arena);
    for (int k = 0; k < 3; k++) {
      int j = iterations[k] - 1;
      struct moments measured = results.series[s].radius2[j];
      double se = sqrt((square[j] - mean[j] * mean[j]) / measured.n);
      double z = (measured.mean / p - mean[j]) / se;
      assert_true(measured.n == 208);
      if (!(fabs(z) < limit))
        fail_msg("%s, %g photons, iteration %d: r^2 / r_1^2 = %g, not %g: z = %.1f", rule->name,
                 500 * p, j + 1, measured.mean / p, mean[j], z);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(mean_radii_are_theorys)};
  return cmocka_run_group_tests_name("radius sequences", tests, make_folder, remove_folder);
}
