// TGA files written by hand, read as textures.
#include "raster_check.h"

enum { TOP = 32, RIGHT = 16 };

static struct bytes header(int type, int width, int height, int bits, int descriptor) {
  struct bytes file = {.n = 0};
  const unsigned char head[18] = {3,
                                  type == 1 || type == 9,
                                  (unsigned char)type,
                                  [12] = (unsigned char)width,
                                  (unsigned char)(width >> 8),
                                  (unsigned char)height,
                                  (unsigned char)(height >> 8),
                                  (unsigned char)bits,
                                  (unsigned char)descriptor};
  put(&file, head, 18);
  put_text(&file, "tag"); // the three bytes of text the first one announces
  return file;
}

#define PUT(file, ...)                                                                             \
  put(file, (const unsigned char[]){__VA_ARGS__}, sizeof((unsigned char[]){__VA_ARGS__}))

static void true_colour_of_24_bits_from_every_corner(void **state) {
  (void)state;
  // Red, green / blue, (1, 2, 3) as seen from the top left.
  static const unsigned char expected[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3};
  static const unsigned char bgr[4][3] = {{0, 0, 255}, {0, 255, 0}, {255, 0, 0}, {3, 2, 1}};
  for (int corner = 0; corner < 4; corner++) {
    bool top = corner & 1, right = corner & 2;
    struct bytes file = header(2, 2, 2, 24, (top ? TOP : 0) | (right ? RIGHT : 0));
    for (int row = 0; row < 2; row++)
      for (int k = 0; k < 2; k++)
        put(&file, bgr[2 * (top ? row : 1 - row) + (right ? 1 - k : k)], 3);
    struct raster raster = decode_ok(&file, "a.tga", as_linear);
    assert_shape(&raster, 2, 2, 3);
    assert_bytes(&raster, expected);
    // Whatever the scene says of its encoding, as in pbrt.
    assert_true(raster_value(&raster, 1, 1, 1) == encoding_decode(as_srgb, 2 / 255.0));
  }
}

static void bits_16_and_32_and_an_upper_case_name(void **state) {
  (void)state;
  struct bytes file = header(2, 2, 1, 16, TOP);
  PUT(&file, 0x1f, 0x00, 0x31, 0x7e); // blue; r = 31, g = 17, b = 17
  struct raster raster = decode_ok(&file, "DIR.X/A.TGA", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){0, 0, 255, 255, 139, 139}); // 17 * 255 / 31
  file = header(2, 1, 1, 32, TOP | 8);
  PUT(&file, 3, 2, 1, 77);
  raster = decode_ok(&file, "a.tga", as_srgb);
  assert_shape(&raster, 1, 1, 3);
  assert_bytes(&raster, (const unsigned char[]){1, 2, 3});
}

static void gray_of_8_bits_and_with_alpha(void **state) {
  (void)state;
  struct bytes file = header(3, 3, 1, 8, 0);
  PUT(&file, 7, 0, 255);
  struct raster raster = decode_ok(&file, "a.tga", as_srgb);
  assert_shape(&raster, 3, 1, 1);
  assert_bytes(&raster, (const unsigned char[]){7, 0, 255});
  file = header(3, 2, 1, 16, 0);
  PUT(&file, 9, 200, 11, 3);
  raster = decode_ok(&file, "a.tga", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){9, 11});
}

static struct bytes mapped(int type, int first, int last) {
  struct bytes file = header(type, 3, 1, 8, TOP);
  file.data[3] = (unsigned char)first;
  file.data[5] = 2;
  file.data[7] = 24;
  PUT(&file, 30, 20, 10, 60, 50, 40);
  if (type == 1)
    PUT(&file, (unsigned char)(first + 1), (unsigned char)first, (unsigned char)last);
  else
    PUT(&file, 0x00, (unsigned char)(first + 1), 0x81, (unsigned char)first);
  return file;
}

static void colour_maps_count_from_their_first_entry(void **state) {
  (void)state;
  static const unsigned char expected[] = {40, 50, 60, 10, 20, 30, 10, 20, 30};
  for (int first = 0; first < 9; first += 4)
    for (int type = 1; type <= 9; type += 8) {
      struct bytes file = mapped(type, first, first);
      struct raster raster = decode_ok(&file, "a.tga", as_srgb);
      assert_shape(&raster, 3, 1, 3);
      assert_bytes(&raster, expected);
    }
  struct bytes file = mapped(1, 4, 3);
  assert_refused(&file, "a.tga", "entry 3 of a colour map of 4 to 5");
  file = mapped(1, 4, 6);
  assert_refused(&file, "a.tga", "entry 6 of a colour map of 4 to 5");
}

// Packets may run on over the end of a row.
static void run_lengths_of_colour_and_gray(void **state) {
  (void)state;
  struct bytes file = header(10, 3, 2, 24, TOP);
  PUT(&file, 0x83, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7);
  struct raster raster = decode_ok(&file, "a.tga", as_srgb);
  assert_bytes(&raster,
               (const unsigned char[]){1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  file = header(11, 2, 2, 8, 0);
  PUT(&file, 0x00, 5, 0x82, 6);
  raster = decode_ok(&file, "a.tga", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){6, 6, 5, 6});
}

static void files_that_lie_are_refused(void **state) {
  (void)state;
  struct bytes file = header(2, 2, 2, 24, 0);
  assert_refused(&file, "a.tga", "is too short for its 2 x 2 pixels");
  file = header(10, 65535, 65535, 24, 0);
  PUT(&file, 255, 1, 2, 3);
  assert_refused(&file, "a.tga", "is too short for its 65535 x 65535 pixels");
  file = header(10, 2, 1, 24, 0);
  PUT(&file, 0, 1, 2, 3);
  assert_refused(&file, "a.tga", "ends before its last pixel");
  file = header(2, 0, 2, 24, 0);
  assert_refused(&file, "a.tga", "has no pixels");
  file = header(2, 1, 1, 12, 0);
  assert_refused(&file, "a.tga", "has 12 bits a pixel");
  file = header(4, 1, 1, 24, 0);
  assert_refused(&file, "a.tga", "not a tga file of type");
  file = header(32, 1, 1, 24, 0);
  assert_refused(&file, "a.tga", "not a tga file of type");
}

static void damaged_files_never_crash(void **state) {
  (void)state;
  struct bytes file = mapped(1, 4, 4);
  assert_true(assert_survives(&file, "a.tga", 4000) > 100);
  file = header(10, 3, 2, 24, TOP);
  PUT(&file, 0x83, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7);
  assert_true(assert_survives(&file, "a.tga", 4000) > 100);
}

int main(void) {
  raster_arena = arena_reserve();
  raster_scratch = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(true_colour_of_24_bits_from_every_corner),
      cmocka_unit_test(bits_16_and_32_and_an_upper_case_name),
      cmocka_unit_test(gray_of_8_bits_and_with_alpha),
      cmocka_unit_test(colour_maps_count_from_their_first_entry),
      cmocka_unit_test(run_lengths_of_colour_and_gray),
      cmocka_unit_test(files_that_lie_are_refused),
      cmocka_unit_test(damaged_files_never_crash),
  };
  return cmocka_run_group_tests_name("image_tga", tests, NULL, NULL);
}
