// Texture "scale": `tex` [1] times the float `scale` [1].
#include "scene/texture/inputs.h"

struct scale {
  struct input tex, scale;
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct scale *scale = arena_new(builder->arena, struct scale, 1);
  scale->tex = texture_input(builder, params, spectrum, "tex", 1);
  scale->scale = input_read_float(builder, params, "scale", 1);
  texture->data = scale;
  return params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct scale *scale = texture->data;
  double factor = input_float(&scale->scale, surface);
  input_rgb(&scale->tex, surface, value);
  for (int c = 0; c < 3; c++) value[c] *= factor;
}

static bool is_gray(const struct texture *texture) {
  const struct scale *scale = texture->data;
  return input_is_gray(&scale->tex);
}

const struct texture_type texture_scale = {
    .name = "scale",
    .about = "a texture times a float texture",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
