// Textures of floats (exr, pfm), channels, encodings.
#define _GNU_SOURCE // mkdtemp
#include "image/image.h"
#include "raster_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[] = P_tmpdir "/photonlab-raster-XXXXXX";

// Plane c of pixel j: 2.385 + j + 100 c, alpha as given.
static struct raster through_file(const char *extension, int n, const char *const *names,
                                  float alpha) {
  struct image image = image_new(3, 2, n, names, &raster_arena);
  for (int c = 0; c < n; c++)
    for (int j = 0; j < 6; j++)
      image.plane[c][j] = strcmp(names[c], "A") == 0 ? alpha : 2.385f + (float)(j + 100 * c);
  const char *path = arena_format(&raster_arena, "%s/a.%s", folder, extension);
  struct problem problem = {0};
  struct raster raster;
  struct text text;
  if (!image_write(path, &image, &problem) || !file_read(path, &raster_arena, &text, &problem) ||
      !raster_decode(text, path, as_srgb, &raster_arena, raster_scratch, &raster, &problem))
    fail_msg("%s", problem.text);
  unlink(path);
  assert_shape(&raster, 3, 2, raster.n_channels);
  assert_null(raster.byte);
  return raster;
}

static void exr_and_pfm_are_linear_floats_in_the_order_r_g_b_a(void **state) {
  (void)state;
  static const char *const rgba[] = {"R", "G", "B", "A"},
                           *const mixed[] = {"B", "z", "R", "A", "G"}, *const depth[] = {"Z"};
  static const char *const extension[] = {"exr", "pfm"};
  for (int e = 0; e < 2; e++) {
    struct raster raster = through_file(extension[e], 3, rgba, 0);
    assert_int_equal(raster.n_channels, 3);
    for (int j = 0; j < 6; j++)
      for (int c = 0; c < 3; c++)
        assert_true(raster_value(&raster, j % 3, j / 3, c) == 2.385f + (float)(j + 100 * c));
  }
  struct raster raster = through_file("exr", 5, mixed, 0.5f);
  assert_int_equal(raster.n_channels, 4);
  assert_true(raster_value(&raster, 2, 1, 0) == 2.385f + 205);
  assert_true(raster_value(&raster, 2, 1, 1) == 2.385f + 405);
  assert_true(raster_value(&raster, 2, 1, 2) == 2.385f + 5);
  assert_true(raster_value(&raster, 2, 1, 3) == 0.5);
  raster = through_file("exr", 4, rgba, 1); // opaque: no alpha at all
  assert_int_equal(raster.n_channels, 3);
  assert_true(raster_value(&raster, 2, 1, 2) == 2.385f + 205);
  raster = through_file("exr", 1, depth, 0); // a single channel needs no name
  assert_int_equal(raster.n_channels, 1);
  assert_true(raster_value(&raster, 1, 1, 0) == 2.385f + 4);
}

static void gray_pfm_of_either_byte_order(void **state) {
  (void)state;
  struct bytes file = {.n = 0};
  put_text(&file, "Pf 1 2 1\n");
  put(&file, "\x40\x18\xa3\xd7\x3f\x80\0\0", 8); // the bottom row, 2.385f, first
  struct raster raster = decode_ok(&file, "a.pfm", as_srgb);
  assert_shape(&raster, 1, 2, 1);
  assert_true(raster_value(&raster, 0, 0, 0) == 1 && raster_value(&raster, 0, 1, 0) == 2.385f);
  file.n = 0;
  put_text(&file, "Pf 1 2 -1\n");
  put(&file, "\xd7\xa3\x18\x40\0\0\x80\x3f", 8);
  raster = decode_ok(&file, "a.pfm", as_srgb);
  assert_true(raster_value(&raster, 0, 0, 0) == 1 && raster_value(&raster, 0, 1, 0) == 2.385f);
}

static void what_is_not_a_number_is_refused_with_its_pixel(void **state) {
  (void)state;
  struct bytes file = {.n = 0};
  put_text(&file, "Pf 1 2 -1\n");
  put(&file, "\0\0\xc0\x7f\0\0\x80\x7f", 8);
  assert_refused(&file, "a.pfm", "pixel 0, 0 is not a finite number");
  memset(file.data + file.n - 4, 0, 4);
  assert_refused(&file, "a.pfm", "pixel 0, 1 is not a finite number");
}

static void an_unknown_extension_lists_the_known_ones(void **state) {
  (void)state;
  static const char *const path[] = {"a.gif", "a", "a.png.bak", "d.png/a"};
  struct bytes file = {.n = 0};
  for (int j = 0; j < 4; j++)
    assert_refused(&file, path[j], ".exr, .pfm, .hdr, .png, .jpg, .jpeg, .tga");
}

static void encodings_are_parsed_or_refused(void **state) {
  (void)state;
  struct encoding encoding;
  assert_true(encoding_parse("sRGB", &encoding) && encoding.curve == ENCODING_SRGB);
  assert_true(encoding_parse("linear", &encoding) && encoding.curve == ENCODING_LINEAR);
  assert_true(encoding_parse("gamma 2.2", &encoding) && encoding.curve == ENCODING_GAMMA);
  assert_true(encoding.gamma == 2.2);
  static const char *const bad[] = {"",        "srgb",     "gamma",     "gamma ",  "gamma 0",
                                    "gamma x", "gamma -1", "gamma nan", "gamma 1x"};
  for (size_t j = 0; j < sizeof bad / sizeof *bad; j++)
    assert_false(encoding_parse(bad[j], &encoding));
}

// IEC 61966-2-1 and the power law in libm's double arithmetic; the standard's anchors 188 = one
// half and 118 = middle gray within half a step of the 8 bits.
static void encodings_are_what_the_standard_says(void **state) {
  (void)state;
  static const struct encoding gamma = {ENCODING_GAMMA, 2.385};
  for (int b = 0; b < 256; b++) {
    double v = b / 255.0, linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    // Two roundings of each of the power functions.
    assert_true(fabs(encoding_decode(as_srgb, v) - linear) <= 4 * 0x1p-53 * linear);
    assert_true(fabs(encoding_decode(gamma, v) - pow(v, 2.385)) <= 4 * 0x1p-53 * pow(v, 2.385));
    assert_true(encoding_decode(as_linear, v) == v);
  }
  assert_true(encoding_decode(as_srgb, 1) == 1 && encoding_decode(as_srgb, 0) == 0);
  assert_true(encoding_decode(as_srgb, 187.5 / 255) < 0.5 &&
              encoding_decode(as_srgb, 188.5 / 255) > 0.5);
  assert_true(encoding_decode(as_srgb, 117.5 / 255) < 0.18 &&
              encoding_decode(as_srgb, 118.5 / 255) > 0.18);
}

int main(void) {
  raster_arena = arena_reserve();
  raster_scratch = arena_reserve();
  if (!mkdtemp(folder)) die("cannot make %s", folder);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exr_and_pfm_are_linear_floats_in_the_order_r_g_b_a),
      cmocka_unit_test(gray_pfm_of_either_byte_order),
      cmocka_unit_test(what_is_not_a_number_is_refused_with_its_pixel),
      cmocka_unit_test(an_unknown_extension_lists_the_known_ones),
      cmocka_unit_test(encodings_are_parsed_or_refused),
      cmocka_unit_test(encodings_are_what_the_standard_says),
  };
  int failed = cmocka_run_group_tests_name("image_raster", tests, NULL, NULL);
  rmdir(folder);
  return failed;
}
