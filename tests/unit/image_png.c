// PNG files of every type, built from their pixels by the rules of the format.
#include "raster_check.h"

#include <zlib.h>

static void put_word(struct bytes *file, uint32_t word) {
  for (int b = 3; b >= 0; b--) put_byte(file, (int)(word >> 8 * b & 255));
}

static void put_chunk(struct bytes *file, const char *name, const void *data, int n) {
  put_word(file, (uint32_t)n);
  int from = file->n;
  put(file, name, 4);
  if (n) put(file, data, n);
  put_word(file, (uint32_t)crc32(0, file->data + from, (uInt)(file->n - from)));
}

// scanlines: filter byte and samples of each row, already in the order of an interlaced file.
static struct bytes png(int width, int height, int bits, int type, bool interlaced,
                        const unsigned char *palette, int n_palette, const unsigned char *alphas,
                        int n_alphas, const unsigned char *scanlines, int n) {
  struct bytes file = {.n = 0}, head = {.n = 0};
  put(&file, "\x89PNG\r\n\x1a\n", 8);
  put_word(&head, (uint32_t)width);
  put_word(&head, (uint32_t)height);
  put(&head, (const unsigned char[]){(unsigned char)bits, (unsigned char)type, 0, 0, interlaced},
      5);
  put_chunk(&file, "IHDR", head.data, head.n);
  put_chunk(&file, "gAMA", "\0\0\xff\xff", 4); // pbrt does not look at it
  if (palette) put_chunk(&file, "PLTE", palette, n_palette);
  if (alphas) put_chunk(&file, "tRNS", alphas, n_alphas);
  unsigned char packed[1 << 14];
  uLongf length = sizeof packed;
  assert_int_equal(compress(packed, &length, scanlines, (uLong)n), Z_OK);
  put_chunk(&file, "IDAT", packed, (int)length);
  put_chunk(&file, "IEND", NULL, 0);
  return file;
}

#define LINES(...) (const unsigned char[]){__VA_ARGS__}, sizeof((unsigned char[]){__VA_ARGS__})

static void gray_of_1_2_4_and_8_bits(void **state) {
  (void)state;
  struct bytes file = png(3, 2, 1, 0, false, NULL, 0, NULL, 0, LINES(0, 0xa0, 0, 0x40));
  struct raster raster = decode_ok(&file, "a.png", as_srgb);
  assert_shape(&raster, 3, 2, 1);
  assert_bytes(&raster, (const unsigned char[]){255, 0, 255, 0, 255, 0});
  file = png(4, 1, 2, 0, false, NULL, 0, NULL, 0, LINES(0, 0x1b));
  raster = decode_ok(&file, "a.png", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){0, 85, 170, 255});
  file = png(2, 1, 4, 0, false, NULL, 0, NULL, 0, LINES(0, 0x3e));
  raster = decode_ok(&file, "a.png", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){3 * 17, 14 * 17});
  file = png(3, 1, 8, 0, false, NULL, 0, NULL, 0, LINES(1, 10, 1, 2)); // filter: differences
  raster = decode_ok(&file, "a.png", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){10, 11, 13});
}

static void colour_palette_and_their_transparency(void **state) {
  (void)state;
  static const unsigned char palette[] = {1, 2, 3, 40, 50, 60, 7, 8, 9};
  struct bytes file = png(2, 1, 8, 2, false, NULL, 0, NULL, 0, LINES(0, 1, 2, 3, 250, 251, 252));
  struct raster raster = decode_ok(&file, "a.png", as_srgb);
  assert_shape(&raster, 2, 1, 3);
  assert_bytes(&raster, (const unsigned char[]){1, 2, 3, 250, 251, 252});
  // pbrt takes the colours of a palette and not its transparency.
  file = png(4, 1, 2, 3, false, palette, 9, (const unsigned char *)"\0\x80", 2, LINES(0, 0x91));
  raster = decode_ok(&file, "a.png", as_srgb);
  assert_shape(&raster, 4, 1, 3);
  assert_bytes(&raster, (const unsigned char[]){7, 8, 9, 40, 50, 60, 1, 2, 3, 40, 50, 60});
  file = png(2, 1, 8, 4, false, NULL, 0, NULL, 0, LINES(0, 9, 128, 200, 0)); // gray with alpha
  raster = decode_ok(&file, "a.png", as_srgb);
  assert_shape(&raster, 2, 1, 1);
  assert_bytes(&raster, (const unsigned char[]){9, 200});
}

static void alpha_is_kept_where_it_is_not_1_everywhere(void **state) {
  (void)state;
  struct bytes file =
      png(2, 1, 8, 6, false, NULL, 0, NULL, 0, LINES(0, 1, 2, 3, 255, 4, 5, 6, 254));
  struct raster raster = decode_ok(&file, "a.png", as_srgb);
  assert_shape(&raster, 2, 1, 4);
  assert_bytes(&raster, (const unsigned char[]){1, 2, 3, 255, 4, 5, 6, 254});
  file = png(2, 1, 8, 6, false, NULL, 0, NULL, 0, LINES(0, 1, 2, 3, 255, 4, 5, 6, 255));
  raster = decode_ok(&file, "a.png", as_srgb);
  assert_shape(&raster, 2, 1, 3);
  assert_bytes(&raster, (const unsigned char[]){1, 2, 3, 4, 5, 6});
}

// Values of 16 bits become linear floats by the encoding asked for.
static void words_are_decoded_when_read(void **state) {
  (void)state;
  static const struct encoding square = {ENCODING_GAMMA, 2};
  struct bytes file = png(2, 1, 16, 0, false, NULL, 0, NULL, 0, LINES(0, 0x80, 0x01, 0xff, 0xff));
  struct raster raster = decode_ok(&file, "a.png", as_linear);
  assert_shape(&raster, 2, 1, 1);
  assert_null(raster.byte);
  assert_true(raster_value(&raster, 0, 0, 0) == (float)(0x8001 / 65535.0));
  assert_true(raster_value(&raster, 1, 0, 0) == 1);
  raster = decode_ok(&file, "a.png", square);
  double v = 0x8001 / 65535.0;
  assert_true(raster_value(&raster, 0, 0, 0) == (float)(v * v));
  file = png(1, 1, 16, 6, false, NULL, 0, NULL, 0, LINES(0, 0x12, 0x34, 0, 0, 0xff, 0xff, 0x40, 0));
  raster = decode_ok(&file, "a.png", as_linear);
  assert_shape(&raster, 1, 1, 4);
  assert_true(raster_value(&raster, 0, 0, 0) == (float)(0x1234 / 65535.0));
  assert_true(raster_value(&raster, 0, 0, 3) == (float)(0x4000 / 65535.0));
}

// Adam7 of a 3 x 3 image whose pixel x, y is 10 y + x: passes 1, 4, 5, 6 and 7 hold (0,0); (2,0);
// (0,2) (2,2); (1,0), (1,2); (0..2,1).
static void interlaced_files(void **state) {
  (void)state;
  struct bytes file = png(3, 3, 8, 0, true, NULL, 0, NULL, 0,
                          LINES(0, 0, 0, 2, 0, 20, 22, 0, 1, 0, 21, 0, 10, 11, 12));
  struct raster raster = decode_ok(&file, "a.png", as_srgb);
  assert_bytes(&raster, (const unsigned char[]){0, 1, 2, 10, 11, 12, 20, 21, 22});
}

static void files_that_lie_are_refused(void **state) {
  (void)state;
  struct bytes file = {.n = 0};
  assert_refused(&file, "a.png", "ends before its last pixel");
  put_text(&file, "not a png file at all, but long enough");
  assert_refused(&file, "a.png", "not a png file we can read");
  file = png(900000, 900000, 8, 2, false, NULL, 0, NULL, 0, LINES(0, 1, 2, 3));
  assert_refused(&file, "a.png", "is too short for the size it claims");
  file = png(2, 2, 8, 2, false, NULL, 0, NULL, 0, LINES(0, 1, 2, 3));
  assert_refused(&file, "a.png", "not a png file we can read");
  file = png(1, 1, 8, 2, false, NULL, 0, NULL, 0, LINES(0, 1, 2, 3));
  file.data[file.n - 14] ^= 1; // of the checksum of IDAT
  assert_refused(&file, "a.png", "CRC");
}

static void damaged_files_never_crash(void **state) {
  (void)state;
  struct bytes file = png(3, 3, 8, 0, true, NULL, 0, NULL, 0,
                          LINES(0, 0, 0, 2, 0, 20, 22, 0, 1, 0, 21, 0, 10, 11, 12));
  assert_true(assert_survives(&file, "a.png", 2000) > 1000);
}

int main(void) {
  raster_arena = arena_reserve();
  raster_scratch = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gray_of_1_2_4_and_8_bits),
      cmocka_unit_test(colour_palette_and_their_transparency),
      cmocka_unit_test(alpha_is_kept_where_it_is_not_1_everywhere),
      cmocka_unit_test(words_are_decoded_when_read),
      cmocka_unit_test(interlaced_files),
      cmocka_unit_test(files_that_lie_are_refused),
      cmocka_unit_test(damaged_files_never_crash),
  };
  return cmocka_run_group_tests_name("image_png", tests, NULL, NULL);
}
