// The file formats behind image_write, image_read and raster_decode, one file each.
#ifndef IMAGE_FORMAT_H
#define IMAGE_FORMAT_H

#include "base/file.h"
#include "image/image.h"
#include "image/raster.h"

#include <stdint.h>

// A format has what it can do, NULL else. Writers get a stream that becomes the file only if they
// return true; readers get all its bytes. `read` gives planes of floats; `texels` fills a raster
// (except `linear` and `encoding`, and alpha may be 1 everywhere) and is only there where `read` is
// not.
struct format {
  const char *extension;
  bool (*write)(FILE *, const char *path, const struct image *, struct problem *);
  bool (*read)(struct text, const char *path, struct arena *, struct image *, struct problem *);
  bool (*texels)(struct text, const char *path, struct encoding, struct arena *,
                 struct arena scratch, struct raster *, struct problem *);
};
const struct format *format_find(const char *path); // by extension, in any case; or NULL

bool exr_file_write(FILE *, const char *path, const struct image *, struct problem *);
bool exr_file_read(struct text, const char *path, struct arena *, struct image *, struct problem *);
bool pfm_file_write(FILE *, const char *path, const struct image *, struct problem *);
bool pfm_file_read(struct text, const char *path, struct arena *, struct image *, struct problem *);
bool hdr_file_read(struct text, const char *path, struct arena *, struct image *, struct problem *);
bool png_file_write(FILE *, const char *path, const struct image *, struct problem *);
bool png_file_texels(struct text, const char *path, struct encoding, struct arena *,
                     struct arena scratch, struct raster *, struct problem *);
bool jpg_file_texels(struct text, const char *path, struct encoding, struct arena *,
                     struct arena scratch, struct raster *, struct problem *);
bool tga_file_texels(struct text, const char *path, struct encoding, struct arena *,
                     struct arena scratch, struct raster *, struct problem *);

// The planes a format without channel names shows: R, G, B (returns 3), else Y (returns 1), else a
// problem (returns 0).
int image_colour(const struct image *, const char *path, const float *plane[3], struct problem *);

#endif
