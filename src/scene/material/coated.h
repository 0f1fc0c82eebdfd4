// What "coateddiffuse" and "coatedconductor" share: pbrt-v4's parameters of the coat and of the
// medium below it, and a bsdf that is a struct layered packed into numbers.
#ifndef SCENE_MATERIAL_COATED_H
#define SCENE_MATERIAL_COATED_H

#include "scene/layered.h"
#include "scene/material/albedo.h"
#include "scene/material/dielectric_input.h"
#include "scene/material/roughness.h"

struct coated {
  double eta;
  struct roughness roughness; // of the coat
  struct input thickness, albedo, g;
  int max_depth, n_samples;
};

static inline int coated_read_count(struct params *params, const char *name, int fallback) {
  int64_t count = params_integer(params, name, fallback);
  if (count >= 1 && count <= INT32_MAX) return (int)count;
  params_complain(params, name, "\"%s\" must be at least 1", name);
  return fallback;
}

// `thickness` [0.01], `albedo` [0], `g` [0], `maxdepth` [10], `nsamples` [1].
static inline void coated_read(struct scene_builder *builder, struct params *params,
                               struct coated *coated) {
  static const double none[3] = {0, 0, 0};
  coated->thickness = input_read_float(builder, params, "thickness", 0.01);
  if (!(coated->thickness.value[0] >= 0))
    params_complain(params, "thickness", "the thickness must not be negative, and is %g",
                    coated->thickness.value[0]);
  coated->albedo = input_read_spectrum(builder, params, "albedo", SPECTRUM_ALBEDO, none);
  coated->g = input_read_float(builder, params, "g", 0);
  if (!(fabs(coated->g.value[0]) <= 1))
    params_complain(params, "g", "g must be in [-1, 1], and is %g", coated->g.value[0]);
  coated->max_depth = coated_read_count(params, "maxdepth", 10);
  coated->n_samples = coated_read_count(params, "nsamples", 1);
}

static inline bool coated_is_black(const struct input *input) {
  return !input->texture && input->value[0] == 0 && input->value[1] == 0 && input->value[2] == 0;
}

// Textures are kept within what pbrt-v4 allows, and all g within the 0.99 of its phase function.
static inline void coated_at(const struct coated *coated, const struct surface *surface,
                             struct layered *layered) {
  layered->coat = dielectric_of(coated->eta, roughness_at(&coated->roughness, surface));
  double thickness = input_float(&coated->thickness, surface);
  layered->thickness = thickness > 0 ? thickness : 0;
  albedo_at(&coated->albedo, surface, 1, layered->albedo);
  double g = input_float(&coated->g, surface);
  layered->g = g > -0.99 ? (g < 0.99 ? g : 0.99) : -0.99;
  layered->max_depth = coated->max_depth;
  layered->n_samples = coated->n_samples;
}

// ---- the bsdf ----
// x: the base (six numbers), its facets (two alphas), the coat's, thickness, albedo, g. bsdf.data
// begins with the struct coated.

static inline void coated_pack(const struct layered *layered, struct bsdf *bsdf) {
  const struct conductor *conductor = &layered->conductor;
  double *x = bsdf->x;
  for (int c = 0; c < 3; c++) {
    x[c] = layered->is_conductor ? conductor->eta[c] : layered->reflectance[c];
    x[3 + c] = conductor->k[c];
    x[11 + c] = layered->albedo[c];
  }
  x[6] = conductor->facets.alpha_x;
  x[7] = conductor->facets.alpha_y;
  x[8] = layered->coat.facets.alpha_x;
  x[9] = layered->coat.facets.alpha_y;
  x[10] = layered->thickness;
  x[14] = layered->g;
}

static inline struct layered coated_unpack(const struct bsdf *bsdf, bool is_conductor) {
  const struct coated *coated = bsdf->data;
  const double *x = bsdf->x;
  struct layered layered = {
      .coat = dielectric_of(coated->eta, microfacet_of(x[8], x[9])),
      .is_conductor = is_conductor,
      .thickness = x[10],
      .albedo = {x[11], x[12], x[13]},
      .g = x[14],
      .max_depth = coated->max_depth,
      .n_samples = coated->n_samples,
  };
  if (is_conductor)
    layered.conductor =
        (struct conductor){{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, microfacet_of(x[6], x[7])};
  else
    for (int c = 0; c < 3; c++) layered.reflectance[c] = x[c];
  return layered;
}

// `value`: of the bsdf's type.
static inline bool coated_sample(const struct bsdf *bsdf, const struct layered *layered,
                                 struct vec wo, const double u[3], enum transport transport,
                                 struct bsdf_sample *out) {
  bool delta;
  if (!layered_sample(layered, wo, u, &out->wi, &delta)) return false;
  out->eta2 = 1;
  out->pdf = 0;
  double scale;
  if (delta) {
    layered_delta(layered, wo, out->weight);
    scale = 1 / layered_delta_probability(layered, wo);
  } else {
    bsdf->type->value(bsdf, wo, out->wi, transport, out->weight);
    out->pdf = layered_pdf(layered, wo, out->wi);
    scale = fabs(out->wi.z) / out->pdf;
  }
  for (int c = 0; c < 3; c++) out->weight[c] *= scale;
  return true;
}

#endif
