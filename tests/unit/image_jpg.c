// JPEG files whose coefficients are written by hand, and the same bits without vector instructions.
#define _GNU_SOURCE // setenv, fork
#include "raster_check.h"

#include <stdio.h>

#include <jpeglib.h>
#include <math.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

// ---- a baseline file from its coefficients ----

// Every code has 4 bits and is the row of its symbol: categories 0 to 11 for DC; for AC the end of
// the block, then categories 1 to 10 after no zeros.
enum { CODE_BITS = 4, N_DC = 12, N_AC = 11, QUANTUM = 8 };

struct bits {
  struct bytes *file;
  unsigned buffer;
  int count;
};

static void put_bits(struct bits *bits, unsigned value, int count) {
  for (int b = count - 1; b >= 0; b--) {
    bits->buffer = bits->buffer << 1 | (value >> b & 1);
    if (++bits->count < 8) continue;
    put_byte(bits->file, (int)bits->buffer);
    if (bits->buffer == 255) put_byte(bits->file, 0);
    bits->buffer = 0;
    bits->count = 0;
  }
}

static int category(int v) {
  int n = 0;
  for (unsigned u = (unsigned)abs(v); u; u >>= 1) n++;
  return n;
}

static void put_value(struct bits *bits, int v, int row) {
  put_bits(bits, (unsigned)row, CODE_BITS);
  put_bits(bits, (unsigned)(v < 0 ? v + (1 << category(v)) - 1 : v), category(v));
}

// The first `n` coefficients of a block in zigzag order, DC as a difference; none of the others 0.
static void put_block(struct bits *bits, const int *coefficient, int n) {
  put_value(bits, coefficient[0], category(coefficient[0]));
  for (int k = 1; k < n; k++) put_value(bits, coefficient[k], category(coefficient[k]));
  if (n < 64) put_bits(bits, 0, CODE_BITS);
}

static void put_table(struct bytes *file, int class, int n) {
  put(file, (const unsigned char[]){0xff, 0xc4, 0, (unsigned char)(19 + n), (unsigned char)class},
      5);
  for (int length = 1; length <= 16; length++) put_byte(file, length == CODE_BITS ? n : 0);
  for (int row = 0; row < n; row++) put_byte(file, row);
}

// sampling: of the first component, the others have 0x11.
static struct bytes header(int width, int height, int n_components, int sampling) {
  struct bytes file = {.n = 0};
  put(&file, (const unsigned char[]){0xff, 0xd8, 0xff, 0xdb, 0, 67, 0}, 7);
  for (int k = 0; k < 64; k++) put_byte(&file, QUANTUM);
  const unsigned char frame[] = {0xff,
                                 0xc0,
                                 0,
                                 (unsigned char)(8 + 3 * n_components),
                                 8,
                                 0,
                                 (unsigned char)height,
                                 0,
                                 (unsigned char)width,
                                 (unsigned char)n_components};
  put(&file, frame, sizeof frame);
  for (int c = 1; c <= n_components; c++)
    put(&file,
        (const unsigned char[]){(unsigned char)c, (unsigned char)(c == 1 ? sampling : 0x11), 0}, 3);
  put_table(&file, 0x00, N_DC);
  put_table(&file, 0x10, N_AC);
  put(&file,
      (const unsigned char[]){0xff, 0xda, 0, (unsigned char)(6 + 2 * n_components),
                              (unsigned char)n_components},
      5);
  for (int c = 1; c <= n_components; c++)
    put(&file, (const unsigned char[]){(unsigned char)c, 0}, 2);
  put(&file, (const unsigned char[]){0, 63, 0}, 3);
  return file;
}

static void finish(struct bits *bits) {
  put_bits(bits, 127, bits->count ? 8 - bits->count : 0);
  put(bits->file, "\xff\xd9", 2);
}

// A DC coefficient alone is a constant block of 128 + DC quantum / 8.
static void dc_coefficients_are_constant_blocks(void **state) {
  (void)state;
  struct bytes file = header(11, 8, 1, 0x11);
  struct bits bits = {&file, 0, 0};
  put_block(&bits, (const int[]){50}, 1);
  put_block(&bits, (const int[]){-73}, 1);
  finish(&bits);
  struct raster raster = decode_ok(&file, "a.jpg", as_linear);
  assert_shape(&raster, 11, 8, 1);
  for (int j = 0; j < 88; j++) assert_int_equal(raster.byte[j], j % 11 < 8 ? 178 : 105);
  assert_true(raster_value(&raster, 0, 0, 0) == encoding_decode(as_srgb, 178 / 255.0));
}

// f(x, y) = 1/4 sum C(u) C(v) F(u, v) cos((2x + 1) u pi / 16) cos((2y + 1) v pi / 16), C(0) =
// 1/sqrt 2 (ITU-T T.81, A.3.3) with F(0,0) = 240, F(1,0) = -160, F(0,1) = 320 before rounding.
static void other_coefficients_are_cosines(void **state) {
  (void)state;
  struct bytes file = header(8, 8, 1, 0x11);
  struct bits bits = {&file, 0, 0};
  put_block(&bits, (const int[]){30, -20, 40}, 3);
  finish(&bits);
  struct raster raster = decode_ok(&file, "a.jpeg", as_srgb);
  double pi = acos(-1);
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 8; x++) {
      double v =
          128 + 240 / 8.0 +
          sqrt(0.5) / 4 * (-160 * cos((2 * x + 1) * pi / 16) + 320 * cos((2 * y + 1) * pi / 16));
      v = v < 0 ? 0 : v > 255 ? 255 : v;
      // The transform's own rounding is below 0.07 here: only ties would differ.
      assert_true(fabs(raster.byte[8 * y + x] - v) <= 0.57);
    }
}

// JFIF: R = Y + 1.402 (Cr - 128), G = Y - 0.344136 (Cb - 128) - 0.714136 (Cr - 128),
// B = Y + 1.772 (Cb - 128). Chroma at half resolution is constant here.
static void colour_is_ycbcr_at_every_sampling(void **state) {
  (void)state;
  static const int sampling[] = {0x11, 0x21, 0x12, 0x22};
  for (int s = 0; s < 4; s++) {
    int h = sampling[s] >> 4, v = sampling[s] & 15;
    struct bytes file = header(8 * h, 8 * v, 3, sampling[s]);
    struct bits bits = {&file, 0, 0};
    for (int block = 0; block < h * v; block++) put_block(&bits, (const int[]){block ? 0 : -8}, 1);
    put_block(&bits, (const int[]){30}, 1);
    put_block(&bits, (const int[]){-41}, 1);
    finish(&bits);
    struct raster raster = decode_ok(&file, "a.JPG", as_srgb);
    assert_shape(&raster, 8 * h, 8 * v, 3);
    double expected[] = {120 - 1.402 * 41, 120 - 0.344136 * 30 + 0.714136 * 41, 120 + 1.772 * 30};
    for (int j = 0; j < 64 * h * v; j++)
      for (int c = 0; c < 3; c++)
        assert_int_equal(raster.byte[3 * j + c], (int)(expected[c] + 0.5));
  }
}

// ---- files of the library's own encoder ----

struct kind {
  int width, height, n_channels, h, v;
  bool progressive, arithmetic, cmyk;
  int restart;
  uint32_t noise;
};

static uint32_t random_word(uint32_t j) {
  uint32_t word[4];
  rng_philox(rng_key(rng_hash_name("image_jpg"), 1, RNG_TEST), (uint32_t[4]){j, 0, 0, 0}, word);
  return word[0];
}

// Waves with noise on them.
static struct bytes encode(struct kind kind) {
  struct bytes file = {.n = 0};
  struct jpeg_error_mgr errors;
  struct jpeg_compress_struct jpeg = {.err = jpeg_std_error(&errors)};
  unsigned char *memory = NULL, row[4 * 128];
  unsigned long length = 0;
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, &memory, &length);
  jpeg.image_width = (JDIMENSION)kind.width;
  jpeg.image_height = (JDIMENSION)kind.height;
  jpeg.input_components = kind.n_channels;
  jpeg.in_color_space = kind.cmyk ? JCS_CMYK : kind.n_channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 85, TRUE);
  if (kind.progressive) jpeg_simple_progression(&jpeg);
  jpeg.arith_code = kind.arithmetic;
  jpeg.restart_interval = (unsigned)kind.restart;
  jpeg.comp_info[0].h_samp_factor = kind.h;
  jpeg.comp_info[0].v_samp_factor = kind.v;
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < kind.height; y++) {
    for (int x = 0; x < kind.width * kind.n_channels; x++)
      row[x] = (unsigned char)(100 + 50 * sin(0.21 * x + 0.13 * y) +
                               random_word(kind.noise << 18 | (uint32_t)(y << 9 | x)) % 97);
    jpeg_write_scanlines(&jpeg, &(JSAMPROW){row}, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  put(&file, memory, (int)length);
  free(memory);
  return file;
}

static const struct kind kinds[] = {
    {61, 47, 1, 1, 1, false, false, false, 0, 0}, {61, 47, 3, 1, 1, false, false, false, 0, 0},
    {61, 47, 3, 2, 1, false, false, false, 3, 0}, {61, 47, 3, 2, 2, false, false, false, 0, 0},
    {61, 47, 3, 1, 2, false, false, false, 0, 0}, {61, 47, 3, 2, 2, true, false, false, 0, 0},
    {17, 9, 3, 4, 1, true, false, false, 0, 0},   {128, 3, 1, 1, 1, true, false, false, 0, 0},
};
enum { N_KINDS = sizeof kinds / sizeof *kinds };

static uint64_t add_hash(uint64_t hash, struct kind kind) {
  struct bytes file = encode(kind);
  struct raster raster = decode_ok(&file, "a.jpg", as_srgb);
  assert_shape(&raster, kind.width, kind.height, kind.n_channels);
  for (int j = 0; j < raster.width * raster.height * raster.n_channels; j++)
    hash = (hash ^ raster.byte[j]) * UINT64_C(1099511628211);
  return hash;
}

// A million samples: the transform of floats differs in 10 of them between C and SSE2.
static uint64_t hash_of_all(void) {
  uint64_t hash = UINT64_C(14695981039346656037);
  for (int k = 0; k < N_KINDS; k++) hash = add_hash(hash, kinds[k]);
  for (uint32_t noise = 1; noise <= 20; noise++)
    hash = add_hash(hash, (struct kind){128, 128, 3, 2, 2, .noise = noise});
  return hash;
}

// libjpeg-turbo chooses when it is first used, so each level has a process of its own. The files
// too are encoded there: encoder and decoder must agree.
static uint64_t hash_in_child(const char *variable) {
  int ends[2];
  assert_int_equal(pipe(ends), 0);
  pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    if (variable) setenv(variable, "1", 1);
    uint64_t hash = hash_of_all();
    _exit(write(ends[1], &hash, 8) != 8);
  }
  uint64_t hash = 0;
  int status;
  close(ends[1]);
  assert_int_equal(read(ends[0], &hash, 8), 8);
  close(ends[0]);
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_int_equal(status, 0);
  return hash;
}

static void every_instruction_set_gives_the_same_bits(void **state) {
  (void)state;
  uint64_t scalar = hash_in_child("JSIMD_FORCENONE");
  assert_true(scalar == hash_in_child("JSIMD_FORCESSE2"));
  assert_true(scalar == hash_in_child(NULL));
}

// Both hold the same quantised coefficients.
static void progressive_and_baseline_decode_to_the_same(void **state) {
  (void)state;
  struct kind kind = kinds[3];
  struct bytes file = encode(kind);
  struct raster baseline = decode_ok(&file, "a.jpg", as_srgb);
  kind.progressive = true;
  file = encode(kind);
  struct raster progressive = decode_ok(&file, "a.jpg", as_srgb);
  assert_bytes(&progressive, baseline.byte);
}

static void what_we_do_not_read_is_refused_with_its_reason(void **state) {
  (void)state;
  struct kind cmyk = {8, 8, 4, 1, 1, false, false, true, 0, 0};
  struct bytes file = encode(cmyk);
  assert_refused(&file, "a.jpg", "is a CMYK jpg");
  struct kind arithmetic = {8, 8, 1, 1, 1, false, true, false, 0, 0};
  file = encode(arithmetic);
  assert_refused(&file, "a.jpg", "is an arithmetic-coded jpg");
  file.n = 0;
  assert_refused(&file, "a.jpg", "not a jpg file we can read");
  put_text(&file, "GIF89a");
  assert_refused(&file, "a.jpg", "not a jpg file we can read");
  file = header(8, 8, 1, 0x11);
  static const unsigned char frame[] = {0xff, 0xc0, 0, 11, 8};
  for (int j = 0; j + 9 < file.n; j++)
    if (memcmp(file.data + j, frame, sizeof frame) == 0) memset(file.data + j + 5, 0xef, 4);
  assert_refused(&file, "a.jpg", "is too short for the size it claims");
}

static void damaged_files_never_crash(void **state) {
  (void)state;
  for (int k = 2; k <= 6; k += 4) {
    struct kind kind = kinds[k];
    kind.width = kind.height = 17;
    struct bytes file = encode(kind);
    assert_true(assert_survives(&file, "a.jpg", 1500) > 300);
  }
}

int main(void) {
  raster_arena = arena_reserve();
  raster_scratch = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_instruction_set_gives_the_same_bits), // before the library's first use
      cmocka_unit_test(dc_coefficients_are_constant_blocks),
      cmocka_unit_test(other_coefficients_are_cosines),
      cmocka_unit_test(colour_is_ycbcr_at_every_sampling),
      cmocka_unit_test(progressive_and_baseline_decode_to_the_same),
      cmocka_unit_test(what_we_do_not_read_is_refused_with_its_reason),
      cmocka_unit_test(damaged_files_never_crash),
  };
  return cmocka_run_group_tests_name("image_jpg", tests, NULL, NULL);
}
