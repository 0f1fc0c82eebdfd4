// The file formats behind image_write and image_read, one file each.
#ifndef IMAGE_FORMAT_H
#define IMAGE_FORMAT_H

#include "base/file.h"
#include "image/image.h"

#include <stdint.h>

// Writers get a stream that becomes the file only if they return true; readers get all its bytes.
bool exr_file_write(FILE *, const char *path, const struct image *, struct problem *);
bool exr_file_read(struct text, const char *path, struct arena *, struct image *, struct problem *);
bool pfm_file_write(FILE *, const char *path, const struct image *, struct problem *);
bool pfm_file_read(struct text, const char *path, struct arena *, struct image *, struct problem *);
bool png_file_write(FILE *, const char *path, const struct image *, struct problem *);

// The planes a format without channel names shows: R, G, B (returns 3), else Y (returns 1), else a
// problem (returns 0).
int image_colour(const struct image *, const char *path, const float *plane[3], struct problem *);

#endif
