#define _GNU_SOURCE // strcasecmp
#include "image/format.h"

#include <string.h>
#include <strings.h>

static const struct format formats[] = {
    {"exr", exr_file_write, exr_file_read, NULL}, {"pfm", pfm_file_write, pfm_file_read, NULL},
    {"hdr", NULL, hdr_file_read, NULL},           {"png", png_file_write, NULL, png_file_texels},
    {"jpg", NULL, NULL, jpg_file_texels},         {"jpeg", NULL, NULL, jpg_file_texels},
    {"tga", NULL, NULL, tga_file_texels},
};
enum { N_FORMATS = sizeof formats / sizeof *formats };

const struct format *format_find(const char *path) {
  const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
  for (int f = 0; dot && f < N_FORMATS; f++)
    if (strcasecmp(dot + 1, formats[f].extension) == 0) return &formats[f];
  return NULL;
}

struct image image_new(int width, int height, int n_channels, const char *const *names,
                       struct arena *arena) {
  struct image image = {.width = width, .height = height, .n_channels = n_channels};
  for (int c = 0; c < n_channels; c++) {
    image.name[c] = arena_string(arena, names[c], (ptrdiff_t)strlen(names[c]));
    image.plane[c] = arena_new(arena, float, (ptrdiff_t)width *height);
  }
  return image;
}

int image_colour(const struct image *image, const char *path, const float *plane[3],
                 struct problem *problem) {
  static const char *const name[] = {"R", "G", "B"};
  const float *gray = NULL;
  plane[0] = plane[1] = plane[2] = NULL;
  for (int c = 0; c < image->n_channels; c++) {
    for (int k = 0; k < 3; k++)
      if (strcmp(image->name[c], name[k]) == 0) plane[k] = image->plane[c];
    if (strcmp(image->name[c], "Y") == 0) gray = image->plane[c];
  }
  if (plane[0] && plane[1] && plane[2]) return 3;
  if (gray) {
    plane[0] = plane[1] = plane[2] = gray;
    return 1;
  }
  problem_set(problem, "%s: this format holds channels R, G, B or Y, the image has neither", path);
  return 0;
}

bool image_can_write(const char *path, struct problem *problem) {
  const struct format *format = format_find(path);
  if (format && format->write) return true;
  return problem_set(problem, "%s: unknown image format (known: .exr, .pfm, .png)", path);
}

bool image_write(const char *path, const struct image *image, struct problem *problem) {
  if (!image_can_write(path, problem)) return false;
  struct file_out out;
  if (!file_begin(&out, path, problem)) return false;
  if (format_find(path)->write(out.stream, path, image, problem)) return file_commit(&out, problem);
  file_abandon(&out);
  return false;
}

bool image_read(const char *path, struct arena *arena, struct image *image,
                struct problem *problem) {
  const struct format *format = format_find(path);
  if (!format || !format->read)
    return problem_set(problem, "%s: cannot read this image format (known: .exr, .pfm, .hdr)",
                       path);
  struct text text;
  return file_read(path, arena, &text, problem) && format->read(text, path, arena, image, problem);
}
