// What an image is outside itself ("string wrap").
#ifndef SCENE_WRAP_H
#define SCENE_WRAP_H

#include "image/raster.h"

struct wrap {
  const char *name;
  // A whole number at[k] outside [0, size[k]) is moved inside; false: the texel is black.
  bool (*move)(double at[2], const int size[2]);
};

const struct wrap *wrap_find(const char *name); // or NULL

// Channels `first` to first + n - 1 of the texel in column x and row y, whole numbers of any size.
void wrap_texel(const struct wrap *, const struct raster *, double x, double y, int first, int n,
                double *texel);

#endif
