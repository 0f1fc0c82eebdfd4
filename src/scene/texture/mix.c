// Texture "mix": (1 - amount) tex1 + amount tex2; defaults 0, 1 and the float `amount` 0.5.
#include "scene/texture/inputs.h"

struct mix {
  struct input tex1, tex2, amount;
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct mix *mix = arena_new(builder->arena, struct mix, 1);
  mix->tex1 = texture_input(builder, params, spectrum, "tex1", 0);
  mix->tex2 = texture_input(builder, params, spectrum, "tex2", 1);
  mix->amount = input_read_float(builder, params, "amount", 0.5);
  texture->data = mix;
  return params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct mix *mix = texture->data;
  double amount = input_float(&mix->amount, surface), second[3];
  input_rgb(&mix->tex1, surface, value);
  input_rgb(&mix->tex2, surface, second);
  for (int c = 0; c < 3; c++) value[c] = (1 - amount) * value[c] + amount * second[c];
}

static bool is_gray(const struct texture *texture) {
  const struct mix *mix = texture->data;
  return input_is_gray(&mix->tex1) && input_is_gray(&mix->tex2);
}

const struct texture_type texture_mix = {
    .name = "mix",
    .about = "two textures by a float texture",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
