// Material "coatedconductor": a metal under a dielectric coat. The coat: `interface.roughness`
// (`.uroughness`, `.vroughness`) [0], `interface.eta` [1.5]; the metal: `conductor.eta`,
// `conductor.k` (default copper) or `reflectance`, `conductor.roughness` (`.uroughness`,
// `.vroughness`) [0]; `remaproughness` of both; and coated.h. As pbrt-v4 has it, the metal's eta
// and k are divided by the coat's index. Smooth under smooth is a delta with a closed form;
// everything else is the random walk of layered.h.
#include "scene/material/coated.h"
#include "scene/material/conductor_input.h"

struct coated_conductor {
  struct coated coated; // first: coated.h
  struct conductor_input conductor;
};

static bool is_smooth(const struct roughness *roughness) {
  return !roughness->u.texture && !roughness->v.texture && roughness_at(roughness, NULL).smooth;
}

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  struct coated_conductor *metal = arena_new(builder->arena, struct coated_conductor, 1);
  bool remap = params_bool(params, "remaproughness", true);
  metal->coated.eta = dielectric_read_eta(builder, params, "interface.eta");
  metal->coated.roughness = roughness_read(builder, params, "interface.roughness",
                                           "interface.uroughness", "interface.vroughness", remap);
  coated_read(builder, params, &metal->coated);
  metal->conductor =
      conductor_read(builder, params, "conductor.eta", "conductor.k",
                     roughness_read(builder, params, "conductor.roughness", "conductor.uroughness",
                                    "conductor.vroughness", remap));
  struct coated *coated = &metal->coated;
  unsigned base = roughness_needs(&metal->conductor.roughness);
  material->data = metal;
  material->needs = roughness_needs(&coated->roughness) | (base & MATERIAL_DETAIL);
  if (coated->eta == 1) material->needs |= MATERIAL_DELTA;
  if (!is_smooth(&coated->roughness) || !is_smooth(&metal->conductor.roughness) ||
      !coated_is_black(&coated->albedo))
    material->needs |= MATERIAL_RANDOM;
  return params_finish(params);
}

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  (void)transport;
  struct layered layered = coated_unpack(bsdf, true);
  layered_value(&layered, wo, wi, bsdf->u, f);
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)transport;
  struct layered layered = coated_unpack(bsdf, true);
  return layered_pdf(&layered, wo, wi);
}

static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  struct layered layered = coated_unpack(bsdf, true);
  return coated_sample(bsdf, &layered, wo, u, transport, out);
}

static double delta_probability(const struct bsdf *bsdf, struct vec wo, enum transport transport) {
  (void)transport;
  struct layered layered = coated_unpack(bsdf, true);
  return layered_delta_probability(&layered, wo);
}

static const struct bsdf_type coated_metal = {
    .value = value, .pdf = pdf, .sample = sample, .delta_probability = delta_probability};

static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene;
  const struct coated_conductor *metal = material->data;
  struct layered layered = {.is_conductor = true,
                            .conductor = conductor_at(&metal->conductor, surface)};
  coated_at(&metal->coated, surface, &layered);
  for (int c = 0; c < 3; c++) {
    layered.conductor.eta[c] /= metal->coated.eta;
    layered.conductor.k[c] /= metal->coated.eta;
  }
  out->type = &coated_metal;
  out->data = metal;
  coated_pack(&layered, out);
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene;
  const struct coated_conductor *metal = material->data;
  return conductor_is_gray(&metal->conductor) && input_is_gray(&metal->coated.albedo);
}

const struct material_type material_coatedconductor = {
    .name = "coatedconductor",
    .about = "a metal under a smooth or rough dielectric coat",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
};
