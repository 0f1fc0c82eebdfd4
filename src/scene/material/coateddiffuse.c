// Material "coateddiffuse": a Lambertian base, `reflectance` [0.5], under a dielectric coat:
// `roughness` (`uroughness`, `vroughness`, `remaproughness`) [0], `eta` [1.5]; and coated.h.
// Without a medium between them the base forgets directions, and pbrt-v4's random walk has a closed
// form: f = coat's reflection + R / (pi eta^2) t(wo) t(wi) (1 + R K + ... + (R K)^(n - 1)), with t
// and K of coat.h and n = ceil(maxdepth / 2), as often as the walk comes to the base. With a medium
// (`albedo`), and where t has no table (a textured thickness, textured u and v of their own, a
// rough coat of eta < 1), the walk itself is the value.
#include "scene/material/coated.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct coated_diffuse {
  struct coated coated; // first: coated.h
  struct input reflectance;
  bool is_tabulated;
  struct coat_table table;
};

extern const struct material_type material_coateddiffuse;

static bool is_textured(const struct coated *coated) {
  return coated->roughness.u.texture || coated->roughness.v.texture;
}

static bool has_table(const struct coated *coated) {
  const struct input *u = &coated->roughness.u, *v = &coated->roughness.v;
  if (coated->thickness.texture) return false;
  if (!coated->albedo.texture && !coated_is_black(&coated->albedo)) return false;
  if (is_textured(coated)) return u->texture == v->texture && coated->eta >= 1;
  return coated->eta >= 1 || roughness_at(&coated->roughness, NULL).smooth;
}

static bool same_coat(const struct coated *a, const struct coated *b) {
  if (a->eta != b->eta || a->thickness.value[0] != b->thickness.value[0]) return false;
  if (is_textured(a) || is_textured(b)) return is_textured(a) && is_textured(b);
  struct microfacet p = roughness_at(&a->roughness, NULL), q = roughness_at(&b->roughness, NULL);
  return p.smooth == q.smooth && p.alpha_x == q.alpha_x && p.alpha_y == q.alpha_y;
}

// Computing a table takes some milliseconds, and materials share coats: that of one read before.
static const struct coat_table *find_table(const struct scene *scene, const struct coated *coated) {
  for (uint32_t i = 0; i < scene->n_materials; i++) {
    if (scene->material[i].type != &material_coateddiffuse) continue;
    const struct coated_diffuse *other = scene->material[i].data;
    if (other->is_tabulated && same_coat(&other->coated, coated)) return &other->table;
  }
  return NULL;
}

static struct coat_table make_table(struct scene_builder *builder, const struct coated *coated) {
  const struct coat_table *found = find_table(builder->scene, coated);
  if (found) return *found;
  double thickness = coated->thickness.value[0];
  if (is_textured(coated)) return coat_table_alphas(builder->arena, coated->eta, thickness);
  struct dielectric coat = dielectric_of(coated->eta, roughness_at(&coated->roughness, NULL));
  return coat_table_one(builder->arena, &coat, thickness);
}

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  static const double half[3] = {0.5, 0.5, 0.5};
  struct coated_diffuse *diffuse = arena_new(builder->arena, struct coated_diffuse, 1);
  struct coated *coated = &diffuse->coated;
  diffuse->reflectance = input_read_spectrum(builder, params, "reflectance", SPECTRUM_ALBEDO, half);
  coated->eta = dielectric_read_eta(builder, params, "eta");
  coated->roughness = roughness_read(builder, params, "roughness", "uroughness", "vroughness",
                                     params_bool(params, "remaproughness", true));
  coated_read(builder, params, coated);
  if (!params_finish(params)) return false;
  diffuse->is_tabulated = has_table(coated);
  if (diffuse->is_tabulated) diffuse->table = make_table(builder, coated);
  material->data = diffuse;
  material->needs = roughness_needs(&coated->roughness) | (coated->eta == 1 ? MATERIAL_DELTA : 0);
  if (!diffuse->is_tabulated || coated->albedo.texture) material->needs |= MATERIAL_RANDOM;
  return true;
}

// 1 + x + ... + x^(n - 1)
static double series(double x, int n) {
  double sum = 0, term = 1;
  for (int i = 0; i < n && term > 0; i++, term *= x) {
    if (sum + term == sum) break;
    sum += term;
  }
  return sum;
}

static void value_closed(const struct bsdf *bsdf, struct vec wo, struct vec wi,
                         enum transport transport, double f[3]) {
  (void)transport;
  f[0] = f[1] = f[2] = 0;
  if ((wo.z > 0) != (wi.z > 0)) return;
  const struct coated_diffuse *diffuse = bsdf->data;
  struct layered layered = coated_unpack(bsdf, false);
  const struct dielectric *coat = &layered.coat;
  if (wo.z < 0) {
    wo = layered_opposite(wo);
    wi = layered_opposite(wi);
  }
  double top = dielectric_value(coat, wo, wi, TRANSPORT_IMPORTANCE);
  double through = coat_table_entering(&diffuse->table, coat, wo) *
                   coat_table_entering(&diffuse->table, coat, wi) / (coat->eta * coat->eta);
  double returned = coat_table_returned(&diffuse->table, coat);
  int times = layered.max_depth / 2 + layered.max_depth % 2;
  for (int c = 0; c < 3; c++) {
    double r = layered.reflectance[c];
    f[c] = top + r * one_over_pi * through * series(r * returned, times);
  }
}

static void value_walked(const struct bsdf *bsdf, struct vec wo, struct vec wi,
                         enum transport transport, double f[3]) {
  (void)transport;
  struct layered layered = coated_unpack(bsdf, false);
  layered_value(&layered, wo, wi, bsdf->u, f);
}

static double pdf(const struct bsdf *bsdf, struct vec wo, struct vec wi, enum transport transport) {
  (void)transport;
  struct layered layered = coated_unpack(bsdf, false);
  return layered_pdf(&layered, wo, wi);
}

static bool sample(const struct bsdf *bsdf, struct vec wo, const double u[3],
                   enum transport transport, struct bsdf_sample *out) {
  struct layered layered = coated_unpack(bsdf, false);
  return coated_sample(bsdf, &layered, wo, u, transport, out);
}

static double delta_probability(const struct bsdf *bsdf, struct vec wo, enum transport transport) {
  (void)transport;
  struct layered layered = coated_unpack(bsdf, false);
  return layered_delta_probability(&layered, wo);
}

static const struct bsdf_type closed = {
    .value = value_closed, .pdf = pdf, .sample = sample, .delta_probability = delta_probability};
static const struct bsdf_type walked = {
    .value = value_walked, .pdf = pdf, .sample = sample, .delta_probability = delta_probability};

static void bsdf(const struct scene *scene, const struct material *material,
                 const struct surface *surface, struct bsdf *out) {
  (void)scene;
  const struct coated_diffuse *diffuse = material->data;
  struct layered layered = {0};
  coated_at(&diffuse->coated, surface, &layered);
  albedo_at(&diffuse->reflectance, surface, 1, layered.reflectance);
  out->type = diffuse->is_tabulated && !layered_has_medium(&layered) ? &closed : &walked;
  out->data = diffuse;
  coated_pack(&layered, out);
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene;
  const struct coated_diffuse *diffuse = material->data;
  return input_is_gray(&diffuse->reflectance) && input_is_gray(&diffuse->coated.albedo);
}

const struct material_type material_coateddiffuse = {
    .name = "coateddiffuse",
    .about = "Lambertian reflection under a smooth or rough dielectric coat",
    .read = read,
    .bsdf = bsdf,
    .is_gray = is_gray,
};
