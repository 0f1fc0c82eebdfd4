#include "tests/conformance/parts.h"

#include <math.h>
#include <stdio.h>

enum { ZOOM = 4 };

// Ours and the reference with the reference's mean at a quarter; z from blue (we are darker) over
// white to red, full at 6.
static double panel_value(const struct image *ours, const struct image *reference, const double *z,
                          int side, double exposure, int x, int y, int c) {
  int width = reference->width, panel = x / width, at = y * width + x % width;
  if (panel < 2) return exposure * (double)(panel ? reference : ours)->plane[c][at];
  double deviate = 0;
  if (z) deviate = z[y / side * ((width + side - 1) / side) + x % width / side] / 6;
  if (deviate > 1) deviate = 1;
  if (deviate < -1) deviate = -1;
  double fade = 1 - fabs(deviate);
  return (deviate > 0 && c == 0) || (deviate < 0 && c == 2) ? 1 : fade;
}

static struct image panels(const struct image *ours, const struct image *reference, const double *z,
                           int side, struct arena *arena) {
  static const char *const names[] = {"R", "G", "B"};
  struct region all = {0, 0, reference->width, reference->height};
  double exposure = 0.25 / region_mean(reference, all);
  struct image out = image_new(3 * ZOOM * all.width, ZOOM * all.height, 3, names, arena);
  for (int c = 0; c < 3; c++)
    for (int y = 0; y < out.height; y++)
      for (int x = 0; x < out.width; x++)
        out.plane[c][y * out.width + x] =
            (float)panel_value(ours, reference, z, side, exposure, x / ZOOM, y / ZOOM, c);
  return out;
}

void picture_write(const struct options *options, const char *name, const struct image *ours,
                   const struct image *reference, const double *z, int side, struct arena scratch) {
  static const char *const names[] = {"R",           "G",           "B", "reference.R",
                                      "reference.G", "reference.B", "z"};
  struct problem problem = {0};
  struct image both = image_new(ours->width, ours->height, z ? 7 : 6, names, &scratch);
  int pixels = ours->width * ours->height, columns = (ours->width + side - 1) / side;
  for (int c = 0; c < 3; c++)
    for (int j = 0; j < pixels; j++) {
      both.plane[c][j] = ours->plane[c][j];
      both.plane[3 + c][j] = reference->plane[c][j];
    }
  for (int j = 0; z && j < pixels; j++)
    both.plane[6][j] = (float)z[j / ours->width / side * columns + j % ours->width / side];
  struct image shown = panels(ours, reference, z, side, &scratch);
  const char *stem = arena_format(&scratch, "%s/%s", options->output, name);
  if (!image_write(arena_format(&scratch, "%s.exr", stem), &both, &problem) ||
      !image_write(arena_format(&scratch, "%s.png", stem), &shown, &problem))
    fprintf(stderr, "%s\n", problem.text);
}
