// Medium "homogeneous": the same everywhere, without end.
//   `rgb sigma_a`, `rgb sigma_s`  default 1, times `float scale`; `float g`
//   `string preset`               instead of them, times `scale` too: per mm
//   `spectrum Le` times `float Lescale`  emitted radiance, default none
#include "pbrt/suggest.h"
#include "scene/medium/coefficients.h"

#include <string.h>

struct homogeneous {
  struct medium_point point;
  double majorant;
};

static bool read_preset(struct params *params, const char *name, struct medium_point *point) {
  enum { MAX_NAMES = 128 };
  const char *names[MAX_NAMES];
  int n = n_medium_presets < MAX_NAMES ? n_medium_presets : MAX_NAMES;
  for (int k = 0; k < n; k++) {
    names[k] = medium_presets[k].name;
    if (strcmp(names[k], name) != 0) continue;
    memcpy(point->sigma_a, medium_presets[k].sigma_a, sizeof point->sigma_a);
    memcpy(point->sigma_s, medium_presets[k].sigma_s, sizeof point->sigma_s);
    return true;
  }
  const char *nearest = suggest_name(name, names, n);
  return params_complain(params, "preset", "there is no preset \"%s\"%s%s%s", name,
                         nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                         nearest ? "\"?" : " (photonlab list presets)");
}

static bool read(struct scene_builder *builder, struct params *params, struct medium *medium) {
  struct homogeneous *homogeneous = arena_new(builder->arena, struct homogeneous, 1);
  double emitted = params_float(params, "Lescale", 1);
  if (!(emitted >= 0)) params_complain(params, "Lescale", "\"Lescale\" must not be negative");
  const char *preset = params_string(params, "preset", NULL);
  if (!(preset ? read_preset(params, preset, &homogeneous->point)
               : medium_coefficients(builder, params, &homogeneous->point)))
    return false;
  if (!medium_read(builder, params, medium, &homogeneous->point)) return false;
  for (int c = 0; c < 3; c++) {
    double *emission = &homogeneous->point.emission[c];
    *emission *= emitted;
    if (!isfinite(*emission)) return params_complain(params, "Lescale", "it emits too much");
  }
  homogeneous->majorant = medium_largest(&homogeneous->point);
  // The farthest a path flies is -ln 2^-53 < 37 of its mean: a number, or it would never end.
  if (homogeneous->majorant > 0 && !isfinite(37 / homogeneous->majorant))
    return params_complain(params, "scale", "the medium's coefficients are too small, but not 0");
  medium->data = homogeneous;
  return true;
}

static void at(const struct medium *medium, struct vec p, struct medium_point *point) {
  (void)p;
  *point = ((const struct homogeneous *)medium->data)->point;
}

static void peak(const struct medium *medium, struct medium_point *point) {
  at(medium, (struct vec){0}, point);
}

static bool piece(const struct medium *medium, const struct ray *ray, double t, double *end,
                  double *majorant) {
  (void)ray, (void)t;
  *end = INFINITY;
  *majorant = ((const struct homogeneous *)medium->data)->majorant;
  return true;
}

static bool is_gray(const struct medium *medium) {
  return medium_point_is_gray(&((const struct homogeneous *)medium->data)->point);
}

const struct medium_type medium_homogeneous = {
    .name = "homogeneous",
    .about = "the same everywhere",
    .uniform = true,
    .read = read,
    .at = at,
    .piece = piece,
    .is_gray = is_gray,
    .peak = peak,
};
