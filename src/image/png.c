// Written for the screen only: 8 bits through the sRGB curve (IEC 61966-2-1), values clipped to [0,
// 1], NaN black; nothing is ever measured from it. Read as textures, as pbrt does: gAMA and the
// like are not looked at, transparency counts only in files of type RGBA.
#include "image/format.h"
#include "numeric/elementary.h"

#include <png.h>
#include <setjmp.h>
#include <string.h>

static unsigned char srgb_byte(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * num_pow(linear, 1 / 2.4) - 0.055;
  return (unsigned char)(255 * v + 0.5);
}

struct png_job {
  const char *path, *failed;
  struct problem *problem;
  png_bytep row;    // written: here, so that it is freed after an error too
  struct text left; // read: what of the file is still to come
};

static void on_error(png_structp png, png_const_charp message) {
  const struct png_job *job = png_get_error_ptr(png);
  problem_set(job->problem, "%s: %s: %s", job->path, job->failed, message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static void write_rows(png_structp png, png_bytep row, const struct image *image,
                       const float *const plane[3]) {
  for (int y = 0; y < image->height; y++) {
    for (int x = 0; x < image->width; x++)
      for (int c = 0; c < 3; c++)
        row[3 * x + c] = srgb_byte(plane[c][(ptrdiff_t)y * image->width + x]);
    png_write_row(png, row);
  }
}

// Everything that may jump out, away from the caller's variables.
static bool write_all(png_structp png, png_infop info, struct png_job *job, FILE *stream,
                      const struct image *image, const float *const plane[3]) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_init_io(png, stream);
  png_set_compression_level(png, 6);
  png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  job->row = png_malloc(png, (png_alloc_size_t)image->width * 3);
  write_rows(png, job->row, image, plane);
  png_write_end(png, NULL);
  return true;
}

bool png_file_write(FILE *stream, const char *path, const struct image *image,
                    struct problem *problem) {
  const float *plane[3];
  if (!image_colour(image, path, plane, problem)) return false;
  struct png_job job = {.path = path, .failed = "cannot write it", .problem = problem};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info) die("out of memory: libpng cannot start writing %s", path);
  bool ok = write_all(png, info, &job, stream, image, plane);
  png_free(png, job.row);
  png_destroy_write_struct(&png, &info);
  return ok;
}

// ---- reading ----

static void read_bytes(png_structp png, png_bytep to, size_t n) {
  struct png_job *job = png_get_io_ptr(png);
  if ((size_t)job->left.length < n) png_error(png, "ends before its last pixel");
  memcpy(to, job->left.data, n);
  job->left.data += n;
  job->left.length -= (ptrdiff_t)n;
}

// Deflate gives at most 1032 bytes for one.
static void check_length(png_structp png, png_infop info, ptrdiff_t length) {
  double height = png_get_image_height(png, info);
  if ((double)png_get_rowbytes(png, info) * height > 1032.0 * (double)length)
    png_error(png, "is too short for the size it claims");
}

// Gray or RGB or RGBA of 8 or 16 bits.
static void choose_transforms(png_structp png, png_infop info) {
  int type = png_get_color_type(png, info);
  if (type == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  if (png_get_bit_depth(png, info) < 8 && type == PNG_COLOR_TYPE_GRAY)
    png_set_expand_gray_1_2_4_to_8(png);
  if (type != PNG_COLOR_TYPE_RGB_ALPHA) png_set_strip_alpha(png);
}

static bool read_header(png_structp png, png_infop info, ptrdiff_t length, struct raster *raster,
                        int *passes) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_read_info(png, info);
  check_length(png, info, length);
  choose_transforms(png, info);
  *passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  raster->width = (int)png_get_image_width(png, info);
  raster->height = (int)png_get_image_height(png, info);
  raster->n_channels = png_get_channels(png, info);
  return true;
}

static bool read_rows(png_structp png, png_bytep byte, ptrdiff_t row_bytes, int height,
                      int passes) {
  if (setjmp(png_jmpbuf(png))) return false;
  for (int pass = 0; pass < passes; pass++)
    for (int y = 0; y < height; y++) png_read_row(png, byte + y * row_bytes, NULL);
  png_read_end(png, NULL);
  return true;
}

static void decode_words(const unsigned char *word, struct encoding encoding, float *value,
                         ptrdiff_t n, struct arena scratch) {
  float *linear = arena_new(&scratch, float, 65536);
  for (int w = 0; w < 65536; w++) linear[w] = (float)encoding_decode(encoding, w / 65535.0);
  for (ptrdiff_t j = 0; j < n; j++) value[j] = linear[word[2 * j] << 8 | word[2 * j + 1]];
}

static bool read_all(png_structp png, png_infop info, ptrdiff_t length, struct encoding encoding,
                     struct arena *arena, struct arena scratch, struct raster *raster) {
  int passes;
  *raster = (struct raster){0};
  if (!read_header(png, info, length, raster, &passes)) return false;
  ptrdiff_t row = (ptrdiff_t)png_get_rowbytes(png, info);
  bool words = png_get_bit_depth(png, info) == 16;
  unsigned char *byte = arena_new(words ? &scratch : arena, unsigned char, row * raster->height);
  if (!read_rows(png, byte, row, raster->height, passes)) return false;
  if (!words) {
    raster->byte = byte;
    return true;
  }
  float *value = arena_new(arena, float, row / 2 * raster->height);
  decode_words(byte, encoding, value, row / 2 * raster->height, scratch);
  raster->value = value;
  return true;
}

bool png_file_texels(struct text text, const char *path, struct encoding encoding,
                     struct arena *arena, struct arena scratch, struct raster *raster,
                     struct problem *problem) {
  struct png_job job = {
      .path = path, .failed = "not a png file we can read", .problem = problem, .left = text};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info) die("out of memory: libpng cannot start reading %s", path);
  png_set_read_fn(png, &job, read_bytes);
  bool ok = read_all(png, info, text.length, encoding, arena, scratch, raster);
  png_destroy_read_struct(&png, &info, NULL);
  return ok;
}
