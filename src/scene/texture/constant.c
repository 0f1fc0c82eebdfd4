// Texture "constant": `value` [1].
#include "scene/texture/inputs.h"

struct constant {
  double value[3];
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct constant *constant = arena_new(builder->arena, struct constant, 1);
  texture_value(builder, params, spectrum, "value", 1, constant->value);
  texture->data = constant;
  return params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  (void)surface;
  const struct constant *constant = texture->data;
  for (int c = 0; c < 3; c++) value[c] = constant->value[c];
}

static bool is_gray(const struct texture *texture) {
  const struct constant *constant = texture->data;
  return is_gray_rgb(constant->value);
}

const struct texture_type texture_constant = {
    .name = "constant",
    .about = "one value everywhere",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
