// Medium "homogeneous": the same everywhere, without end.
//   `rgb sigma_a`, `rgb sigma_s`  default 1, times `float scale`; `float g`
#include "scene/read.h"

struct homogeneous {
  struct medium_point point;
  double majorant;
};

static bool read(struct scene_builder *builder, struct params *params, struct medium *medium) {
  (void)builder, (void)medium;
  return params_complain(params, "type", "participating media are not in this version");
}

static void at(const struct medium *medium, struct vec p, struct medium_point *point) {
  (void)p;
  *point = ((const struct homogeneous *)medium->data)->point;
}

static bool piece(const struct medium *medium, const struct ray *ray, double t, double *end,
                  double *majorant) {
  (void)ray, (void)t;
  *end = INFINITY;
  *majorant = ((const struct homogeneous *)medium->data)->majorant;
  return true;
}

static bool is_gray(const struct medium *medium) {
  const struct medium_point *point = &((const struct homogeneous *)medium->data)->point;
  const double *value[] = {point->sigma_a, point->sigma_s, point->emission};
  for (int k = 0; k < 3; k++)
    if (value[k][0] != value[k][1] || value[k][1] != value[k][2]) return false;
  return true;
}

const struct medium_type medium_homogeneous = {
    .name = "homogeneous",
    .about = "the same everywhere",
    .uniform = true,
    .read = read,
    .at = at,
    .piece = piece,
    .is_gray = is_gray,
};
