// A smooth or rough interface between two dielectrics, in the shading frame (pbrt-v4's
// DielectricBxDF; Walter et al. 2007, equations 20 and 21). eta: the index below (z < 0) over that
// above. Reflection and refraction are chosen with Fresnel's probabilities at the facet, so all of
// a sample's weight is G / G1, and 1 where smooth.
#ifndef SCENE_MATERIAL_DIELECTRIC_H
#define SCENE_MATERIAL_DIELECTRIC_H

#include "scene/bsdf.h"
#include "scene/material/fresnel.h"
#include "scene/material/microfacet.h"

struct dielectric {
  double eta;
  struct microfacet facets; // smooth too where eta = 1: equal indices do not scatter, however rough
};

static inline struct dielectric dielectric_of(double eta, struct microfacet facets) {
  facets.smooth |= eta == 1;
  return (struct dielectric){eta, facets};
}

// How wo becomes wi: at a facet with normal wm on the side of +z.
struct dielectric_event {
  bool reflects;
  double eta_path; // the index at wi over that at wo
  double wo_wm, wi_wm;
  double fresnel; // reflectance of the facet
  double d;
};

// False if no facet does it.
static inline bool dielectric_meet(const struct dielectric *m, struct vec wo, struct vec wi,
                                   struct dielectric_event *event) {
  if (m->facets.smooth || wo.z == 0 || wi.z == 0) return false;
  event->reflects = (wo.z > 0) == (wi.z > 0);
  event->eta_path = event->reflects ? 1 : wo.z > 0 ? m->eta : 1 / m->eta;
  struct vec half = vec_along(wo, wi, event->eta_path);
  double length2 = vec_dot(half, half);
  if (!(length2 > 0)) return false;
  struct vec wm = vec_scale(half, (half.z < 0 ? -1 : 1) / sqrt(length2));
  event->wo_wm = vec_dot(wo, wm);
  event->wi_wm = vec_dot(wi, wm);
  if (!(event->wo_wm * wo.z > 0 && event->wi_wm * wi.z > 0)) return false; // seen from behind
  event->fresnel = fresnel_dielectric(event->wo_wm, m->eta);
  event->d = microfacet_d(&m->facets, wm);
  return true;
}

// Times the density of facets: |wo.wm| times the share of light that takes this way and the facets
// per direction, F / (4 |wo.wm|) or (1 - F) |wi.wm| / (wi.wm + wo.wm / eta_path)^2.
static inline double dielectric_share(const struct dielectric_event *event) {
  if (event->reflects) return event->fresnel / 4;
  double sum = event->wi_wm + event->wo_wm / event->eta_path;
  return (1 - event->fresnel) * fabs(event->wi_wm * event->wo_wm) / (sum * sum);
}

// Radiance: light comes from wi, and refracted it changes by 1 / eta_path^2. Importance does not.
static inline double dielectric_value(const struct dielectric *m, struct vec wo, struct vec wi,
                                      enum transport transport) {
  struct dielectric_event event;
  if (!dielectric_meet(m, wo, wi, &event)) return 0;
  double f = event.d * microfacet_g_over_cosines(&m->facets, wo, wi) * dielectric_share(&event);
  return transport == TRANSPORT_RADIANCE ? f / (event.eta_path * event.eta_path) : f;
}

static inline double dielectric_event_pdf(const struct dielectric *m, struct vec wo,
                                          const struct dielectric_event *event) {
  return event->d * dielectric_share(event) * 2 / (microfacet_stretch(&m->facets, wo) + fabs(wo.z));
}

static inline double dielectric_pdf(const struct dielectric *m, struct vec wo, struct vec wi) {
  struct dielectric_event event;
  return dielectric_meet(m, wo, wi, &event) ? dielectric_event_pdf(m, wo, &event) : 0;
}

struct dielectric_sample {
  struct vec wi;
  double weight;   // f |cos| / pdf
  double pdf;      // per solid angle; of a smooth interface the probability of the choice
  double eta_path; // 1 for reflection
};

static inline bool dielectric_sample_smooth(const struct dielectric *m, struct vec wo, double u,
                                            struct dielectric_sample *out) {
  double fresnel = fresnel_dielectric(wo.z, m->eta);
  bool reflects = u < fresnel;
  out->weight = out->eta_path = 1;
  out->pdf = reflects ? fresnel : 1 - fresnel;
  out->wi = vec(-wo.x, -wo.y, wo.z);
  return reflects || fresnel_refract(wo, vec(0, 0, 1), m->eta, &out->eta_path, &out->wi);
}

static inline bool dielectric_sample_rough(const struct dielectric *m, struct vec wo,
                                           const double u[3], struct dielectric_sample *out) {
  if (wo.z == 0) return false;
  struct vec wm = microfacet_sample(&m->facets, wo, u);
  struct dielectric_event event = {.eta_path = 1, .wo_wm = vec_dot(wo, wm)};
  if (!(event.wo_wm * wo.z > 0)) return false; // by rounding only
  event.fresnel = fresnel_dielectric(event.wo_wm, m->eta);
  event.reflects = u[2] < event.fresnel;
  if (event.reflects)
    out->wi = fresnel_reflect(wo, wm);
  else if (!fresnel_refract(wo, wm, m->eta, &event.eta_path, &out->wi))
    return false;
  event.wi_wm = vec_dot(out->wi, wm);
  if (out->wi.z == 0 || event.reflects != ((wo.z > 0) == (out->wi.z > 0))) return false;
  event.d = microfacet_d(&m->facets, wm);
  double zo = fabs(wo.z), zi = fabs(out->wi.z);
  double so = microfacet_stretch(&m->facets, wo), si = microfacet_stretch(&m->facets, out->wi);
  out->weight = zi * (so + zo) / (so * zi + si * zo); // G / G1
  out->pdf = dielectric_event_pdf(m, wo, &event);
  out->eta_path = event.eta_path;
  return true;
}

// u: two numbers for the facet, one to choose between reflection and refraction. False: the facet
// sends the path to the side where it cannot go on.
static inline bool dielectric_sample(const struct dielectric *m, struct vec wo, const double u[3],
                                     enum transport transport, struct dielectric_sample *out) {
  if (m->facets.smooth ? !dielectric_sample_smooth(m, wo, u[2], out)
                       : !dielectric_sample_rough(m, wo, u, out))
    return false;
  if (transport == TRANSPORT_RADIANCE) out->weight /= out->eta_path * out->eta_path;
  return true;
}

#endif
