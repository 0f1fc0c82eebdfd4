// Material "conductor": a metal, smooth or rough. `eta`, `k` (spectra; default copper) or
// `reflectance` at normal incidence; `roughness`, `uroughness`, `vroughness`, `remaproughness`.
#include "scene/material/conductor_input.h"

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  struct conductor_input *input = arena_new(builder->arena, struct conductor_input, 1);
  struct roughness roughness =
      roughness_read(builder, params, "roughness", "uroughness", "vroughness",
                     params_bool(params, "remaproughness", true));
  *input = conductor_read(builder, params, "eta", "k", roughness);
  material->data = input;
  material->needs = roughness_needs(&roughness);
  return params_finish(params);
}

// x: eta, k, then the facets; alphas of smooth ones are 0.
static struct conductor unpack(const struct bsdf *bsdf) {
  const double *x = bsdf->x;
  return (struct conductor){
      {x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[7], x[8], .smooth = x[6] == 0}};
}

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  (void)transport;
  struct conductor m = unpack(bsdf);
  conductor_value(&m, wo, wi, f);
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)transport;
  struct conductor m = unpack(bsdf);
  return conductor_pdf(&m, wo, wi);
}

static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  (void)transport;
  struct conductor m = unpack(bsdf);
  if (!conductor_sample(&m, wo, u, &out->wi, out->weight, &out->pdf)) return false;
  if (m.facets.smooth) out->pdf = 0;
  out->eta2 = 1;
  return true;
}

static double delta_probability(const struct bsdf *bsdf, struct vec wo, enum transport transport) {
  (void)wo, (void)transport;
  return unpack(bsdf).facets.smooth;
}

static const struct bsdf_type metal = {
    .value = value, .pdf = pdf, .sample = sample, .delta_probability = delta_probability};

static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene;
  struct conductor m = conductor_at(material->data, surface);
  for (int c = 0; c < 3; c++) {
    out->x[c] = m.eta[c];
    out->x[3 + c] = m.k[c];
  }
  out->x[6] = m.facets.alpha_x;
  out->x[7] = m.facets.alpha_y;
  out->x[8] = m.facets.d_scale;
  out->type = &metal;
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene;
  return conductor_is_gray(material->data);
}

const struct material_type material_conductor = {
    .name = "conductor",
    .about = "a metal, smooth or rough: eta and k, or its reflectance",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
};
