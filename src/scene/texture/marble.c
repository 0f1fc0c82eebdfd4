// Spectrum texture "marble": layers across y of the texture's space times `scale` [1], displaced by
// `variation` [0.2] octaves of noise, through pbrt's cubic Bezier spline of colours (9 control
// points, 6 overlapping segments).
#include "numeric/elementary.h"
#include "scene/texture/octaves.h"

struct marble {
  struct octaves octaves;
  double scale, variation;
};

static const double colours[][3] = {
    {.58, .58, .6}, {.58, .58, .6}, {.58, .58, .6}, {.5, .5, .5},   {.6, .59, .58},
    {.58, .58, .6}, {.58, .58, .6}, {.2, .2, .33},  {.58, .58, .6},
};
enum { N_SEGMENTS = sizeof colours / sizeof *colours - 3 };

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct marble *marble = arena_new(builder->arena, struct marble, 1);
  marble->scale = params_float(params, "scale", 1);
  marble->variation = params_float(params, "variation", 0.2);
  texture->data = marble;
  return texture_kind(params, spectrum, true) && octaves_read(builder, params, &marble->octaves) &&
         params_finish(params);
}

// Sine of any angle: whole turns are taken off first.
static double sine_of(double x) {
  double turns = x * 0x1.45f306dc9c883p-3, sine, cosine; // 1 / (2 pi)
  num_sincos_turns(turns - floor(turns), &sine, &cosine);
  return sine;
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct marble *marble = texture->data;
  struct vec p = vec_scale(octaves_point(&marble->octaves, surface), marble->scale);
  double layers = noise_fbm(p, marble->octaves.roughness, marble->octaves.count);
  double t = (0.5 + 0.5 * sine_of(p.y + marble->variation * layers)) * N_SEGMENTS;
  int first = t < N_SEGMENTS - 1 ? (int)t : N_SEGMENTS - 1;
  t -= first;
  double u = 1 - t;
  double weight[4] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
  for (int c = 0; c < 3; c++) {
    value[c] = 0;
    for (int k = 0; k < 4; k++) value[c] += 1.5 * weight[k] * colours[first + k][c];
  }
}

static bool is_gray(const struct texture *texture) {
  (void)texture;
  return false;
}

const struct texture_type texture_marble = {
    .name = "marble",
    .about = "coloured layers, displaced by noise (spectra)",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
