// Radiance files written by hand: value = mantissa 2^(exponent - 136).
#include "raster_check.h"

static struct bytes header(const char *resolution) {
  struct bytes file = {.n = 0};
  put_text(&file, "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=3\n\n");
  put_text(&file, resolution);
  put_text(&file, "\n");
  return file;
}

#define PUT(file, ...)                                                                             \
  put(file, (const unsigned char[]){__VA_ARGS__}, sizeof((unsigned char[]){__VA_ARGS__}))

static void assert_pixel(const struct raster *raster, int x, int y, double r, double g, double b) {
  assert_true(raster_value(raster, x, y, 0) == r);
  assert_true(raster_value(raster, x, y, 1) == g);
  assert_true(raster_value(raster, x, y, 2) == b);
}

static void flat_pixels_in_every_order_of_rows(void **state) {
  (void)state;
  static const char *const resolution[] = {"-Y 2 +X 2", "+Y 2 +X 2", "-Y 2 -X 2", "+Y 2 -X 2"};
  for (int order = 0; order < 4; order++) {
    struct bytes file = header(resolution[order]);
    PUT(&file, 128, 64, 3, 129, 9, 9, 9, 0, 255, 0, 1, 136, 1, 2, 3, 127);
    struct raster raster = decode_ok(&file, "a.hdr", as_srgb);
    assert_shape(&raster, 2, 2, 3);
    assert_null(raster.byte);
    int y = order & 1, x = order >> 1;
    assert_pixel(&raster, x, y, 1, 0.5, 3 / 128.0);
    assert_pixel(&raster, 1 - x, y, 0, 0, 0); // exponent 0 is black
    assert_pixel(&raster, x, 1 - y, 255, 0, 1);
    assert_pixel(&raster, 1 - x, 1 - y, 1 / 512.0, 2 / 512.0, 3 / 512.0);
  }
}

// Ten pixels: (1, 2, 3) 2^-8 five times, then (9, 8, 7), (6, 5, 4) ...
static void new_runs(void **state) {
  (void)state;
  struct bytes file = header("-Y 1 +X 10");
  PUT(&file, 2, 2, 0, 10);
  PUT(&file, 128 + 5, 1, 5, 9, 6, 6, 6, 6);
  PUT(&file, 128 + 5, 2, 5, 8, 5, 5, 5, 5);
  PUT(&file, 128 + 5, 3, 5, 7, 4, 4, 4, 4);
  PUT(&file, 128 + 10, 128);
  struct raster raster = decode_ok(&file, "a.HDR", as_srgb);
  assert_shape(&raster, 10, 1, 3);
  for (int x = 0; x < 5; x++) assert_pixel(&raster, x, 0, 1 / 256.0, 2 / 256.0, 3 / 256.0);
  assert_pixel(&raster, 5, 0, 9 / 256.0, 8 / 256.0, 7 / 256.0);
  for (int x = 6; x < 10; x++) assert_pixel(&raster, x, 0, 6 / 256.0, 5 / 256.0, 4 / 256.0);
}

// 1, 1, 1, n: n times the pixel before; a second one in a row counts 256 fold.
static void old_runs(void **state) {
  (void)state;
  struct bytes file = header("-Y 1 +X 300");
  PUT(&file, 4, 5, 6, 136, 1, 1, 1, 40, 1, 1, 1, 1, 7, 8, 9, 136, 1, 1, 1, 2);
  struct raster raster = decode_ok(&file, "a.hdr", as_srgb);
  for (int x = 0; x < 297; x++) assert_pixel(&raster, x, 0, 4, 5, 6);
  for (int x = 297; x < 300; x++) assert_pixel(&raster, x, 0, 7, 8, 9);
}

static void files_that_lie_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *text, *says;
  } row[] = {
      {"P6\n", "must begin with #?"},
      {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "ends in its header"},
      {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n....", "is not FORMAT=32-bit_rle_rgbe"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 1\n....", "bad resolution"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 1\n....", "bad resolution"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999999999999999 +X 1\n....", "bad resolution"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9999999 +X 9999999\n....", "is too short for its"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n....", "ends before its last pixel"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\1\1\1\1....", "a run is longer"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n....\1\1\1\2", "a run is longer"},
      {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n\2\2\1\1....", "of another width"},
  };
  for (size_t j = 0; j < sizeof row / sizeof *row; j++) {
    struct bytes file = {.n = 0};
    put_text(&file, row[j].text);
    assert_refused(&file, "a.hdr", row[j].says);
  }
}

static void damaged_files_never_crash(void **state) {
  (void)state;
  struct bytes file = header("-Y 1 +X 10");
  PUT(&file, 2, 2, 0, 10, 128 + 5, 1, 5, 9, 6, 6, 6, 6, 128 + 10, 2, 128 + 10, 3, 128 + 10, 128);
  decode_ok(&file, "a.hdr", as_srgb);
  assert_true(assert_survives(&file, "a.hdr", 4000) > 100);
}

int main(void) {
  raster_arena = arena_reserve();
  raster_scratch = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flat_pixels_in_every_order_of_rows),
      cmocka_unit_test(new_runs),
      cmocka_unit_test(old_runs),
      cmocka_unit_test(files_that_lie_are_refused),
      cmocka_unit_test(damaged_files_never_crash),
  };
  return cmocka_run_group_tests_name("image_hdr", tests, NULL, NULL);
}
