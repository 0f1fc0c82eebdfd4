// What texture slots share: inputs of either kind, and a complaint.
#ifndef SCENE_TEXTURE_INPUTS_H
#define SCENE_TEXTURE_INPUTS_H

#include "scene/read.h"

// A float or a spectrum as the texture is, constant or a texture of the same kind.
static inline struct input texture_input(struct scene_builder *builder, struct params *params,
                                         bool spectrum, const char *name, double fallback) {
  if (!spectrum) return input_read_float(builder, params, name, fallback);
  return input_read_spectrum(builder, params, name, SPECTRUM_UNBOUNDED,
                             (const double[3]){fallback, fallback, fallback});
}

// The same where a texture cannot be given.
static inline void texture_value(struct scene_builder *builder, struct params *params,
                                 bool spectrum, const char *name, double fallback,
                                 double value[3]) {
  value[0] = value[1] = value[2] = spectrum ? fallback : params_float(params, name, fallback);
  if (spectrum) spectrum_read(builder, params, name, SPECTRUM_UNBOUNDED, value);
}

static inline bool texture_kind(struct params *params, bool spectrum, bool wanted) {
  if (spectrum == wanted) return true;
  return params_complain(params, "", "there are only %s textures of this type",
                         wanted ? "spectrum" : "float");
}

static inline bool is_gray_rgb(const double rgb[3]) { return rgb[0] == rgb[1] && rgb[1] == rgb[2]; }

#endif
