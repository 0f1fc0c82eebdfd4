// Images in memory and on disk. Rows run from the top, pixels are 32-bit floats, channels are
// planes.
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include "base/arena.h"
#include "base/problem.h"

#include <stdbool.h>

enum { IMAGE_MAX_CHANNELS = 64 };

struct image {
  int width, height, n_channels;
  const char *name[IMAGE_MAX_CHANNELS]; // "R", "G", "B", "variance.R", ...
  float *plane[IMAGE_MAX_CHANNELS];     // width * height each
  const char *manifest;                 // EXR attribute photonlab/manifest (JSON), or NULL
};

// Zeroed planes.
struct image image_new(int width, int height, int n_channels, const char *const *names,
                       struct arena *);

// The format is the extension: exr (all channels, ZIP, no time or host in it), pfm (R, G, B),
// png (R, G, B through the sRGB curve, 8 bits). Appears complete or not at all.
bool image_write(const char *path, const struct image *, struct problem *);

// exr, pfm and hdr. Grayscale pfm ("Pf") gives one channel "Y". (Other formats: image/raster.h.)
bool image_read(const char *path, struct arena *, struct image *, struct problem *);

// Whether image_write knows the extension; the problem lists those it knows.
bool image_can_write(const char *path, struct problem *);

#endif
