// References and their own errors, on images small enough for pencil and paper.
#include "analysis/reference_image.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

static struct arena arena;

static struct image picture(const float mean[3], const float variance[3]) {
  static const char *const names[] = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  struct image image = image_new(1, 1, 6, names, &arena);
  for (int c = 0; c < 3; c++) {
    image.plane[c][0] = mean[c];
    image.plane[3 + c][0] = variance[c];
  }
  return image;
}

static void assert_near(double value, double expected) {
  if (!(fabs(value - expected) <= 1e-6 * fabs(expected) + 1e-15))
    fail_msg("%.9g, expected %.9g", value, expected);
}

// The variance of a mean of four runs is a quarter of one's.
static void noise_is_that_of_the_mean(void **state) {
  (void)state;
  struct image image = picture((float[]){0.5f, 2, 0}, (float[]){0.25f, 1, 0.125f});
  struct moment_image at = {&image, 4, "x"};
  struct reference_image reference;
  struct problem problem = {0};
  assert_true(reference_image_unbiased(&at, &arena, &reference, &problem));
  assert_true(reference.image.plane[1][0] == 2 && reference.bias == 0);
  assert_near(reference.noise, (0.0625 / 0.26 + 0.25 / 4.01 + 0.03125 / 0.01) / 3);
}

// x(r) = 3 + c r^2 at radii 1, 2, 4 gives 3, and nothing is left of the bias.
static void a_bias_in_r2_goes_away(void **state) {
  (void)state;
  const float none[3] = {0};
  struct image image[3];
  struct moment_image at[3];
  struct reference_image reference;
  struct problem problem = {0};
  for (int k = 0; k < 3; k++) {
    float r2 = (float)(1 << 2 * k);
    image[k] = picture((float[]){3 + 0.5f * r2, 3 - 0.125f * r2, 3}, none);
    at[k] = (struct moment_image){&image[k], 2, "x"};
  }
  assert_true(reference_image_extrapolated(at, &arena, &reference, &problem));
  for (int c = 0; c < 3; c++) assert_near(reference.image.plane[c][0], 3);
  assert_near(reference.noise, 0);
  assert_near(reference.bias, 0);
}

// x = 1, 3, 9 of red at r, 2 r, 4 r: e(r) = 1 / 3, e(2 r) = 1, so that twice the square of the
// difference is 8 / 9. Variances 0.09, 0.18, 0.36 of one of two runs, 0.045, 0.09, 0.18 of the
// means, make e(r)'s (16 x 0.045 + 0.09) / 9 = 0.09 and that of the difference (16 x 0.045 + 25 x
// 0.09 + 0.18) / 9 = 0.35.
static void what_is_left_is_seen_without_noise(void **state) {
  (void)state;
  struct image image[3];
  struct moment_image at[3];
  struct reference_image reference;
  struct problem problem = {0};
  for (int k = 0; k < 3; k++) {
    const float x[] = {1, 3, 9}, variance[] = {0.09f, 0.18f, 0.36f};
    image[k] = picture((float[]){x[k], 0, 0}, (float[]){variance[k], 0, 0});
    at[k] = (struct moment_image){&image[k], 2, "x"};
  }
  assert_true(reference_image_extrapolated(at, &arena, &reference, &problem));
  double scale = 3 * (1.0 / 9 + 0.01);
  assert_near(reference.noise, 0.09 / scale);
  assert_near(reference.bias, 2 * (4.0 / 9 - 0.35) / scale);
}

static void what_is_no_reference_is_refused(void **state) {
  (void)state;
  struct image image = picture((float[]){1, 1, 1}, (float[]){1, NAN, 1});
  struct moment_image at = {&image, 4, "x"};
  struct reference_image reference;
  struct problem problem = {0};
  assert_false(reference_image_unbiased(&at, &arena, &reference, &problem));
  problem = (struct problem){0};
  at.runs = 1;
  assert_false(reference_image_unbiased(&at, &arena, &reference, &problem));
  assert_string_equal(problem.text, "x: one run has no spread");
  problem = (struct problem){0};
  at.runs = 4;
  image.n_channels = 3;
  assert_false(reference_image_unbiased(&at, &arena, &reference, &problem));
  assert_string_equal(problem.text, "x: has no mean and variance of R, G and B");
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(noise_is_that_of_the_mean),
      cmocka_unit_test(a_bias_in_r2_goes_away),
      cmocka_unit_test(what_is_left_is_seen_without_noise),
      cmocka_unit_test(what_is_no_reference_is_refused),
  };
  return cmocka_run_group_tests_name("reference_image", tests, NULL, NULL);
}
