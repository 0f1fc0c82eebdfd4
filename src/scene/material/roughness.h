// Roughness as pbrt-v4's materials give it: `float roughness` [0], or `uroughness` along dpdu and
// `vroughness` across; alpha = sqrt(roughness) unless `bool remaproughness` is false.
#ifndef SCENE_MATERIAL_ROUGHNESS_H
#define SCENE_MATERIAL_ROUGHNESS_H

#include "scene/material/microfacet.h"
#include "scene/read.h"

struct roughness {
  struct input u, v;
  bool remap;
};

static inline struct input roughness_read_one(struct scene_builder *builder, struct params *params,
                                              const char *name) {
  struct input input = input_read_float(builder, params, name, 0);
  if (!(input.value[0] >= 0 && input.value[0] <= 1e6)) // squares must be finite
    params_complain(params, name, "\"%s\" must be in [0, 1e6], and is %g", name, input.value[0]);
  return input;
}

// The names differ between materials ("interface.roughness"); `remap` is of one name.
static inline struct roughness roughness_read(struct scene_builder *builder, struct params *params,
                                              const char *both, const char *along_u,
                                              const char *along_v, bool remap) {
  bool u = input_is_given(params, along_u), v = input_is_given(params, along_v);
  return (struct roughness){roughness_read_one(builder, params, u ? along_u : both),
                            roughness_read_one(builder, params, v ? along_v : both), remap};
}

static inline double roughness_alpha(const struct roughness *roughness, const struct input *input,
                                     const struct surface *surface) {
  double value = input_float(input, surface);
  if (!(value > 0)) return 0; // textures may go below
  return roughness->remap ? microfacet_roughness_to_alpha(value) : value;
}

static inline struct microfacet roughness_at(const struct roughness *roughness,
                                             const struct surface *surface) {
  return microfacet_of(roughness_alpha(roughness, &roughness->u, surface),
                       roughness_alpha(roughness, &roughness->v, surface));
}

// The material_needs of a material that is smooth where its facets are.
static inline unsigned roughness_needs(const struct roughness *roughness) {
  bool textured = roughness->u.texture || roughness->v.texture;
  if (textured) return MATERIAL_DELTA | MATERIAL_DETAIL;
  if (roughness_at(roughness, NULL).smooth) return MATERIAL_DELTA;
  return roughness->u.value[0] != roughness->v.value[0] ? MATERIAL_DETAIL : 0;
}

#endif
