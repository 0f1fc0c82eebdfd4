// Fresnel's equations against 60-digit values, against the transmitted amplitudes, and Snell's law.
#include "scene/material/fresnel.h"
#include "scene_text.h"

#include <complex.h>
#include <float.h>

// 60 digits from the complex amplitudes (n = eta + i k, cos_t = sqrt(1 - sin^2 / n^2)).
static const struct {
  double cosine, eta, reflectance;
} dielectric[] = {
    {1.0, 1.5, 0.04},
    {0.7351, 1.5, 0.047867649055160449602},
    {0.0078125, 1.5, 0.95574013653833420004},
    {-1.0, 1.5, 0.04},
    {-0.8046875, 1.5, 0.10579658165153356017},
    {-0.75, 1.5, 0.5},
    {-0.5, 1.5, 1},
    {0.3125, 2.385, 0.28661055433367301802},
    {-0.921875, 2.385, 0.24778675872027989839},
    {0.59375, 0.75, 1},
    {0.625, 1.0009765625, 8.1494900275528968639e-7},
    {0.015625, 1.0009765625, 0.24971540218879851954},
    {0.40625, 1.0, 0},
};

static const struct {
  double cosine, eta, k, reflectance;
} conductor[] = {
    {1.0, 0.2, 3.912, 0.95222096085558880545},
    {0.6328125, 0.2, 3.912, 0.94910609543672284231},
    {0.0234375, 0.2, 3.912, 0.98997119828217670475},
    {0.765625, 0.05078125, 4.25, 0.98910699994304760134},
    {1.0, 1.0, 2.385, 0.58712767302576060942},
    {0.3359375, 1.0, 2.385, 0.62679481176707266749},
    {0.8125, 1.5, 0.0, 0.043333496110564524030},
    {0.296875, 1.5, 0.0009765625, 0.21084304656679882794},
    {0.44921875, 2.75, 3.25, 0.53150848558896527767},
    {0.0, 1.375, 7.5, 1},
    {1.0, 0.0, 0.0, 1}, // the limit: what no light enters reflects all
    {0.5, 1.0, 2e4, 0.99999998750000021797},
    {0.859375, 0.001953125, 7.0, 0.99984207473449862486},
};

// An amplitude is a quotient of numbers known to a few epsilons; 1 / eta of the far side is
// rounded, and the nearest of these to a critical angle (0.75 against 0.7454) makes that 30 times
// larger.
static void reflectances_are_the_golden_ones(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof dielectric / sizeof *dielectric; i++) {
    double r = fresnel_dielectric(dielectric[i].cosine, dielectric[i].eta);
    if (!(fabs(r - dielectric[i].reflectance) <= 100 * DBL_EPSILON))
      fail_msg("dielectric %zu: %.17g", i, r);
  }
  for (size_t i = 0; i < sizeof conductor / sizeof *conductor; i++) {
    double r = fresnel_conductor(conductor[i].cosine, conductor[i].eta, conductor[i].k);
    if (!(fabs(r - conductor[i].reflectance) <= 16 * DBL_EPSILON))
      fail_msg("conductor %zu: %.17g", i, r);
  }
}

static void indices_that_match_reflect_nothing(void **state) {
  (void)state;
  struct draw draw = draw_named("indices_that_match_reflect_nothing");
  for (int i = 0; i < 1000; i++) {
    double cosine = exp(draw_between(&draw, -40, 0)), path;
    struct vec w = vec(sqrt(1 - cosine * cosine), 0, cosine), out = {0};
    assert_true(fresnel_dielectric(cosine, 1) == 0);
    assert_true(fresnel_dielectric(-cosine, 1) == 0);
    assert_true(fresnel_refract(w, vec(0, 0, 1), 1, &path, &out));
    assert_true(path == 1 && out.x == -w.x && out.z == -w.z);
  }
}

// R + T = 1 with T from the transmitted amplitudes: T = eta cos_t / cos_i |t|^2. The conductor with
// k = 0 is the dielectric.
static void what_is_not_reflected_is_transmitted(void **state) {
  (void)state;
  struct draw draw = draw_named("what_is_not_reflected_is_transmitted");
  int total = 0;
  for (int i = 0; i < 20000; i++) {
    double cosine = draw_between(&draw, -1, 1), eta = exp(draw_between(&draw, -1.5, 1.5));
    double r = fresnel_dielectric(cosine, eta), relative = cosine < 0 ? 1 / eta : eta;
    double c = fabs(cosine), sine = sqrt(1 - c * c) / relative, slack = 1e-13;
    assert_true(fabs(fresnel_conductor(c, relative, 0) - r) <= slack);
    if (sine >= 1) {
      total++;
      assert_true(r == 1);
      continue;
    }
    double cos_t = sqrt((1 - sine) * (1 + sine));
    double s = 2 * c / (c + relative * cos_t), p = 2 * c / (relative * c + cos_t);
    // cos_t is known to epsilon / cos_t
    assert_true(fabs(r + relative * cos_t / c * (s * s + p * p) / 2 - 1) <= slack / cos_t);
  }
  assert_true(total > 2000);
}

static void conductors_agree_with_complex_arithmetic(void **state) {
  (void)state;
  struct draw draw = draw_named("conductors_agree_with_complex_arithmetic");
  for (int i = 0; i < 20000; i++) {
    double c = draw_between(&draw, 0, 1);
    double complex n = exp(draw_between(&draw, -3, 2)) + I * exp(draw_between(&draw, -4, 3));
    double complex cos_t = csqrt(1 - (1 - c * c) / (n * n));
    double s = cabs((c - n * cos_t) / (c + n * cos_t)), p = cabs((n * c - cos_t) / (n * c + cos_t));
    assert_true(fabs(fresnel_conductor(c, creal(n), cimag(n)) - (s * s + p * p) / 2) <= 1e-13);
  }
}

static struct vec across(struct vec w, struct vec n) { return vec_along(w, n, -vec_dot(w, n)); }

// The refracted direction is of unit length, on the other side, in the plane of w and n, with
// eta sin_t = sin_i; refracting it back gives w. The reflected one mirrors.
static void directions_obey_snell(void **state) {
  (void)state;
  struct draw draw = draw_named("directions_obey_snell");
  int total = 0;
  for (int i = 0; i < 20000; i++) {
    struct vec n = draw_direction(&draw), w = draw_direction(&draw), t, back = {0};
    double eta = exp(draw_between(&draw, -1.5, 1.5)), path, path_back, slack = 1e-14;
    double cosine = vec_dot(w, n), relative = cosine < 0 ? 1 / eta : eta;
    struct vec r = fresnel_reflect(w, n);
    assert_true(fabs(vec_dot(r, n) - cosine) <= slack);
    assert_true(vec_length(vec_add(across(r, n), across(w, n))) <= slack);
    bool through = fresnel_refract(w, n, eta, &path, &t);
    assert_true(path == relative);
    assert_int_equal(through, fresnel_dielectric(cosine, eta) < 1);
    if (!through) {
      total++;
      assert_true(vec_length(across(w, n)) >= relative);
      continue;
    }
    assert_true(vec_dot(t, n) * cosine < 0);
    assert_true(fabs(vec_length(t) - 1) <= slack);
    assert_true(vec_length(vec_along(across(w, n), across(t, n), relative)) <= 10 * slack);
    assert_true(fresnel_refract(t, n, eta, &path_back, &back));
    // A grazing cosine is the root of a difference.
    assert_true(vec_length(vec_sub(back, w)) <= 1e-13 / (fabs(cosine) * fabs(vec_dot(t, n))));
  }
  assert_true(total > 2000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(reflectances_are_the_golden_ones),
      cmocka_unit_test(indices_that_match_reflect_nothing),
      cmocka_unit_test(what_is_not_reflected_is_transmitted),
      cmocka_unit_test(conductors_agree_with_complex_arithmetic),
      cmocka_unit_test(directions_obey_snell),
  };
  return cmocka_run_group_tests_name("fresnel", tests, NULL, NULL);
}
