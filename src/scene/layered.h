// A base (Lambertian or conductor) under a dielectric coat, with a medium between: pbrt-v4's
// LayeredBxDF, two-sided. Where there is no closed form, f is estimated as pbrt does, by a random
// walk between the two interfaces, drawn from a number of the path vertex and the two directions;
// its expectation is exact up to max_depth. (pbrt-v4's own is not where the coat is rough: it
// weighs the two ways to connect with densities that do not belong together, and is too bright by
// up to 18 %. Its sampling has the right expectation, and so have we.) Sampling does not follow the
// walk but a mixture with a known density: the coat's reflection, the conductor's lobe as seen
// through the coat, and a cosine lobe.
#ifndef SCENE_LAYERED_H
#define SCENE_LAYERED_H

#include "scene/bsdf.h"
#include "scene/coat.h"
#include "scene/material/conductor.h"

struct layered {
  struct dielectric coat;
  bool is_conductor;
  struct conductor conductor;     // its indices over that of the coat
  double reflectance[3];          // or Lambertian
  double thickness, albedo[3], g; // extinction is 1; Henyey-Greenstein
  int max_depth, n_samples;
};

static inline bool layered_has_medium(const struct layered *l) {
  return l->albedo[0] > 0 || l->albedo[1] > 0 || l->albedo[2] > 0;
}

// Smooth on smooth: what is not a delta comes from the medium only.
static inline bool layered_is_smooth(const struct layered *l) {
  return l->is_conductor && l->coat.facets.smooth && l->conductor.facets.smooth;
}

// f without delta lobes; `u`: the vertex's own number.
void layered_value(const struct layered *, struct vec wo, struct vec wi, double u, double f[3]);

// What smooth interfaces alone reflect, as weight of a direction: the coat's reflection, and on a
// smooth conductor the walk's whole series.
void layered_delta(const struct layered *, struct vec wo, double rgb[3]);

double layered_delta_probability(const struct layered *, struct vec wo);
double layered_pdf(const struct layered *, struct vec wo, struct vec wi);
// The direction only; *delta: of the delta lobe. False: none.
bool layered_sample(const struct layered *, struct vec wo, const double u[3], struct vec *wi,
                    bool *delta);

// ---- for layered.c and layered_lobes.c ----

static inline struct vec layered_opposite(struct vec w) { return vec_scale(w, -1); }

static inline double layered_max3(const double a[3]) {
  double ab = a[0] > a[1] ? a[0] : a[1];
  return ab > a[2] ? ab : a[2];
}

static inline struct vec layered_cosine_direction(const double u[2]) {
  double r = sqrt(u[0]), sine, cosine;
  num_sincos_turns(u[1], &sine, &cosine);
  return vec(r * cosine, r * sine, sqrt(1 - u[0]));
}

#endif
