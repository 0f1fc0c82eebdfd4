// Texture "dots": in about half of the unit cells a disc of radius 0.35 in a random place, `inside`
// [1] it and `outside` [0]. Which and where is pbrt's noise of the cell.
#include "scene/mapping.h"
#include "scene/noise.h"
#include "scene/texture/inputs.h"

struct dots {
  struct mapping mapping;
  struct input inside, outside;
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct dots *dots = arena_new(builder->arena, struct dots, 1);
  dots->inside = texture_input(builder, params, spectrum, "inside", 1);
  dots->outside = texture_input(builder, params, spectrum, "outside", 0);
  texture->data = dots;
  return mapping_read(builder, params, &dots->mapping) && params_finish(params);
}

static bool is_inside(const double st[2]) {
  static const double radius = 0.35, max_shift = 0.5 - 0.35;
  double s = floor(st[0] + 0.5), t = floor(st[1] + 0.5);
  if (!(noise(s + 0.5, t + 0.5, 0.5) > 0)) return false;
  double ds = st[0] - (s + max_shift * noise(s + 1.5, t + 2.8, 0.5));
  double dt = st[1] - (t + max_shift * noise(s + 4.5, t + 9.8, 0.5));
  return ds * ds + dt * dt < radius * radius;
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct dots *dots = texture->data;
  double st[2];
  mapping_st(&dots->mapping, surface, st);
  input_rgb(is_inside(st) ? &dots->inside : &dots->outside, surface, value);
}

static bool is_gray(const struct texture *texture) {
  const struct dots *dots = texture->data;
  return input_is_gray(&dots->inside) && input_is_gray(&dots->outside);
}

const struct texture_type texture_dots = {
    .name = "dots",
    .about = "discs of one texture in random cells of another",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
