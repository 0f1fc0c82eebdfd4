// Scattering at one point of a surface: a material with its textures looked up.
// A bsdf_type works in the shading frame: z along the shading normal, x along dpdu, directions of
// unit length away from the surface. `wo` is where the path came from. As in pbrt-v4 it is the
// signs of z, not the geometric normal, that tell reflection from transmission. Radiance: wo is
// towards the eye, and transmission into eta divides by eta^2. Importance: wo is towards the light
// (photons); nothing is divided (Veach 1997, ch. 5).
#ifndef SCENE_BSDF_H
#define SCENE_BSDF_H

#include "base/vec.h"

#include <math.h>
#include <stdbool.h>

enum transport { TRANSPORT_RADIANCE, TRANSPORT_IMPORTANCE };
enum { BSDF_NUMBERS = 16 };

struct bsdf {
  const struct bsdf_type *type; // NULL: scatters nothing
  const void *data;             // the material's own
  struct vec s, t, n;           // shading frame, right-handed, world space
  struct vec ng;
  bool bent;              // n is not ng
  bool volume;            // a phase function: it has no normal
  double u;               // in [0, 1), of this vertex alone: what a random material draws from
  double x[BSDF_NUMBERS]; // the type's own, undefined where it reads none: reflectance, eta, ...
};

struct bsdf_sample {
  struct vec wi;
  double weight[3]; // f |cos| / pdf; |cos| at the shading normal
  double pdf;       // solid angle; 0: a delta lobe
  double eta2;      // weight * eta2 is free of the scaling of radiance by refraction; 1 otherwise
};

struct bsdf_type {
  // f = x / pi where wo and wi are on one side, sampled by the cosine; of the frame it reads n
  // alone.
  bool lambert;
  // f(wo, wi) in 1/sr per channel, without delta lobes; wo.z and wi.z are not 0.
  void (*value)(const struct bsdf *, struct vec wo, struct vec wi, enum transport, double f[3]);
  // value depends on the sides of wo and wi alone.
  bool by_side;
  // The density with which `sample` gives wi, without delta lobes: integrates to 1 minus
  // delta_probability (or less, where sample returns false).
  double (*pdf)(const struct bsdf *, struct vec wo, struct vec wi, enum transport);
  // u: two numbers for the direction, u[2] for the lobe. False: absorbed. A delta lobe is taken
  // exactly where u[2] < delta_probability.
  bool (*sample)(const struct bsdf *, struct vec wo, const double u[3], enum transport,
                 struct bsdf_sample *);
  // The probability of a delta lobe; NULL: never one.
  double (*delta_probability)(const struct bsdf *, struct vec wo, enum transport);
};

static inline struct vec bsdf_to_local(const struct bsdf *b, struct vec w) {
  return vec(vec_dot(w, b->s), vec_dot(w, b->t), vec_dot(w, b->n));
}

static inline struct vec bsdf_to_world(const struct bsdf *b, struct vec w) {
  return vec_along(vec_along(vec_scale(b->s, w.x), b->t, w.y), b->n, w.z);
}

// A direction along a surface has no side of it; a medium has no sides.
static inline bool bsdf_is_met(const struct bsdf *b, struct vec local) {
  return b->type && (local.z != 0 || b->volume);
}

// World space from here on.

// Where only n is read the rest of the frame may be missing.
static inline struct vec bsdf_local(const struct bsdf *b, struct vec w) {
  return b->type && b->type->lambert ? vec(0, 0, vec_dot(w, b->n)) : bsdf_to_local(b, w);
}

static inline void bsdf_value(const struct bsdf *b, struct vec wo, struct vec wi,
                              enum transport transport, double f[3]) {
  struct vec o = bsdf_local(b, wo), i = bsdf_local(b, wi);
  f[0] = f[1] = f[2] = 0;
  if (bsdf_is_met(b, o) && bsdf_is_met(b, i)) b->type->value(b, o, i, transport, f);
}

static inline double bsdf_pdf(const struct bsdf *b, struct vec wo, struct vec wi,
                              enum transport transport) {
  struct vec o = bsdf_local(b, wo), i = bsdf_local(b, wi);
  return bsdf_is_met(b, o) && bsdf_is_met(b, i) ? b->type->pdf(b, o, i, transport) : 0;
}

static inline double bsdf_delta_probability(const struct bsdf *b, struct vec wo,
                                            enum transport transport) {
  if (!b->type->delta_probability) return 0;
  return b->type->delta_probability(b, bsdf_to_local(b, wo), transport);
}

// What the radiance from wi is weighed with.
static inline double bsdf_cosine(const struct bsdf *b, struct vec wi) {
  return b->volume ? 1 : fabs(vec_dot(wi, b->n));
}

// A photon that arrives from wi stands for a radiance over |wi.ng|, the measurement weighs it with
// |wi.n|: what the photon's flux is multiplied with where the normals differ (Veach 1997, 5.3).
static inline double bsdf_photon_factor(const struct bsdf *b, struct vec wi) {
  return b->bent ? fabs(vec_dot(wi, b->n)) / fabs(vec_dot(wi, b->ng)) : 1;
}

// False: absorbed. Importance carries the correction for shading normals, |wo.n| |wi.ng| / (|wo.ng|
// |wi.n|) (Veach 1997, 5.3.2).
static inline bool bsdf_sample(const struct bsdf *b, struct vec wo, const double u[3],
                               enum transport transport, struct bsdf_sample *sample) {
  struct vec o = bsdf_to_local(b, wo);
  if (!bsdf_is_met(b, o) || !b->type->sample(b, o, u, transport, sample)) return false;
  sample->wi = bsdf_to_world(b, sample->wi);
  if (b->bent && transport == TRANSPORT_IMPORTANCE) {
    double factor = bsdf_photon_factor(b, wo) / bsdf_photon_factor(b, sample->wi);
    for (int c = 0; c < 3; c++) sample->weight[c] *= factor;
  }
  return true;
}

#endif
