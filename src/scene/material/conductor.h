// A smooth or rough conductor in the shading frame (pbrt-v4's ConductorBxDF), both sides:
// reflection at Trowbridge-Reitz facets with the Fresnel reflectance of eta + i k, per channel.
#ifndef SCENE_MATERIAL_CONDUCTOR_H
#define SCENE_MATERIAL_CONDUCTOR_H

#include "scene/material/fresnel.h"
#include "scene/material/microfacet.h"

struct conductor {
  double eta[3], k[3];
  struct microfacet facets;
};

// pbrt-v4's indices for a reflectance r at normal incidence: eta = 1, k = 2 sqrt(r) / sqrt(1 - r),
// r in [0, 0.9999].
static inline double conductor_k_of_reflectance(double r) {
  r = r > 0 ? (r < 0.9999 ? r : 0.9999) : 0;
  return 2 * sqrt(r) / sqrt(1 - r);
}

// Channels that are equal are computed once.
static inline void conductor_fresnel(const struct conductor *m, double cosine, double scale,
                                     double rgb[3]) {
  for (int c = 0; c < 3; c++) {
    bool again = c > 0 && m->eta[c] == m->eta[c - 1] && m->k[c] == m->k[c - 1];
    rgb[c] = again ? rgb[c - 1] : scale * fresnel_conductor(cosine, m->eta[c], m->k[c]);
  }
}

// The facet that reflects wo to wi: its density and cosine. False: none does.
static inline bool conductor_facet(const struct conductor *m, struct vec wo, struct vec wi,
                                   double *d, double *cosine) {
  if (m->facets.smooth || !(wo.z * wi.z > 0)) return false;
  struct vec wm = vec_normalize(vec_add(wo, wi));
  *cosine = vec_dot(wo, wm);
  *d = microfacet_d(&m->facets, wm);
  return true;
}

static inline void conductor_value(const struct conductor *m, struct vec wo, struct vec wi,
                                   double f[3]) {
  double d, cosine;
  f[0] = f[1] = f[2] = 0;
  if (!conductor_facet(m, wo, wi, &d, &cosine)) return;
  double scale = d * microfacet_g_over_cosines(&m->facets, wo, wi) / 4;
  conductor_fresnel(m, cosine, scale, f);
}

static inline double conductor_pdf_of(const struct conductor *m, struct vec wo, double d) {
  return d / (2 * (microfacet_stretch(&m->facets, wo) + fabs(wo.z)));
}

static inline double conductor_pdf(const struct conductor *m, struct vec wo, struct vec wi) {
  double d, cosine;
  return conductor_facet(m, wo, wi, &d, &cosine) ? conductor_pdf_of(m, wo, d) : 0;
}

// weight: f |cos| / pdf; pdf per solid angle, 1 where smooth. False: the facet sends wi through the
// surface.
static inline bool conductor_sample(const struct conductor *m, struct vec wo, const double u[2],
                                    struct vec *wi, double weight[3], double *pdf) {
  if (wo.z == 0) return false;
  double cosine = fabs(wo.z), scale = 1;
  if (m->facets.smooth) {
    *wi = vec(-wo.x, -wo.y, wo.z);
    *pdf = 1;
  } else {
    struct vec wm = microfacet_sample(&m->facets, wo, u);
    *wi = fresnel_reflect(wo, wm);
    if (!(wi->z * wo.z > 0)) return false;
    double zo = fabs(wo.z), zi = fabs(wi->z);
    double so = microfacet_stretch(&m->facets, wo), si = microfacet_stretch(&m->facets, *wi);
    cosine = fabs(vec_dot(wo, wm));
    scale = zi * (so + zo) / (so * zi + si * zo); // G / G1
    *pdf = conductor_pdf_of(m, wo, microfacet_d(&m->facets, wm));
  }
  conductor_fresnel(m, cosine, scale, weight);
  return true;
}

#endif
