// Material "diffuse": Lambert, f = reflectance / pi on the side of the geometric normal where wo
// is; both sides reflect. `rgb reflectance` [0.5 0.5 0.5].
#include "numeric/elementary.h"
#include "scene/scene.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;

struct diffuse {
  double reflectance[3];
};

static bool read(struct params *params, struct arena *arena, struct material *material) {
  struct diffuse *diffuse = arena_new(arena, struct diffuse, 1);
  *diffuse = (struct diffuse){{0.5, 0.5, 0.5}};
  params_rgb(params, "reflectance", diffuse->reflectance);
  for (int c = 0; c < 3; c++)
    if (!(diffuse->reflectance[c] >= 0 && diffuse->reflectance[c] <= 1))
      params_complain(params, "reflectance", "the reflectance %g is outside [0, 1]",
                      diffuse->reflectance[c]);
  material->data = diffuse;
  return params_finish(params);
}

static bool same_side(const struct surface *surface, struct vec wo, struct vec wi) {
  double o = vec_dot(wo, surface->ng), i = vec_dot(wi, surface->ng);
  return (o > 0 && i > 0) || (o < 0 && i < 0);
}

static void value(const struct material *material, const struct surface *surface, struct vec wo,
                  struct vec wi, double f[3]) {
  const struct diffuse *diffuse = material->data;
  double scale = same_side(surface, wo, wi) ? one_over_pi : 0;
  for (int c = 0; c < 3; c++) f[c] = diffuse->reflectance[c] * scale;
}

static double pdf(const struct material *material, const struct surface *surface, struct vec wo,
                  struct vec wi) {
  (void)material;
  return same_side(surface, wo, wi) ? fabs(vec_dot(wi, surface->ng)) * one_over_pi : 0;
}

static bool is_black(const struct material *material) {
  const struct diffuse *diffuse = material->data;
  return diffuse->reflectance[0] == 0 && diffuse->reflectance[1] == 0 &&
         diffuse->reflectance[2] == 0;
}

// Cosine-weighted: a point of the unit disc, lifted to the hemisphere (Malley).
static bool sample(const struct material *material, const struct surface *surface, struct vec wo,
                   const double u[3], struct bsdf_sample *out) {
  const struct diffuse *diffuse = material->data;
  double side = vec_dot(wo, surface->ng), sine, cosine;
  if (side == 0 || is_black(material)) return false;
  struct vec n = side < 0 ? vec_scale(surface->ng, -1) : surface->ng, s, t;
  vec_basis(n, &s, &t);
  double r = sqrt(u[0]), z = sqrt(1 - u[0]);
  num_sincos_turns(u[1], &sine, &cosine);
  out->wi = vec_along(vec_along(vec_scale(s, r * cosine), t, r * sine), n, z);
  out->pdf_solid_angle = z * one_over_pi;
  for (int c = 0; c < 3; c++) out->weight[c] = diffuse->reflectance[c];
  return true;
}

static bool is_gray(const struct material *material) {
  const struct diffuse *diffuse = material->data;
  return diffuse->reflectance[0] == diffuse->reflectance[1] &&
         diffuse->reflectance[1] == diffuse->reflectance[2];
}

const struct material_type material_diffuse = {
    .name = "diffuse",
    .about = "Lambertian reflection, both sides",
    .read = read,
    .value = value,
    .pdf = pdf,
    .sample = sample,
    .is_gray = is_gray,
    .is_black = is_black,
};
