// What all media read: coefficients, phase function and emission.
#ifndef SCENE_MEDIUM_COEFFICIENTS_H
#define SCENE_MEDIUM_COEFFICIENTS_H

#include "scene/read.h"

// `rgb sigma_a`, `rgb sigma_s`, default 1 1 1. False, here and below: problem set.
static inline bool medium_coefficients(struct scene_builder *builder, struct params *params,
                                       struct medium_point *point) {
  for (int c = 0; c < 3; c++) point->sigma_a[c] = point->sigma_s[c] = 1;
  spectrum_read(builder, params, "sigma_a", SPECTRUM_UNBOUNDED, point->sigma_a);
  spectrum_read(builder, params, "sigma_s", SPECTRUM_UNBOUNDED, point->sigma_s);
  return !params->problem->text[0];
}

// The rest: times `float scale`; `float g` (default 0); `spectrum Le` (default 0), the emitted
// radiance. Every product is finite.
static inline bool medium_read(struct scene_builder *builder, struct params *params,
                               struct medium *medium, struct medium_point *point) {
  double Le[3] = {0};
  spectrum_read(builder, params, "Le", SPECTRUM_ILLUMINANT, Le);
  double scale = params_float(params, "scale", 1);
  if (!(scale >= 0)) params_complain(params, "scale", "\"scale\" must not be negative");
  medium->g = params_float(params, "g", 0);
  if (!(medium->g > -1 && medium->g < 1))
    params_complain(params, "g", "\"g\" must be between -1 and 1");
  for (int c = 0; c < 3; c++) {
    point->sigma_a[c] *= scale;
    point->sigma_s[c] *= scale;
    point->emission[c] = point->sigma_a[c] * Le[c];
    if (!isfinite(point->sigma_a[c] + point->sigma_s[c]) || !isfinite(point->emission[c]))
      params_complain(params, "scale", "the medium's coefficients are too large");
  }
  return !params->problem->text[0];
}

static inline double medium_largest(const struct medium_point *point) {
  double most = 0;
  for (int c = 0; c < 3; c++) {
    double sigma_t = point->sigma_a[c] + point->sigma_s[c];
    most = most < sigma_t ? sigma_t : most;
  }
  return most;
}

static inline bool medium_point_is_gray(const struct medium_point *point) {
  const double *value[] = {point->sigma_a, point->sigma_s, point->emission};
  for (int k = 0; k < 3; k++)
    if (value[k][0] != value[k][1] || value[k][1] != value[k][2]) return false;
  return true;
}

#endif
