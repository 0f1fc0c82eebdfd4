// Float texture "wrinkled": the sum of octaves of the absolute value of noise at a point of the
// texture's space.
#include "scene/texture/octaves.h"

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct octaves *octaves = arena_new(builder->arena, struct octaves, 1);
  texture->data = octaves;
  return texture_kind(params, spectrum, false) && octaves_read(builder, params, octaves) &&
         params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct octaves *octaves = texture->data;
  struct vec p = octaves_point(octaves, surface);
  value_of_float(noise_turbulence(p, octaves->roughness, octaves->count), value);
}

const struct texture_type texture_wrinkled = {
    .name = "wrinkled",
    .about = "sum of octaves of the absolute value of noise (floats)",
    .read = read,
    .evaluate = evaluate,
    .is_gray = always_gray,
};
