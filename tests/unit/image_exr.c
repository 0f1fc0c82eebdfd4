// EXR files of other programs: what we read of them, and what we refuse in one line.
#define _GNU_SOURCE // mkdtemp
#include "image/image.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <OpenEXR/openexr.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = P_tmpdir "/photonlab-exr-XXXXXX";
static const char *path;

enum { WIDTH = 3, HEIGHT = 21, TILE_WIDTH = 2, TILE_HEIGHT = 8 };

struct kind {
  exr_storage_t storage;
  exr_pixel_type_t type;
  exr_compression_t compression;
  int parts, sampling;
  int top, bottom; // rows of the data window; the display window is 0 to HEIGHT - 1
  bool levels;     // tiles of all resolutions
  float red[2];    // primary; 0: not said
};
static const struct kind plain = {
    EXR_STORAGE_SCANLINE, EXR_PIXEL_FLOAT, EXR_COMPRESSION_ZIPS, 1, 1, 0, HEIGHT - 1, false, {0}};

#define OK(call) assert_int_equal(call, EXR_ERR_SUCCESS)

static void add_part(exr_context_t file, struct kind kind, const char *name) {
  int part;
  exr_attr_box2i_t data = {{.x = 0, .y = kind.top}, {.x = WIDTH - 1, .y = kind.bottom}};
  exr_attr_box2i_t display = {{.x = 0, .y = 0}, {.x = WIDTH - 1, .y = HEIGHT - 1}};
  exr_attr_v2f_t centre = {.x = 0, .y = 0};
  OK(exr_add_part(file, name, kind.storage, &part));
  OK(exr_initialize_required_attr(file, part, &display, &data, 1, &centre, 1,
                                  EXR_LINEORDER_INCREASING_Y, kind.compression));
  if (kind.storage == EXR_STORAGE_TILED)
    OK(exr_set_tile_descriptor(file, part, TILE_WIDTH, TILE_HEIGHT,
                               kind.levels ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL,
                               EXR_TILE_ROUND_DOWN));
  exr_attr_chromaticities_t primaries = {kind.red[0], kind.red[1], .3f, .6f, .15f, .06f, .3f, .3f};
  if (kind.red[0] > 0) OK(exr_attr_set_chromaticities(file, part, "chromaticities", &primaries));
  OK(exr_add_channel(file, part, "Y", kind.type, EXR_PERCEPTUALLY_LOGARITHMIC, kind.sampling,
                     kind.sampling));
}

// The pixels as they stand in the file (4 bytes each; halves: 2).
static void add_pixels(exr_context_t file, struct kind kind, const void *pixels) {
  int bytes = kind.type == EXR_PIXEL_HALF ? 2 : 4;
  int32_t lines;
  OK(exr_get_scanlines_per_chunk(file, 0, &lines));
  for (int y = 0; y < HEIGHT; y += lines) {
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t info;
    OK(exr_write_scanline_chunk_info(file, 0, y, &info));
    OK(exr_encoding_initialize(file, 0, &info, &pipe));
    pipe.channels[0].encode_from_ptr = (const uint8_t *)pixels + y * WIDTH * bytes;
    pipe.channels[0].user_pixel_stride = bytes;
    pipe.channels[0].user_line_stride = bytes * WIDTH;
    OK(exr_encoding_choose_default_routines(file, 0, &pipe));
    OK(exr_encoding_run(file, 0, &pipe));
    OK(exr_encoding_destroy(file, &pipe));
  }
}

static void add_tile(exr_context_t file, int x, int y, int level, const float *pixels) {
  exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
  exr_chunk_info_t info;
  OK(exr_write_tile_chunk_info(file, 0, x, y, level, level, &info));
  OK(exr_encoding_initialize(file, 0, &info, &pipe));
  pipe.channels[0].encode_from_ptr = (const uint8_t *)pixels;
  pipe.channels[0].user_pixel_stride = 4;
  pipe.channels[0].user_line_stride = 4 * WIDTH;
  OK(exr_encoding_choose_default_routines(file, 0, &pipe));
  OK(exr_encoding_run(file, 0, &pipe));
  OK(exr_encoding_destroy(file, &pipe));
}

// Coarser levels are black, so that reading one would show.
static void add_tiles(exr_context_t file, struct kind kind, const float *pixels) {
  static const float black[WIDTH * HEIGHT];
  int width = WIDTH, height = HEIGHT;
  for (int level = 0; level == 0 || (kind.levels && level < 5); level++) {
    for (int y = 0; y < height; y += TILE_HEIGHT)
      for (int x = 0; x < width; x += TILE_WIDTH)
        add_tile(file, x / TILE_WIDTH, y / TILE_HEIGHT, level,
                 level ? black : pixels + y * WIDTH + x);
    width = width > 1 ? width / 2 : 1;
    height = height > 1 ? height / 2 : 1;
  }
}

// On a stream of ours, which the library does not delete when pixels are missing.
static int64_t stream_write(exr_const_context_t file, void *stream, const void *bytes, uint64_t n,
                            uint64_t offset, exr_stream_error_func_ptr_t error) {
  (void)file, (void)error;
  fseek(stream, (long)offset, SEEK_SET);
  return (int64_t)fwrite(bytes, 1, n, stream);
}

// pixels == NULL: a header alone.
static void write_kind(struct kind kind, const void *pixels) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.write_fn = stream_write;
  setup.user_data = fopen(path, "wb");
  exr_context_t file;
  OK(exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, &setup));
  for (int p = 0; p < kind.parts; p++)
    add_part(file, kind, kind.parts == 1 ? NULL : arena_format(&arena, "part %d", p));
  OK(exr_write_header(file));
  if (pixels && kind.storage == EXR_STORAGE_TILED)
    add_tiles(file, kind, pixels);
  else if (pixels)
    add_pixels(file, kind, pixels);
  exr_finish(&file);
  fclose(setup.user_data);
}

static void assert_reads(struct kind kind, const void *pixels, const float *expected) {
  struct problem problem = {0};
  struct image image;
  write_kind(kind, pixels);
  if (!image_read(path, &arena, &image, &problem)) fail_msg("%s", problem.text);
  assert_int_equal(image.width, WIDTH);
  assert_int_equal(image.height, HEIGHT);
  assert_int_equal(image.n_channels, 1);
  assert_memory_equal(image.plane[0], expected, WIDTH * HEIGHT * sizeof *expected);
}

static float value[WIDTH * HEIGHT];

static void every_lossless_compression_is_read(void **state) {
  (void)state;
  static const exr_compression_t row[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                          EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                          EXR_COMPRESSION_PIZ};
  for (int c = 0; c < 5; c++) {
    struct kind kind = plain;
    kind.compression = row[c];
    assert_reads(kind, value, value);
  }
}

static void half_and_uint_channels_become_floats(void **state) {
  (void)state;
  static uint16_t half[WIDTH * HEIGHT];
  static uint32_t number[WIDTH * HEIGHT];
  float expected[WIDTH * HEIGHT] = {0};
  half[1] = 0x3c00, expected[1] = 1;
  half[4] = 0xc0c5, expected[4] = -2.384765625f;
  half[9] = 0x0001, expected[9] = 0x1p-24f;
  half[62] = 0x7bff, expected[62] = 65504;
  struct kind kind = plain;
  kind.type = EXR_PIXEL_HALF;
  assert_reads(kind, half, expected);
  for (int j = 0; j < WIDTH * HEIGHT; j++) expected[j] = (float)(number[j] = 2385u * (uint32_t)j);
  kind.type = EXR_PIXEL_UINT;
  assert_reads(kind, number, expected);
}

static void tiles_of_the_finest_level_are_read(void **state) {
  (void)state;
  struct kind kind = plain;
  kind.storage = EXR_STORAGE_TILED;
  for (int levels = 0; levels < 2; levels++) {
    kind.levels = levels;
    assert_reads(kind, value, value);
    kind.compression = EXR_COMPRESSION_NONE;
    assert_reads(kind, value, value);
  }
}

// PXR24 keeps 24 bits of a float and all of a half; B44 all of floats and of equal blocks of
// halves.
static void what_lossy_compressions_leave_is_read(void **state) {
  (void)state;
  static float coarse[WIDTH * HEIGHT], two_and_a_bit[WIDTH * HEIGHT];
  static uint16_t half[WIDTH * HEIGHT];
  for (int j = 0; j < WIDTH * HEIGHT; j++) {
    coarse[j] = 0.25f + (float)j;
    two_and_a_bit[j] = 2.384765625f;
    half[j] = 0x40c5;
  }
  struct kind kind = plain;
  kind.compression = EXR_COMPRESSION_PXR24;
  assert_reads(kind, coarse, coarse);
  kind.compression = EXR_COMPRESSION_B44;
  assert_reads(kind, value, value);
  kind.type = EXR_PIXEL_HALF;
  assert_reads(kind, half, two_and_a_bit);
  kind.compression = EXR_COMPRESSION_B44A;
  assert_reads(kind, half, two_and_a_bit);
}

static void unknown_primaries_are_taken_for_srgb(void **state) {
  (void)state;
  struct kind kind = plain;
  kind.red[0] = .64f, kind.red[1] = .33f;
  assert_reads(kind, value, value);
  kind.red[0] = .5f, kind.red[1] = .4f;
  assert_reads(kind, value, value);
}

static void what_we_do_not_read_is_refused_with_its_reason(void **state) {
  (void)state;
  struct kind deep = plain, parts = plain, cropped = plain, sampled = plain, lossy = plain,
              wide = plain;
  deep.storage = EXR_STORAGE_DEEP_SCANLINE;
  parts.parts = 2;
  cropped.top = 3;
  sampled.sampling = 3;
  sampled.bottom = 20;
  wide.red[0] = .708f, wide.red[1] = .292f;
  lossy.compression = EXR_COMPRESSION_DWAA;
  const struct {
    struct kind kind;
    const char *says;
  } row[] = {{deep, "is deep"},
             {parts, "has several parts"},
             {cropped, "is cropped"},
             {sampled, "has subsampled channels"},
             {lossy, "is compressed with DWA"},
             {wide, "has the primaries of Rec. 2020"},
             {plain, "damaged exr file"}}; // a header without pixels
  for (size_t j = 0; j < sizeof row / sizeof *row; j++) {
    struct problem problem = {0};
    struct image image;
    write_kind(row[j].kind, NULL);
    assert_false(image_read(path, &arena, &image, &problem));
    if (!strstr(problem.text, row[j].says))
      fail_msg("\nexpected %s\ngot      %s", row[j].says, problem.text);
    assert_null(strchr(problem.text, '\n'));
  }
}

// A header may claim anything; what it claims is compared with the file before it is allocated.
static void a_small_file_cannot_claim_a_large_image(void **state) {
  (void)state;
  struct kind kind = plain;
  struct problem problem = {0};
  struct image image;
  write_kind(kind, value);
  FILE *stream = fopen(path, "r+b");
  char bytes[1024];
  size_t n = fread(bytes, 1, sizeof bytes, stream);
  for (size_t at = 0; at + 30 < n; at++)
    if (memcmp(bytes + at, "dataWindow", 11) == 0 || memcmp(bytes + at, "displayWindow", 14) == 0) {
      // name, type "box2i", size, then x_min, y_min, x_max, y_max.
      long x_max = (long)(at + strlen(bytes + at) + 1 + 6 + 4 + 8);
      fseek(stream, x_max, SEEK_SET);
      fwrite((const unsigned char[]){0xff, 0xff, 0xff, 0x0f}, 1, 4, stream);
    }
  fclose(stream);
  struct arena scratch = arena;
  assert_false(image_read(path, &scratch, &image, &problem));
  assert_non_null(strstr(problem.text, "is too short for its 268435456 x 21 pixels"));
}

int main(void) {
  arena = arena_reserve();
  if (!mkdtemp(folder)) die("cannot make %s", folder);
  path = arena_format(&arena, "%s/a.exr", folder);
  for (int j = 0; j < WIDTH * HEIGHT; j++) value[j] = 0.2385f * (float)(j / 20);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_lossless_compression_is_read),
      cmocka_unit_test(half_and_uint_channels_become_floats),
      cmocka_unit_test(tiles_of_the_finest_level_are_read),
      cmocka_unit_test(what_lossy_compressions_leave_is_read),
      cmocka_unit_test(unknown_primaries_are_taken_for_srgb),
      cmocka_unit_test(what_we_do_not_read_is_refused_with_its_reason),
      cmocka_unit_test(a_small_file_cannot_claim_a_large_image),
  };
  int failed = cmocka_run_group_tests_name("image_exr", tests, NULL, NULL);
  unlink(path);
  rmdir(folder);
  return failed;
}
