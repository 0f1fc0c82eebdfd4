// PNG for the screen only: 8 bits through the sRGB curve (IEC 61966-2-1), values clipped to [0, 1],
// NaN black. Nothing is ever measured from it.
#include "image/format.h"
#include "numeric/elementary.h"

#include <png.h>
#include <setjmp.h>

static unsigned char srgb_byte(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * num_pow(linear, 1 / 2.4) - 0.055;
  return (unsigned char)(255 * v + 0.5);
}

struct png_job {
  const char *path;
  struct problem *problem;
  png_bytep row; // here, so that it is freed after an error too
};

static void on_error(png_structp png, png_const_charp message) {
  const struct png_job *job = png_get_error_ptr(png);
  problem_set(job->problem, "%s: cannot write it: %s", job->path, message);
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
  struct png_job job = {path, problem, NULL};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : NULL;
  if (!info) die("out of memory: libpng cannot start writing %s", path);
  bool ok = write_all(png, info, &job, stream, image, plane);
  png_free(png, job.row);
  png_destroy_write_struct(&png, &info);
  return ok;
}
