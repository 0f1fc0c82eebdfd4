// What the noise textures share: `octaves` [8], `roughness` [0.5], and the texture's space. pbrt
// drops octaves finer than a pixel's footprint; here all are taken.
#ifndef SCENE_TEXTURE_OCTAVES_H
#define SCENE_TEXTURE_OCTAVES_H

#include "scene/mapping.h"
#include "scene/noise.h"
#include "scene/texture/inputs.h"

struct octaves {
  int count;
  double roughness;
  struct transform texture_from_world;
};

static inline bool octaves_read(struct scene_builder *builder, struct params *params,
                                struct octaves *octaves) {
  int64_t count = params_integer(params, "octaves", 8);
  octaves->roughness = params_float(params, "roughness", 0.5);
  if (count < 0 || count > 64)
    return params_complain(params, "octaves", "\"octaves\" is from 0 to 64");
  octaves->count = (int)count;
  return mapping_read_space(builder, params, &octaves->texture_from_world);
}

static inline struct vec octaves_point(const struct octaves *octaves,
                                       const struct surface *surface) {
  return transform_point(&octaves->texture_from_world, surface->p);
}

static inline void value_of_float(double v, double value[3]) { value[0] = value[1] = value[2] = v; }

static inline bool always_gray(const struct texture *texture) {
  (void)texture;
  return true;
}

#endif
