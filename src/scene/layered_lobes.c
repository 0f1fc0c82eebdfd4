// Delta lobes and sampling of layered.h.
#include "scene/layered.h"

static const double one_over_pi = 0x1.45f306dc9c883p-2;
static const struct vec normal = {0, 0, 1};

// F + T^2 r (1 + F r + (F r)^2 + ...), r = what the conductor and the way to it and back leave,
// with as many terms as the walk may leave the coat.
void layered_delta(const struct layered *l, struct vec wo, double rgb[3]) {
  double cosine = fabs(wo.z), fresnel = fresnel_dielectric(cosine, l->coat.eta);
  for (int c = 0; c < 3; c++) rgb[c] = fresnel;
  if (!layered_is_smooth(l) || !(fresnel < 1)) return;
  double inside = sqrt(fresnel_snell(cosine, l->coat.eta)) / l->coat.eta;
  double through = coat_attenuation(l->thickness, inside);
  double r[3];
  conductor_fresnel(&l->conductor, inside, through * through, r);
  for (int c = 0; c < 3; c++) {
    double term = (1 - fresnel) * (1 - fresnel) * r[c];
    for (int i = 0; i < l->max_depth / 2 && rgb[c] + term > rgb[c]; i++) {
      rgb[c] += term;
      term *= fresnel * r[c];
    }
  }
}

// ---- sampling ----

// The lobes in the order of u[2]: reflection of the coat, conductor, cosine.
struct lobes {
  double coat, conductor, cosine; // probabilities
};

// Of what the coat reflects at wo only half is taken from the base, so that the base is sampled at
// grazing angles and under total reflection too.
static double inside_share(const struct layered *l, double fresnel) {
  double base[3] = {l->reflectance[0], l->reflectance[1], l->reflectance[2]};
  if (l->is_conductor) conductor_fresnel(&l->conductor, 1, 1, base);
  double reflected = layered_max3(base), scattered = layered_max3(l->albedo);
  return (1 - fresnel / 2) * (reflected > scattered ? reflected : scattered);
}

static struct lobes lobes_of(const struct layered *l, struct vec wo) {
  if (layered_is_smooth(l)) { // the medium in the last lobe, all smooth paths in the first
    double medium = layered_has_medium(l) ? 1 - coat_attenuation(2 * l->thickness, 1) : 0;
    return (struct lobes){.coat = 1 - medium / 2, .cosine = medium / 2};
  }
  double fresnel = fresnel_dielectric(fabs(wo.z), l->coat.eta);
  double inside = inside_share(l, fresnel);
  if (!(fresnel + inside > 0)) return (struct lobes){.coat = 1};
  struct lobes lobes = {.coat = fresnel / (fresnel + inside)};
  double rest = 1 - lobes.coat;
  lobes.conductor = l->is_conductor ? 0.75 * rest : 0;
  lobes.cosine = rest - lobes.conductor;
  return lobes;
}

double layered_delta_probability(const struct layered *l, struct vec wo) {
  return l->coat.facets.smooth ? lobes_of(l, wo).coat : 0;
}

// A rough coat bends at the way in and out: with slope m by about (eta - 1) m outside; a
// conductor's slope turns the path by 2 eta m. The lobe is taken as that of facets seen from
// outside.
static struct microfacet conductor_lobe(const struct layered *l) {
  double eta = l->coat.eta, bend = (eta - 1) * (eta - 1);
  const struct microfacet *base = &l->conductor.facets, *coat = &l->coat.facets;
  double bx = eta * base->alpha_x, by = eta * base->alpha_y; // 0 where smooth
  double cx = coat->alpha_x, cy = coat->alpha_y;
  struct microfacet m =
      microfacet_of(sqrt(bx * bx + bend * cx * cx), sqrt(by * by + bend * cy * cy));
  return m.smooth ? microfacet_of(1e-3, 1e-3) : m; // the narrowest that is no delta
}

static double facets_pdf(const struct microfacet *facets, struct vec wo, struct vec wi) {
  struct vec m = vec_normalize(vec_add(wo, wi));
  return microfacet_pdf(facets, wo, m) / (4 * vec_dot(wo, m));
}

static bool into_coat(const struct layered *l, struct vec w, struct vec *up) {
  double eta_path;
  struct vec in;
  if (!fresnel_refract(w, normal, l->coat.eta, &eta_path, &in)) return false;
  *up = layered_opposite(in);
  return true;
}

// Through a smooth coat the lobe is exact: solid angles change by cos / (eta^2 cos inside).
static double lobe_pdf(const struct layered *l, struct vec wo, struct vec wi) {
  if (!l->coat.facets.smooth) {
    struct microfacet facets = conductor_lobe(l);
    return facets_pdf(&facets, wo, wi);
  }
  struct vec o, i;
  if (!into_coat(l, wo, &o) || !into_coat(l, wi, &i)) return 0;
  return conductor_pdf(&l->conductor, o, i) * wi.z / (l->coat.eta * l->coat.eta * i.z);
}

static bool lobe_direction(const struct layered *l, struct vec wo, const double u[2],
                           struct vec *wi) {
  if (!l->coat.facets.smooth) {
    struct microfacet facets = conductor_lobe(l);
    *wi = fresnel_reflect(wo, microfacet_sample(&facets, wo, u));
    return true;
  }
  struct vec o, up;
  double eta_path;
  if (!into_coat(l, wo, &o)) return false;
  up = fresnel_reflect(o, microfacet_sample(&l->conductor.facets, o, u));
  return up.z > 0 && fresnel_refract(layered_opposite(up), normal, l->coat.eta, &eta_path, wi);
}

double layered_pdf(const struct layered *l, struct vec wo, struct vec wi) {
  if ((wo.z > 0) != (wi.z > 0)) return 0;
  if (wo.z < 0) {
    wo = layered_opposite(wo);
    wi = layered_opposite(wi);
  }
  struct lobes lobes = lobes_of(l, wo);
  double pdf = lobes.cosine * wi.z * one_over_pi;
  if (!l->coat.facets.smooth) pdf += lobes.coat * facets_pdf(&l->coat.facets, wo, wi);
  if (lobes.conductor > 0) pdf += lobes.conductor * lobe_pdf(l, wo, wi);
  return pdf;
}

bool layered_sample(const struct layered *l, struct vec wo, const double u[3], struct vec *wi,
                    bool *delta) {
  bool below = wo.z < 0;
  struct vec o = below ? layered_opposite(wo) : wo, i;
  struct lobes lobes = lobes_of(l, o);
  *delta = false;
  if (u[2] < lobes.coat) {
    *delta = l->coat.facets.smooth;
    i = fresnel_reflect(o, *delta ? normal : microfacet_sample(&l->coat.facets, o, u));
  } else if (u[2] < lobes.coat + lobes.conductor) {
    if (!lobe_direction(l, o, u, &i)) return false;
  } else {
    i = layered_cosine_direction(u);
  }
  *wi = below ? layered_opposite(i) : i;
  return i.z > 0;
}
