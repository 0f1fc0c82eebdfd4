// Henyey and Greenstein's phase function against quadrature.
#include "scene_text.h"

#include "scene/medium.h"

#include <gsl/gsl_integration.h>

static const double gs[] = {-0.9, -0.3, 0, 1e-9, 0.5, 0.95, 0.999};
enum { N_GS = sizeof gs / sizeof *gs };

static struct bsdf phase_of(double g) { return medium_bsdf(&(struct medium){.g = g}); }

struct moment {
  struct bsdf bsdf;
  int power; // of the cosine between the directions of flight
};

// Light flies along z, and leaves at this cosine to it: the sphere's measure times the density.
static double integrand(double cosine, void *data) {
  const struct moment *moment = data;
  struct vec wo = vec(0, 0, -1), wi = vec(sqrt(1 - cosine * cosine), 0, cosine);
  double pdf = bsdf_pdf(&moment->bsdf, wo, wi, TRANSPORT_RADIANCE);
  return 2 * M_PI * pdf * (moment->power ? cosine : 1);
}

static double integral(double g, int power) {
  struct moment moment = {phase_of(g), power};
  gsl_function f = {integrand, &moment};
  gsl_integration_workspace *space = gsl_integration_workspace_alloc(500);
  double result, error;
  int status =
      gsl_integration_qag(&f, -1, 1, 1e-13, 1e-12, 500, GSL_INTEG_GAUSS61, space, &result, &error);
  gsl_integration_workspace_free(space);
  assert_int_equal(status, 0);
  return result;
}

// What rounding leaves of 1 + g^2 - 2 g cosine, which is (1 - |g|)^2 at its smallest.
static double rounded(double g) { return 0x1p-49 / ((1 - fabs(g)) * (1 - fabs(g))); }

static void it_integrates_to_one_and_its_mean_cosine_is_g(void **state) {
  (void)state;
  for (int k = 0; k < N_GS; k++) {
    double one = integral(gs[k], 0), mean = integral(gs[k], 1);
    if (!(fabs(one - 1) < 1e-11 + rounded(gs[k])))
      fail_msg("g = %g: the integral is %.15g", gs[k], one);
    if (!(fabs(mean - gs[k]) < 1e-11 + rounded(gs[k])))
      fail_msg("g = %g: the mean cosine is %.15g", gs[k], mean);
  }
}

// Nothing is lost and photons are as good as light: value, density and both directions agree.
static void value_and_density_are_one_and_symmetric(void **state) {
  (void)state;
  struct draw draw = draw_named("symmetric");
  for (int k = 0; k < 1000; k++) {
    struct bsdf bsdf = phase_of(gs[k % N_GS]);
    struct vec a = draw_direction(&draw), b = draw_direction(&draw);
    double f[3], back[3], pdf = bsdf_pdf(&bsdf, a, b, TRANSPORT_IMPORTANCE);
    bsdf_value(&bsdf, a, b, TRANSPORT_RADIANCE, f);
    bsdf_value(&bsdf, b, a, TRANSPORT_IMPORTANCE, back);
    assert_true(f[0] == pdf && f[1] == pdf && f[2] == pdf && back[0] == pdf);
    assert_true(bsdf_cosine(&bsdf, b) == 1 && bsdf_photon_factor(&bsdf, b) == 1);
  }
}

// Sampled directions are of unit length and carry their density, also at the ends of the numbers.
static void samples_say_their_density(void **state) {
  (void)state;
  static const double ends[] = {0, 0.5, 1 - 0x1p-53};
  struct draw draw = draw_named("density");
  for (int k = 0; k < 10000; k++) {
    double g = gs[k % N_GS], u[3] = {0};
    struct bsdf bsdf = phase_of(g);
    struct bsdf_sample sample;
    struct vec wo = draw_direction(&draw);
    draw_pair(&draw, &u[0], &u[1]);
    if (k < 100) u[0] = ends[k % 3];
    assert_true(bsdf_sample(&bsdf, wo, u, TRANSPORT_RADIANCE, &sample));
    double pdf = bsdf_pdf(&bsdf, wo, sample.wi, TRANSPORT_RADIANCE);
    assert_true(fabs(vec_length(sample.wi) - 1) < 1e-14);
    if (!(fabs(sample.pdf / pdf - 1) < 8 * rounded(g)))
      fail_msg("g = %g: %.15g, %.15g", g, sample.pdf, pdf);
    for (int c = 0; c < 3; c++) assert_true(sample.weight[c] == 1);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_integrates_to_one_and_its_mean_cosine_is_g),
      cmocka_unit_test(value_and_density_are_one_and_symmetric),
      cmocka_unit_test(samples_say_their_density),
  };
  return cmocka_run_group_tests_name("phase", tests, NULL, NULL);
}
