// Float texture "windy": waves of 6 octaves, as strong as |3 octaves| ten times as wide.
#include "scene/texture/octaves.h"

struct windy {
  struct transform texture_from_world;
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct windy *windy = arena_new(builder->arena, struct windy, 1);
  texture->data = windy;
  return texture_kind(params, spectrum, false) &&
         mapping_read_space(builder, params, &windy->texture_from_world) && params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct windy *windy = texture->data;
  struct vec p = transform_point(&windy->texture_from_world, surface->p);
  double strength = noise_fbm(vec_scale(p, 0.1), 0.5, 3);
  value_of_float(fabs(strength) * noise_fbm(p, 0.5, 6), value);
}

const struct texture_type texture_windy = {
    .name = "windy",
    .about = "waves in gusts of wind (floats)",
    .read = read,
    .evaluate = evaluate,
    .is_gray = always_gray,
};
