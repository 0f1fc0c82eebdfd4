// Texture "directionmix": a tex1 + (1 - a) tex2 with a = |cos| of the angle between the geometric
// normal and `dir` [0 1 0] of the texture's space; defaults 0 and 1.
#include "scene/texture/inputs.h"

struct directionmix {
  struct input tex1, tex2;
  struct vec dir; // world space, unit length
};

static bool read_direction(struct scene_builder *builder, struct params *params, struct vec *dir) {
  ptrdiff_t n;
  const double *xyz = params_array(params, "vector3", "dir", &n);
  if (xyz && n != 3) return params_complain(params, "dir", "\"dir\" is one vector of 3 numbers");
  struct vec local = xyz ? vec(xyz[0], xyz[1], xyz[2]) : vec(0, 1, 0);
  struct vec world = transform_direction(&builder->world_from_object, local);
  double length = vec_length(world);
  if (!(length > 0) || length - length != 0)
    return params_complain(params, "dir", "\"dir\" has no direction in world space");
  *dir = vec_scale(world, 1 / length);
  return true;
}

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct directionmix *mix = arena_new(builder->arena, struct directionmix, 1);
  mix->tex1 = texture_input(builder, params, spectrum, "tex1", 0);
  mix->tex2 = texture_input(builder, params, spectrum, "tex2", 1);
  texture->data = mix;
  return read_direction(builder, params, &mix->dir) && params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct directionmix *mix = texture->data;
  double amount = fabs(vec_dot(surface->ng, mix->dir)), second[3];
  input_rgb(&mix->tex1, surface, value);
  input_rgb(&mix->tex2, surface, second);
  for (int c = 0; c < 3; c++) value[c] = amount * value[c] + (1 - amount) * second[c];
}

static bool is_gray(const struct texture *texture) {
  const struct directionmix *mix = texture->data;
  return input_is_gray(&mix->tex1) && input_is_gray(&mix->tex2);
}

const struct texture_type texture_directionmix = {
    .name = "directionmix",
    .about = "two textures by the direction of the normal",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
