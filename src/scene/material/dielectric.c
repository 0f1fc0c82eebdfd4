// Material "dielectric": glass or water, smooth or rough. `eta` [1.5], a float or a spectrum
// ("glass-BK7"); `roughness`, `uroughness`, `vroughness`, `remaproughness`. Inside is where the
// shading normal does not point.
#include "scene/material/dielectric.h"
#include "scene/material/dielectric_input.h"
#include "scene/material/roughness.h"

struct glass {
  double eta;
  struct roughness roughness;
};

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  struct glass *glass = arena_new(builder->arena, struct glass, 1);
  glass->eta = dielectric_read_eta(builder, params, "eta");
  glass->roughness = roughness_read(builder, params, "roughness", "uroughness", "vroughness",
                                    params_bool(params, "remaproughness", true));
  material->data = glass;
  material->needs = roughness_needs(&glass->roughness) | (glass->eta == 1 ? MATERIAL_DELTA : 0);
  return params_finish(params);
}

// x: eta, then the facets; alphas of smooth ones are 0.
static struct dielectric unpack(const struct bsdf *bsdf) {
  const double *x = bsdf->x;
  return (struct dielectric){x[0], {x[1], x[2], x[3], .smooth = x[1] == 0}};
}

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  struct dielectric m = unpack(bsdf);
  f[0] = f[1] = f[2] = dielectric_value(&m, wo, wi, transport);
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)transport;
  struct dielectric m = unpack(bsdf);
  return dielectric_pdf(&m, wo, wi);
}

static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  struct dielectric m = unpack(bsdf);
  struct dielectric_sample chosen;
  if (!dielectric_sample(&m, wo, u, transport, &chosen)) return false;
  out->wi = chosen.wi;
  for (int c = 0; c < 3; c++) out->weight[c] = chosen.weight;
  out->pdf = m.facets.smooth ? 0 : chosen.pdf;
  out->eta2 = transport == TRANSPORT_RADIANCE ? chosen.eta_path * chosen.eta_path : 1;
  return true;
}

static double delta_probability(const struct bsdf *bsdf, struct vec wo, enum transport transport) {
  (void)wo, (void)transport;
  return unpack(bsdf).facets.smooth;
}

static const struct bsdf_type boundary = {
    .value = value, .pdf = pdf, .sample = sample, .delta_probability = delta_probability};

static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene;
  const struct glass *glass = material->data;
  struct dielectric m = dielectric_of(glass->eta, roughness_at(&glass->roughness, surface));
  out->type = &boundary;
  out->x[0] = m.eta;
  out->x[1] = 0;
  if (m.facets.smooth) return;
  out->x[1] = m.facets.alpha_x;
  out->x[2] = m.facets.alpha_y;
  out->x[3] = m.facets.d_scale;
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene, (void)material;
  return true;
}

const struct material_type material_dielectric = {
    .name = "dielectric",
    .about = "glass or water, smooth or rough",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
};
