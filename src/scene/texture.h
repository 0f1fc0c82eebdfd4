// Textures, and the inputs of materials, shapes and lights: a constant or a texture.
#ifndef SCENE_TEXTURE_H
#define SCENE_TEXTURE_H

#include "pbrt/params.h"

#include <stdbool.h>

struct scene_builder;
struct surface;

struct texture {
  const struct texture_type *type;
  const void *data; // the type's own
};

struct texture_type {
  const char *name, *about; // as in `Texture "n" "spectrum" "name"`
  // `spectrum`: of that kind, else of floats. builder->world_from_object is texture space.
  bool (*read)(struct scene_builder *, struct params *, bool spectrum, struct texture *);
  // At p, uv and ng (and nothing else) of the surface. Floats: three equal values.
  void (*evaluate)(const struct texture *, const struct surface *, double value[3]);
  bool (*is_gray)(const struct texture *);
};

// What a parameter says: `"rgb reflectance" [...]` or `"texture reflectance" "wood"`.
struct input {
  const struct texture *texture; // NULL: the constant
  double value[3];               // floats: three equal values
};

static inline void input_rgb(const struct input *input, const struct surface *surface,
                             double rgb[3]) {
  if (input->texture) {
    input->texture->type->evaluate(input->texture, surface, rgb);
    return;
  }
  for (int c = 0; c < 3; c++) rgb[c] = input->value[c];
}

static inline double input_float(const struct input *input, const struct surface *surface) {
  double value[3];
  input_rgb(input, surface, value);
  return value[0];
}

bool input_is_gray(const struct input *);

// What a spectrum is converted to linear sRGB for (src/spectrum).
enum spectrum_use {
  SPECTRUM_ALBEDO,     // reflectance, transmittance: in [0, 1], checked
  SPECTRUM_UNBOUNDED,  // eta, k, coefficients: not negative, checked
  SPECTRUM_ILLUMINANT, // emission: what is not rgb is normalised to luminance 1
};

// The parameter, if it is there; else the fallback (input_read_*) or false (spectrum_read).
// Complaints go to params. `texture` is taken from the textures named so far.
struct input input_read_float(struct scene_builder *, struct params *, const char *name,
                              double fallback);
struct input input_read_spectrum(struct scene_builder *, struct params *, const char *name,
                                 enum spectrum_use, const double fallback[3]);
bool input_is_given(const struct params *, const char *name);
// A spectrum that cannot be a texture (lights): rgb, a named or sampled spectrum, blackbody.
bool spectrum_read(struct scene_builder *, struct params *, const char *name, enum spectrum_use,
                   double rgb[3]);
// The eta and k of a metal, which are converted together where both are sampled. False: neither is
// there.
bool spectrum_read_metal(struct scene_builder *, struct params *, const char *eta_name,
                         const char *k_name, double eta[3], double k[3]);
// An index of refraction given as a spectrum (`"spectrum eta" "glass-BK7"`): one number. False: it
// is not there, or not a spectrum.
bool spectrum_read_index(struct scene_builder *, struct params *, const char *name, double *eta);

#endif
