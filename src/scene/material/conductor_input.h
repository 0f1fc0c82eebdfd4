// The parameters of a conductor as a scene file gives them (materials "conductor" and
// "coatedconductor"): `eta` and `k`, each a spectrum, default copper's; or `reflectance`.
#ifndef SCENE_MATERIAL_CONDUCTOR_INPUT_H
#define SCENE_MATERIAL_CONDUCTOR_INPUT_H

#include "scene/material/conductor.h"
#include "scene/material/metal.h"
#include "scene/material/roughness.h"

struct conductor_input {
  struct input eta, k, reflectance;
  bool reflects; // by `reflectance`
  struct roughness roughness;
};

// `"spectrum eta" "metal-Cu-eta"` has indices of its own here; everything else is a spectrum.
static inline struct input conductor_read_index(struct scene_builder *builder,
                                                struct params *params, const char *name,
                                                const char *fallback) {
  for (int i = 0; i < params->count; i++) {
    const struct param *param = &params->item[i];
    if (strcmp(param->name, name) || strcmp(param->type, "spectrum") || !param->string) continue;
    const double *index = metal_find(param->string[0]);
    if (!index || !params_any(params, name)) continue;
    return (struct input){.value = {index[0], index[1], index[2]}};
  }
  return input_read_spectrum(builder, params, name, SPECTRUM_UNBOUNDED, metal_find(fallback));
}

static inline struct conductor_input conductor_read(struct scene_builder *builder,
                                                    struct params *params, const char *eta,
                                                    const char *k, struct roughness roughness) {
  static const double none[3] = {0, 0, 0};
  struct conductor_input input = {.roughness = roughness};
  input.reflects = input_is_given(params, "reflectance");
  if (input.reflects) {
    if (input_is_given(params, eta) || input_is_given(params, k))
      params_complain(params, "reflectance", "give either \"reflectance\" or \"%s\" and \"%s\"",
                      eta, k);
    input.reflectance = input_read_spectrum(builder, params, "reflectance", SPECTRUM_ALBEDO, none);
    return input;
  }
  input.eta = conductor_read_index(builder, params, eta, "metal-Cu-eta");
  input.k = conductor_read_index(builder, params, k, "metal-Cu-k");
  return input;
}

static inline struct conductor conductor_at(const struct conductor_input *input,
                                            const struct surface *surface) {
  struct conductor m = {.facets = roughness_at(&input->roughness, surface)};
  if (!input->reflects) {
    input_rgb(&input->eta, surface, m.eta);
    input_rgb(&input->k, surface, m.k);
    return m;
  }
  double rgb[3];
  input_rgb(&input->reflectance, surface, rgb);
  for (int c = 0; c < 3; c++) {
    m.eta[c] = 1;
    m.k[c] = conductor_k_of_reflectance(rgb[c]);
  }
  return m;
}

static inline bool conductor_is_gray(const struct conductor_input *input) {
  if (input->reflects) return input_is_gray(&input->reflectance);
  return input_is_gray(&input->eta) && input_is_gray(&input->k);
}

#endif
