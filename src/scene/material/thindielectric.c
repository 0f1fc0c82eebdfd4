// Material "thindielectric": a pane of glass without thickness, smooth. What is reflected between
// its two sides adds up: R' = R + T^2 R / (1 - R^2) = 2 R / (1 + R); the rest goes straight on.
// `eta` [1.5].
#include "scene/material/dielectric_input.h"
#include "scene/material/fresnel.h"

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  double *eta = arena_new(builder->arena, double, 1);
  *eta = dielectric_read_eta(builder, params, "eta");
  material->data = eta;
  material->needs = MATERIAL_DELTA;
  return params_finish(params);
}

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  (void)bsdf, (void)wo, (void)wi, (void)transport;
  f[0] = f[1] = f[2] = 0;
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)bsdf, (void)wo, (void)wi, (void)transport;
  return 0;
}

static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  (void)transport;
  double once = fresnel_dielectric(fabs(wo.z), bsdf->x[0]);
  bool reflects = u[2] < 2 * once / (1 + once);
  *out = (struct bsdf_sample){
      .wi = vec(-wo.x, -wo.y, reflects ? wo.z : -wo.z), .weight = {1, 1, 1}, .eta2 = 1};
  return true;
}

static double delta_probability(const struct bsdf *bsdf, struct vec wo, enum transport transport) {
  (void)bsdf, (void)wo, (void)transport;
  return 1;
}

static const struct bsdf_type pane = {
    .value = value, .pdf = pdf, .sample = sample, .delta_probability = delta_probability};

static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene, (void)surface;
  out->type = &pane;
  out->x[0] = *(const double *)material->data;
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene, (void)material;
  return true;
}

const struct material_type material_thindielectric = {
    .name = "thindielectric",
    .about = "a smooth pane of glass without thickness",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
};
