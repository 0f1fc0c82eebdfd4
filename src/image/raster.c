#include "image/raster.h"

#include "image/format.h"
#include "numeric/elementary.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

bool encoding_parse(const char *text, struct encoding *encoding) {
  *encoding = (struct encoding){ENCODING_SRGB, 1};
  if (strcmp(text, "sRGB") == 0) return true;
  encoding->curve = ENCODING_LINEAR;
  if (strcmp(text, "linear") == 0) return true;
  encoding->curve = ENCODING_GAMMA;
  if (strncmp(text, "gamma ", 6) != 0) return false;
  char *rest;
  encoding->gamma = strtod(text + 6, &rest);
  return rest != text + 6 && *rest == 0 && encoding->gamma > 0 && encoding->gamma <= 1000;
}

double encoding_decode(struct encoding encoding, double v) {
  switch (encoding.curve) {
  case ENCODING_LINEAR:
    return v;
  case ENCODING_GAMMA:
    return num_pow(v, encoding.gamma);
  default: // IEC 61966-2-1
    return v <= 0.04045 ? v / 12.92 : num_pow((v + 0.055) / 1.055, 2.4);
  }
}

static bool find_plane(const struct image *image, const char *name, const float **plane) {
  for (int c = 0; c < image->n_channels; c++)
    if (strcmp(image->name[c], name) == 0) {
      *plane = image->plane[c];
      return true;
    }
  return false;
}

// A single channel is gray, whatever its name; of several R, G, B and an A are used.
static int choose_planes(const struct image *image, const float *plane[4]) {
  plane[0] = image->plane[0];
  if (image->n_channels == 1) return 1;
  if (!find_plane(image, "R", &plane[0]) || !find_plane(image, "G", &plane[1]) ||
      !find_plane(image, "B", &plane[2]))
    return 0;
  return find_plane(image, "A", &plane[3]) ? 4 : 3;
}

static bool read_planes(const struct format *format, struct text text, const char *path,
                        struct arena *arena, struct arena scratch, struct raster *raster,
                        struct problem *problem) {
  struct image image;
  if (!format->read(text, path, &scratch, &image, problem)) return false;
  const float *plane[4];
  int n = choose_planes(&image, plane);
  if (!n) return problem_set(problem, "%s: has several channels but not R, G and B", path);
  ptrdiff_t n_pixels = (ptrdiff_t)image.width * image.height;
  float *value = arena_new(arena, float, n_pixels *n);
  for (ptrdiff_t j = 0; j < n_pixels; j++)
    for (int c = 0; c < n; c++) {
      float v = value[j * n + c] = plane[c][j];
      if (v - v != 0)
        return problem_set(problem, "%s: pixel %d, %d is not a finite number", path,
                           (int)(j % image.width), (int)(j / image.width));
    }
  *raster = (struct raster){
      .width = image.width, .height = image.height, .n_channels = n, .value = value};
  return true;
}

static bool is_opaque(const struct raster *raster) {
  for (int y = 0; y < raster->height; y++)
    for (int x = 0; x < raster->width; x++)
      if (raster_value(raster, x, y, 3) != 1) return false;
  return true;
}

// Closes the gaps in place.
static void drop_alpha(struct raster *raster) {
  ptrdiff_t n_pixels = (ptrdiff_t)raster->width * raster->height;
  unsigned char *byte = (unsigned char *)raster->byte;
  float *value = (float *)raster->value;
  for (ptrdiff_t j = 0; j < n_pixels; j++)
    for (int c = 0; c < 3; c++)
      if (byte)
        byte[3 * j + c] = byte[4 * j + c];
      else
        value[3 * j + c] = value[4 * j + c];
  raster->n_channels = 3;
}

bool raster_decode(struct text text, const char *path, struct encoding encoding,
                   struct arena *arena, struct arena scratch, struct raster *raster,
                   struct problem *problem) {
  const struct format *format = format_find(path);
  if (!format)
    return problem_set(
        problem, "%s: unknown image format (known: .exr, .pfm, .hdr, .png, .jpg, .jpeg, .tga)",
        path);
  bool ok = format->read ? read_planes(format, text, path, arena, scratch, raster, problem)
                         : format->texels(text, path, encoding, arena, scratch, raster, problem);
  if (!ok) return false;
  if (format->texels != png_file_texels) encoding.curve = ENCODING_SRGB;
  raster->encoding = encoding;
  for (int b = 0; b < 256; b++) raster->linear[b] = encoding_decode(encoding, b / 255.0);
  if (raster->n_channels == 4 && is_opaque(raster)) drop_alpha(raster);
  return true;
}
