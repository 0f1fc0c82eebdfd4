// Images as textures use them: pixel after pixel, rows from the top, 8-bit files kept as 8 bits.
#ifndef IMAGE_RASTER_H
#define IMAGE_RASTER_H

#include "base/file.h"

// The linear value an encoded one in [0, 1] stands for (pbrt's `string encoding`).
struct encoding {
  enum { ENCODING_SRGB, ENCODING_LINEAR, ENCODING_GAMMA } curve;
  double gamma; // ENCODING_GAMMA: linear = encoded^gamma
};

// "sRGB", "linear" or "gamma 2.2"; false for anything else.
bool encoding_parse(const char *text, struct encoding *);
double encoding_decode(struct encoding, double encoded);

struct raster {
  int width, height;
  int n_channels; // 1: gray; 3: R, G, B; 4: R, G, B and an alpha that is not 1 everywhere
  const unsigned char *byte; // of files with 8 bits a value, as encoded (alpha too); else NULL
  const float *value;        // of all others, linear and finite; else NULL
  double linear[256];        // of a byte
  struct encoding encoding;  // of bytes
};

static inline double raster_value(const struct raster *raster, int x, int y, int channel) {
  ptrdiff_t at = ((ptrdiff_t)y * raster->width + x) * raster->n_channels + channel;
  return raster->byte ? raster->linear[raster->byte[at]] : (double)raster->value[at];
}

// The bytes of a file whose extension (of path, in any case) says what they are: exr, pfm, hdr,
// png, jpg, jpeg or tga. As in pbrt only png looks at the encoding: jpg and tga are sRGB, the
// others linear.
bool raster_decode(struct text, const char *path, struct encoding, struct arena *,
                   struct arena scratch, struct raster *, struct problem *);

#endif
