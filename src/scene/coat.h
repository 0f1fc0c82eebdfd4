// A dielectric interface, smooth or of Trowbridge-Reitz microfacets, as the coat of a base below it
// (pbrt-v4's layered materials). z < 0 is inside, between coat and base, where `thickness` optical
// depths attenuate what goes straight through: exp(-thickness / |cos|), as pbrt has it even where
// nothing scatters. Transmission is that of importance, from outside to inside; a path in and out
// carries one division by eta^2 in either direction, which is the caller's.
#ifndef SCENE_COAT_H
#define SCENE_COAT_H

#include "base/arena.h"
#include "numeric/elementary.h"
#include "scene/material/dielectric.h"

static inline double coat_attenuation(double depth, double cosine) {
  return depth > 0 ? num_exp(-depth / fabs(cosine)) : 1;
}

// Of rough coats: f, and the density with which coat_sample_transmission takes `inside`.
double coat_transmission(const struct dielectric *, struct vec outside, struct vec inside,
                         double *pdf);

// Smooth or rough: a direction on the same side, or on the other, and f |cos| / pdf. False: none.
bool coat_sample_reflection(const struct dielectric *, struct vec w, const double u[2],
                            struct vec *out, double *weight);
bool coat_sample_transmission(const struct dielectric *, struct vec w, const double u[2],
                              struct vec *out, double *weight);

// ---- what a Lambertian base receives ----
// t(w): of what arrives from w, the fraction that reaches the base. K: of what a Lambertian base
// sends up, the fraction that the coat sends back to it. With them a base of reflectance R under
// the coat is f = R / (pi eta^2) t(wo) t(wi) (1 + R K + (R K)^2 + ...).
// By quadrature t is within 5e-5 of itself, K within 1e-4; interpolated by cubics, t within 5e-4
// for alpha in [0.01, 1] (1e-4 below 0.5 where the roughness is constant), 1e-3 of 1 elsewhere.
double coat_entering(const struct dielectric *, double thickness, struct vec w);
double coat_returned(const struct dielectric *, double thickness);

enum coat_axis { COAT_AXIS_NONE, COAT_AXIS_AZIMUTH, COAT_AXIS_ALPHA };

struct coat_table {
  double eta, thickness;
  enum coat_axis axis; // of the rows
  int n_rows;
  double *entering; // [n_rows][COAT_COSINES]
  double *returned; // [n_rows], of one alpha only [1]
};
enum { COAT_COSINES = 65, COAT_AZIMUTHS = 17, COAT_ALPHAS = 41, COAT_ALPHA_MAX = 4 };

// For one coat, or for all isotropic ones of this eta. eta > 1: total reflection from outside would
// put an edge into t.
struct coat_table coat_table_one(struct arena *, const struct dielectric *, double thickness);
struct coat_table coat_table_alphas(struct arena *, double eta, double thickness);

double coat_table_entering(const struct coat_table *, const struct dielectric *, struct vec w);
double coat_table_returned(const struct coat_table *, const struct dielectric *);

#endif
