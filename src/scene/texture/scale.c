// Texture "scale": `tex` [1] times the float `scale` [1]. As in pbrt a constant factor of an image
// becomes part of the image's own `scale`, which comes before its `invert`.
#include "scene/texture/imagemap.h"
#include "scene/texture/inputs.h"

struct scale {
  struct input tex, scale;
};

static bool is_constant(const struct input *input) {
  return !input->texture || input->texture->type == &texture_constant;
}

static bool is_image(const struct input *input) {
  return input->texture && input->texture->type == &texture_imagemap;
}

static void fold(struct input *image, struct input *factor, struct arena *arena) {
  if (!is_image(image) || !is_constant(factor)) return;
  double value = input_float(factor, &(struct surface){.uv = {0, 0}});
  image->texture = imagemap_scaled(image->texture, value, arena);
  *factor = (struct input){.value = {1, 1, 1}};
}

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct scale *scale = arena_new(builder->arena, struct scale, 1);
  scale->tex = texture_input(builder, params, spectrum, "tex", 1);
  scale->scale = input_read_float(builder, params, "scale", 1);
  fold(&scale->tex, &scale->scale, builder->arena);
  if (!spectrum) fold(&scale->scale, &scale->tex, builder->arena);
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
