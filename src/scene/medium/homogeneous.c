// Medium "homogeneous": the same everywhere, without end.
//   `rgb sigma_a`, `rgb sigma_s`  default 1, times `float scale`; `float g`
//   `spectrum Le` times `float Lescale`  emitted radiance, default none
#include "scene/medium/coefficients.h"

struct homogeneous {
  struct medium_point point;
  double majorant;
};

static bool read(struct scene_builder *builder, struct params *params, struct medium *medium) {
  struct homogeneous *homogeneous = arena_new(builder->arena, struct homogeneous, 1);
  double emitted = params_float(params, "Lescale", 1);
  if (!(emitted >= 0)) params_complain(params, "Lescale", "\"Lescale\" must not be negative");
  if (!medium_read(builder, params, medium, &homogeneous->point)) return false;
  for (int c = 0; c < 3; c++) {
    double *emission = &homogeneous->point.emission[c];
    *emission *= emitted;
    if (!isfinite(*emission)) return params_complain(params, "Lescale", "it emits too much");
  }
  homogeneous->majorant = medium_largest(&homogeneous->point);
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
