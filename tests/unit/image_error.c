// Metrics by their definitions, on images small enough for pencil and paper.
#include "analysis/image_error.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

static struct arena arena;

static struct image rgb(int width, int height, const float *value) {
  static const char *const names[] = {"R", "G", "B"};
  struct image image = image_new(width, height, 3, names, &arena);
  for (int c = 0; c < 3; c++)
    for (int j = 0; j < width * height; j++) image.plane[c][j] = value[3 * j + c];
  return image;
}

static void assert_near(double value, double expected) {
  if (!(fabs(value - expected) <= 1e-14 * fabs(expected)))
    fail_msg("%.17g, expected %.17g", value, expected);
}

// Two pixels. Differences 1, 0, -2 and 0, 4, 0.5; references 1, 0, 4 and 0, 0.5, 0.5.
static void metrics_are_their_definitions(void **state) {
  (void)state;
  const float x[] = {2, 0, 2, 0, 4.5f, 1}, r[] = {1, 0, 4, 0, 0.5f, 0.5f};
  struct image image = rgb(2, 1, x), reference = rgb(2, 1, r);
  struct problem problem = {0};
  double value[IMAGE_METRICS];
  assert_true(image_error(&image, "x", &reference, "r", value, &problem));
  assert_near(value[0], (1 + 4 + 16 + 0.25) / 6);
  assert_near(value[1], (1 / 1.01 + 4 / 16.01 + 16 / 0.26 + 0.25 / 0.26) / 6);
  assert_near(value[2], (1.0 / 3 + 2.0 / 6 + 4.0 / 5 + 0.5 / 1.5) / 6);
  assert_string_equal(image_metrics[1].name, "relmse");
}

static void an_image_is_like_itself(void **state) {
  (void)state;
  const float x[] = {0, 1e30f, -3};
  struct image image = rgb(1, 1, x);
  struct problem problem = {0};
  double value[IMAGE_METRICS];
  assert_true(image_error(&image, "x", &image, "x", value, &problem));
  for (int m = 0; m < IMAGE_METRICS; m++) assert_true(value[m] == 0);
}

static void assert_refused(const struct image *image, const struct image *reference,
                           const char *says) {
  struct problem problem = {0};
  double value[IMAGE_METRICS];
  assert_false(image_error(image, "x", reference, "r", value, &problem));
  assert_string_equal(problem.text, says);
}

static void what_cannot_be_compared_is_refused(void **state) {
  (void)state;
  const float ones[] = {1, 1, 1, 1, 1, 1}, bad[] = {1, 1, 1, 1, NAN, 1};
  static const char *const depth[] = {"Z"};
  struct image pair = rgb(2, 1, ones), single = rgb(1, 1, ones), broken = rgb(2, 1, bad);
  struct image other = image_new(2, 1, 1, depth, &arena);
  assert_refused(&single, &pair, "x: has 1 x 1 pixels, r 2 x 1");
  assert_refused(&broken, &pair, "x: pixel [1, 0] is not finite");
  assert_refused(&pair, &broken, "r: pixel [1, 0] is not finite");
  assert_refused(&other, &pair, "x: has no channel R");
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(metrics_are_their_definitions),
      cmocka_unit_test(an_image_is_like_itself),
      cmocka_unit_test(what_cannot_be_compared_is_refused),
  };
  return cmocka_run_group_tests_name("image_error", tests, NULL, NULL);
}
