// Trowbridge-Reitz (GGX) microfacets in the shading frame, z = normal, as pbrt-v4 uses them:
// Smith's height-correlated shadowing, normals sampled in proportion to what w sees of them (Heitz
// 2014, "Understanding the Masking-Shadowing Function", and 2018, "Sampling the GGX Distribution of
// Visible Normals"). Directions are of unit length. Written without tangents, so nothing is
// infinite at grazing angles: with s(w) = sqrt(alpha_x^2 x^2 + alpha_y^2 y^2 + z^2),
//   1 + Lambda(w) = (s + |z|) / (2 |z|).
#ifndef SCENE_MATERIAL_MICROFACET_H
#define SCENE_MATERIAL_MICROFACET_H

#include "base/vec.h"
#include "numeric/elementary.h"

#include <stdbool.h>

struct microfacet {
  double alpha_x, alpha_y;
  double d_scale; // 1 / (pi alpha_x alpha_y)
  bool smooth;    // all normals are z: reflection and transmission are deltas, the rest is unset
};

static inline double microfacet_roughness_to_alpha(double roughness) { return sqrt(roughness); }

// pbrt-v4's rules: smooth below 1e-3 in both directions, and where only one is rough, the other is
// not below 1e-4.
static inline struct microfacet microfacet_of(double alpha_x, double alpha_y) {
  struct microfacet m = {.smooth = alpha_x < 1e-3 && alpha_y < 1e-3};
  if (m.smooth) return m;
  m.alpha_x = alpha_x > 1e-4 ? alpha_x : 1e-4;
  m.alpha_y = alpha_y > 1e-4 ? alpha_y : 1e-4;
  m.d_scale = 0x1.45f306dc9c883p-2 / (m.alpha_x * m.alpha_y); // 1/pi
  return m;
}

// Density of microfacet normals: the integral of D(wm) |wm.z| over the hemisphere is 1.
static inline double microfacet_d(const struct microfacet *m, struct vec wm) {
  double x = wm.x / m->alpha_x, y = wm.y / m->alpha_y, sum = x * x + y * y + wm.z * wm.z;
  return m->d_scale / (sum * sum);
}

static inline double microfacet_stretch(const struct microfacet *m, struct vec w) { // s(w)
  double x = m->alpha_x * w.x, y = m->alpha_y * w.y;
  return sqrt(x * x + y * y + w.z * w.z);
}

static inline double microfacet_lambda(const struct microfacet *m, struct vec w) {
  return (microfacet_stretch(m, w) / fabs(w.z) - 1) / 2;
}

static inline double microfacet_g1(const struct microfacet *m, struct vec w) {
  double z = fabs(w.z);
  return 2 * z / (microfacet_stretch(m, w) + z);
}

// G(wo, wi) / (|wo.z| |wi.z|) = 2 / (s(wo) |wi.z| + s(wi) |wo.z|), with G = 1 / (1 + Lambda(wo) +
// Lambda(wi)). What a BSDF needs; finite unless both graze.
static inline double microfacet_g_over_cosines(const struct microfacet *m, struct vec wo,
                                               struct vec wi) {
  return 2 / (microfacet_stretch(m, wo) * fabs(wi.z) + microfacet_stretch(m, wi) * fabs(wo.z));
}

static inline double microfacet_g(const struct microfacet *m, struct vec wo, struct vec wi) {
  return microfacet_g_over_cosines(m, wo, wi) * fabs(wo.z) * fabs(wi.z);
}

// Density per solid angle of normals as seen from w: D(wm) G1(w) |w.wm| / |w.z|.
static inline double microfacet_pdf(const struct microfacet *m, struct vec w, struct vec wm) {
  return microfacet_d(m, wm) * 2 * fabs(vec_dot(w, wm)) / (microfacet_stretch(m, w) + fabs(w.z));
}

// A normal with that density, on the side of +z; w may be on either side. w.z != 0.
static inline struct vec microfacet_sample(const struct microfacet *m, struct vec w,
                                           const double u[2]) {
  // Stretched by alpha the facets are half a unit sphere, seen from direction v.
  struct vec v = vec_normalize(vec(m->alpha_x * w.x, m->alpha_y * w.y, w.z));
  if (v.z < 0) v = vec_scale(v, -1);
  double across2 = v.x * v.x + v.y * v.y, sine, cosine;
  // Below 2^-106 the tilt of v is less than its rounding: any axis will do.
  struct vec t1 =
      across2 > 0x1p-106 ? vec_scale(vec(-v.y, v.x, 0), 1 / sqrt(across2)) : vec(1, 0, 0);
  struct vec t2 = vec_cross(v, t1);
  // Seen from v: half a disc, and half a disc squeezed by v.z.
  double r = sqrt(u[0]);
  num_sincos_turns(u[1], &sine, &cosine);
  double p1 = r * cosine, half = sqrt(1 - p1 * p1), a = (1 + v.z) / 2;
  double p2 = (1 - a) * half + a * (r * sine);
  double up2 = 1 - p1 * p1 - p2 * p2, up = up2 > 0 ? sqrt(up2) : 0; // negative by rounding only
  struct vec n = vec_along(vec_along(vec_scale(t1, p1), t2, p2), v, up);
  double z = n.z > 0 ? n.z : 0; // as well
  return vec_normalize(vec(m->alpha_x * n.x, m->alpha_y * n.y, z));
}

#endif
