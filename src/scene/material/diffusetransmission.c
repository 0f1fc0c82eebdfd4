// Material "diffusetransmission": Lambertian reflection and transmission, both sides: paper,
// leaves. `reflectance`, `transmittance` [0.25 0.25 0.25], each times `float scale` [1]. As in
// pbrt-v4 the two may sum to more than 1.
#include "numeric/elementary.h"
#include "scene/material/albedo.h"
#include "scene/read.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct sheet {
  struct input side[2]; // reflectance, transmittance
  double scale;
};

static struct input read_side(struct scene_builder *builder, struct params *params,
                              const char *name, double scale) {
  static const double quarter[3] = {0.25, 0.25, 0.25};
  struct input input = input_read_spectrum(builder, params, name, SPECTRUM_ALBEDO, quarter);
  for (int c = 0; !input.texture && c < 3; c++)
    if (!(input.value[c] * scale <= 1)) {
      params_complain(params, name, "\"%s\" times \"scale\" must not exceed 1, and is %g", name,
                      input.value[c] * scale);
      break;
    }
  return input;
}

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  struct sheet *sheet = arena_new(builder->arena, struct sheet, 1);
  sheet->scale = params_float(params, "scale", 1);
  if (!(sheet->scale >= 0)) params_complain(params, "scale", "\"scale\" must not be negative");
  sheet->side[0] = read_side(builder, params, "reflectance", sheet->scale);
  sheet->side[1] = read_side(builder, params, "transmittance", sheet->scale);
  material->data = sheet;
  return params_finish(params);
}

// x: reflectance, transmittance, the probability of reflection.
enum { REFLECTED = 0, TRANSMITTED = 3, CHOICE = 6 };

static bool same_side(struct vec wo, struct vec wi) { return (wo.z > 0) == (wi.z > 0); }

static void value(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport,
                  double f[3]) {
  (void)transport;
  const double *rgb = bsdf->x + (same_side(wo, wi) ? REFLECTED : TRANSMITTED);
  for (int c = 0; c < 3; c++) f[c] = rgb[c] * one_over_pi;
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)transport;
  double choice = bsdf->x[CHOICE];
  return fabs(wi.z) * one_over_pi * (same_side(wo, wi) ? choice : 1 - choice);
}

// Cosine-weighted on either side (Malley).
static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  (void)transport;
  bool reflects = u[2] < bsdf->x[CHOICE];
  double share = reflects ? bsdf->x[CHOICE] : 1 - bsdf->x[CHOICE];
  const double *rgb = bsdf->x + (reflects ? REFLECTED : TRANSMITTED);
  double r = sqrt(u[0]), z = sqrt(1 - u[0]), sine, cosine;
  num_sincos_turns(u[1], &sine, &cosine);
  out->wi = vec(r * cosine, r * sine, (wo.z > 0) == reflects ? z : -z);
  for (int c = 0; c < 3; c++) out->weight[c] = rgb[c] / share;
  out->pdf = z * one_over_pi * share;
  out->eta2 = 1;
  return true;
}

static const struct bsdf_type lambert = {
    .value = value, .by_side = true, .pdf = pdf, .sample = sample};

// Reflection is chosen as pbrt chooses it: by the largest channels.
static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene;
  const struct sheet *sheet = material->data;
  double largest[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    double *rgb = out->x + (k == 0 ? REFLECTED : TRANSMITTED);
    albedo_at(&sheet->side[k], surface, sheet->scale, rgb);
    for (int c = 0; c < 3; c++) largest[k] = largest[k] < rgb[c] ? rgb[c] : largest[k];
  }
  if (!(largest[0] + largest[1] > 0)) return;
  out->x[CHOICE] = largest[0] / (largest[0] + largest[1]);
  out->type = &lambert;
}

static bool is_black_side(const struct sheet *sheet, int k) {
  const double *rgb = sheet->side[k].value;
  return sheet->scale == 0 ||
         (!sheet->side[k].texture && rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
}

static bool is_black(const struct material *material) {
  return is_black_side(material->data, 0) && is_black_side(material->data, 1);
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene;
  const struct sheet *sheet = material->data;
  return input_is_gray(&sheet->side[0]) && input_is_gray(&sheet->side[1]);
}

const struct material_type material_diffusetransmission = {
    .name = "diffusetransmission",
    .about = "Lambertian reflection and transmission, both sides",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
    .is_black = is_black,
};
