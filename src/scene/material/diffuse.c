// Material "diffuse": Lambert, f = reflectance / pi on the side of the shading normal where wo is;
// both sides reflect. `reflectance` [0.5 0.5 0.5].
#include "numeric/elementary.h"
#include "scene/material/albedo.h"
#include "scene/read.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct diffuse {
  struct input reflectance;
};

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  static const double half[3] = {0.5, 0.5, 0.5};
  struct diffuse *diffuse = arena_new(builder->arena, struct diffuse, 1);
  diffuse->reflectance = input_read_spectrum(builder, params, "reflectance", SPECTRUM_ALBEDO, half);
  material->data = diffuse;
  return params_finish(params);
}

static bool same_side(struct vec wo, struct vec wi) { return (wo.z > 0) == (wi.z > 0); }

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  (void)transport;
  double scale = same_side(wo, wi) ? one_over_pi : 0;
  for (int c = 0; c < 3; c++) f[c] = bsdf->x[c] * scale;
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)bsdf, (void)transport;
  return same_side(wo, wi) ? fabs(wi.z) * one_over_pi : 0;
}

// Cosine-weighted: a point of the unit disc, lifted to the hemisphere (Malley).
static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  (void)transport;
  double r = sqrt(u[0]), z = sqrt(1 - u[0]), sine, cosine;
  num_sincos_turns(u[1], &sine, &cosine);
  out->wi = vec(r * cosine, r * sine, wo.z < 0 ? -z : z);
  for (int c = 0; c < 3; c++) out->weight[c] = bsdf->x[c];
  out->pdf = z * one_over_pi;
  out->eta2 = 1;
  return true;
}

static const struct bsdf_type lambert = {
    .lambert = true, .by_side = true, .value = value, .pdf = pdf, .sample = sample};

static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene;
  const struct diffuse *diffuse = material->data;
  albedo_at(&diffuse->reflectance, surface, 1, out->x);
  if (out->x[0] != 0 || out->x[1] != 0 || out->x[2] != 0) out->type = &lambert;
}

static bool is_black(const struct material *material) {
  const struct diffuse *diffuse = material->data;
  const double *rgb = diffuse->reflectance.value;
  return !diffuse->reflectance.texture && rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0;
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene;
  const struct diffuse *diffuse = material->data;
  return input_is_gray(&diffuse->reflectance);
}

const struct material_type material_diffuse = {
    .name = "diffuse",
    .about = "Lambertian reflection, both sides",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
    .is_black = is_black,
};
