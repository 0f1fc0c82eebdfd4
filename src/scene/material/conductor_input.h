// The parameters of a conductor as a scene file gives them (materials "conductor" and
// "coatedconductor"): `eta` and `k`, each a spectrum, default copper's; or `reflectance`.
#ifndef SCENE_MATERIAL_CONDUCTOR_INPUT_H
#define SCENE_MATERIAL_CONDUCTOR_INPUT_H

#include "scene/material/conductor.h"
#include "scene/material/roughness.h"
#include "spectrum/spectrum.h"

#include <string.h>

struct conductor_input {
  struct input eta, k, reflectance;
  bool reflects; // by `reflectance`
  struct roughness roughness;
};

static inline struct input conductor_copper(const char *name) {
  struct input input = {0};
  memcpy(input.value, spectrum_named(name)->rgb, sizeof input.value);
  return input;
}

static inline bool conductor_is_textured(const struct params *params, const char *name) {
  for (int i = 0; i < params->count; i++)
    if (!strcmp(params->item[i].name, name)) return !strcmp(params->item[i].type, "texture");
  return false;
}

// Fourth powers must be finite.
static inline void conductor_check_index(struct params *params, const char *name,
                                         const struct input *input) {
  for (int c = 0; c < 3; c++)
    if (!(input->value[c] <= 1e6)) {
      params_complain(params, name, "\"%s\" must not exceed 1e6, and has %g", name,
                      input->value[c]);
      return;
    }
}

static inline void conductor_read_indices(struct scene_builder *builder, struct params *params,
                                          const char *eta, const char *k,
                                          struct conductor_input *input) {
  input->eta = conductor_copper("metal-Cu-eta");
  input->k = conductor_copper("metal-Cu-k");
  if (conductor_is_textured(params, eta) || conductor_is_textured(params, k)) {
    input->eta = input_read_spectrum(builder, params, eta, SPECTRUM_UNBOUNDED, input->eta.value);
    input->k = input_read_spectrum(builder, params, k, SPECTRUM_UNBOUNDED, input->k.value);
  } else {
    spectrum_read_metal(builder, params, eta, k, input->eta.value, input->k.value);
  }
  conductor_check_index(params, eta, &input->eta);
  conductor_check_index(params, k, &input->k);
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
  conductor_read_indices(builder, params, eta, k, &input);
  return input;
}

static inline struct conductor conductor_at(const struct conductor_input *input,
                                            const struct surface *surface) {
  struct conductor m = {.facets = roughness_at(&input->roughness, surface)};
  if (!input->reflects) {
    input_rgb(&input->eta, surface, m.eta);
    input_rgb(&input->k, surface, m.k);
    for (int c = 0; c < 3; c++) { // textures may go below
      m.eta[c] = m.eta[c] > 0 ? m.eta[c] : 0;
      m.k[c] = m.k[c] > 0 ? m.k[c] : 0;
    }
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
