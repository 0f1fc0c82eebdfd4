// Participating media: what fills the space between surfaces (MakeNamedMedium of pbrt-v4). A slot:
// one file each in medium/, whose last definition is its row.
//   sigma_a, sigma_s  absorbed and scattered per length [1 / scene unit]; sigma_t their sum
//   emission          sigma_a times the emitted radiance L_e [W sr^-1 m^-2 / scene unit]
// What is scattered goes by the phase function of Henyey and Greenstein (1941).
#ifndef SCENE_MEDIUM_H
#define SCENE_MEDIUM_H

#include "scene/bsdf.h"
#include "scene/ray.h"

#include <stdint.h>
#include <stdio.h>

#define MEDIUM_NONE UINT32_MAX // a vacuum

struct scene_builder;
struct params;

struct medium {
  const struct medium_type *type;
  const void *data; // the type's own
  const char *name; // of MakeNamedMedium
  double g;         // mean cosine of scattering, in (-1, 1)
};

// At one point.
struct medium_point {
  double sigma_a[3], sigma_s[3], emission[3];
};

struct medium_type {
  const char *name, *about; // name as in `MakeNamedMedium "x" "string type" "name"`
  bool uniform;             // the same everywhere: `at` looks at no position
  // Fills data and g; the transformation is the current one of MakeNamedMedium.
  bool (*read)(struct scene_builder *, struct params *, struct medium *);
  void (*at)(const struct medium *, struct vec p, struct medium_point *);
  // The piece of the ray (d of unit length) that begins at t: up to *end > t, sigma_t is at most
  // *majorant in every channel. False: there is nothing of it from t on.
  bool (*piece)(const struct medium *, const struct ray *, double t, double *end, double *majorant);
  bool (*is_gray)(const struct medium *);
  // For `photonlab info`: each value the largest anywhere; further lines of the type's own, or NULL.
  void (*peak)(const struct medium *, struct medium_point *);
  void (*say)(const struct medium *, FILE *);
};

// The phase function as a bsdf: value and pdf in 1/sr, of all light that is scattered; no normal
// and no cosine (bsdf.volume). weight of its samples is 1.
struct bsdf medium_bsdf(const struct medium *);

extern const struct medium_type *const medium_types[]; // NULL-terminated

// Measured ones, by name.
struct medium_preset {
  const char *name;
  double sigma_s[3], sigma_a[3]; // 1 / mm
};
extern const struct medium_preset medium_presets[];
extern const int n_medium_presets;

#endif
