// Reflectance and transmittance of a material: as in pbrt-v4, what a texture (times a scale) gives
// is kept within [0, 1]. Constants are checked when they are read.
#ifndef SCENE_MATERIAL_ALBEDO_H
#define SCENE_MATERIAL_ALBEDO_H

#include "scene/texture.h"

static inline void albedo_at(const struct input *input, const struct surface *surface, double scale,
                             double rgb[3]) {
  input_rgb(input, surface, rgb);
  for (int c = 0; c < 3; c++) {
    double value = rgb[c] * scale;
    rgb[c] = value > 0 ? (value < 1 ? value : 1) : 0;
  }
}

#endif
