// Enlarging to powers of two: against the filter's formula in libm's arithmetic, and what must not
// change.
#include "scene/resize.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

static struct arena arena, scratch;

static struct raster raster_of(int width, int height, int n, const float *value,
                               const unsigned char *byte, struct encoding encoding) {
  struct raster raster = {.width = width,
                          .height = height,
                          .n_channels = n,
                          .value = value,
                          .byte = byte,
                          .encoding = encoding};
  for (int b = 0; b < 256; b++) raster.linear[b] = encoding_decode(encoding, b / 255.0);
  return raster;
}

static const struct encoding linear = {ENCODING_LINEAR, 1};

static double sinc(double x) {
  double a = acos(-1) * x;
  return x == 0 ? 1 : sin(a) / a;
}

static double lanczos(double x) { return fabs(x) > 2 ? 0 : sinc(x) * sinc(x / 2); }

// Five texels in a row that ends, to eight.
static void a_row_is_filtered_by_lanczos(void **state) {
  (void)state;
  static const float old[] = {1, 4, 0, 2.385f, 9};
  struct raster raster = raster_of(5, 1, 1, old, NULL, linear);
  resize_to_powers_of_two(&raster, wrap_find("clamp"), &arena, scratch);
  assert_int_equal(raster.width, 8);
  assert_int_equal(raster.height, 1);
  for (int i = 0; i < 8; i++) {
    double centre = (i + 0.5) * 5 / 8, sum = 0, weights = 0;
    for (int k = -4; k < 10; k++) {
      double weight = lanczos(k + 0.5 - centre);
      sum += weight * (double)old[k < 0 ? 0 : k > 4 ? 4 : k];
      weights += weight;
    }
    double expected = sum / weights < 0 ? 0 : sum / weights;
    assert_true(fabs(raster_value(&raster, i, 0, 0) - expected) < 1e-5); // rows are kept in floats
  }
  assert_true(raster_value(&raster, 4, 0, 0) < 1); // near the 0
}

// Columns are treated as rows are: the transpose of the result is the result of the transpose.
static void columns_are_as_rows(void **state) {
  (void)state;
  static const float old[] = {1, 4, 0, 2, 9, 3}, transposed[] = {1, 2, 4, 9, 0, 3};
  static const char *const wraps[] = {"repeat", "clamp", "black"};
  for (int w = 0; w < 3; w++) {
    struct raster a = raster_of(3, 2, 1, old, NULL, linear);
    struct raster b = raster_of(2, 3, 1, transposed, NULL, linear);
    resize_to_powers_of_two(&a, wrap_find(wraps[w]), &arena, scratch);
    resize_to_powers_of_two(&b, wrap_find(wraps[w]), &arena, scratch);
    assert_true(a.width == 4 && a.height == 2 && b.width == 2 && b.height == 4);
    for (int y = 0; y < 2; y++)
      for (int x = 0; x < 4; x++)
        assert_true(fabs(raster_value(&a, x, y, 0) - raster_value(&b, y, x, 0)) < 1e-5);
  }
}

static void one_colour_stays_that_colour(void **state) {
  (void)state;
  static const struct encoding encodings[] = {
      {ENCODING_SRGB, 1}, {ENCODING_LINEAR, 1}, {ENCODING_GAMMA, 2.385}};
  static const char *const wraps[] = {"repeat", "clamp", "octahedralsphere"};
  for (int e = 0; e < 3; e++)
    for (int b = 0; b < 256; b++) {
      unsigned char byte[3 * 3 * 4];
      for (int j = 0; j < 36; j++) byte[j] = (unsigned char)(j % 4 ? b : 255 - b);
      struct arena kept = arena;
      struct raster raster = raster_of(3, 3, 4, NULL, byte, encodings[e]);
      resize_to_powers_of_two(&raster, wrap_find(wraps[b % 3]), &arena, scratch);
      for (int j = 0; j < 4 * 4 * 4; j++) assert_int_equal(raster.byte[j], j % 4 ? b : 255 - b);
      arena = kept;
    }
}

static void powers_of_two_are_left_alone(void **state) {
  (void)state;
  static const float old[8] = {1, 2};
  struct raster raster = raster_of(4, 2, 1, old, NULL, linear);
  resize_to_powers_of_two(&raster, wrap_find("repeat"), &arena, scratch);
  assert_true(raster.value == old && raster.width == 4 && raster.height == 2);
}

int main(void) {
  arena = arena_reserve();
  scratch = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_row_is_filtered_by_lanczos),
      cmocka_unit_test(columns_are_as_rows),
      cmocka_unit_test(one_colour_stays_that_colour),
      cmocka_unit_test(powers_of_two_are_left_alone),
  };
  return cmocka_run_group_tests_name("resize", tests, NULL, NULL);
}
