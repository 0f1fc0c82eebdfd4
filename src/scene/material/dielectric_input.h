// The index of refraction of a dielectric as a scene file gives it.
#ifndef SCENE_MATERIAL_DIELECTRIC_INPUT_H
#define SCENE_MATERIAL_DIELECTRIC_INPUT_H

#include "scene/read.h"

#include <string.h>

// A float [1.5], a spectrum ("glass-BK7"), or rgb, of which the luminance counts: one path cannot
// be refracted in three directions.
static inline double dielectric_read_eta(struct scene_builder *builder, struct params *params,
                                         const char *name) {
  double eta = 1.5, rgb[3];
  bool is_rgb = false;
  for (int i = 0; i < params->count; i++)
    is_rgb |= !strcmp(params->item[i].name, name) && !strcmp(params->item[i].type, "rgb");
  if (is_rgb && spectrum_read(builder, params, name, SPECTRUM_UNBOUNDED, rgb))
    eta = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  else if (!is_rgb && !spectrum_read_index(builder, params, name, &eta))
    eta = params_float(params, name, eta);
  if (!(eta >= 1e-3 && eta <= 1e3)) // no matter has such, and its powers must be finite
    params_complain(params, name, "\"%s\" must be in [0.001, 1000], and is %g", name, eta);
  return eta;
}

#endif
