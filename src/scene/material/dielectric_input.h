// The index of refraction of a dielectric as a scene file gives it.
#ifndef SCENE_MATERIAL_DIELECTRIC_INPUT_H
#define SCENE_MATERIAL_DIELECTRIC_INPUT_H

#include "scene/material/metal.h"
#include "scene/read.h"

// A float, a named glass, or a spectrum, of which the luminance is what counts: one path cannot be
// refracted in three directions. Default 1.5.
static inline double dielectric_read_eta(struct scene_builder *builder, struct params *params,
                                         const char *name) {
  double eta = 1.5, rgb[3];
  const struct param *param = NULL;
  for (int i = 0; i < params->count; i++)
    if (!strcmp(params->item[i].name, name)) param = &params->item[i];
  bool spectrum = param && strcmp(param->type, "float");
  const double *glass = spectrum && !strcmp(param->type, "spectrum") && param->string
                            ? glass_find(param->string[0])
                            : NULL;
  if (glass && params_any(params, name)) {
    eta = *glass;
  } else if (!spectrum) {
    eta = params_float(params, name, eta);
  } else if (spectrum_read(builder, params, name, SPECTRUM_UNBOUNDED, rgb)) {
    eta = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  }
  if (!(eta > 0)) params_complain(params, name, "\"%s\" must be above 0, and is %g", name, eta);
  return eta;
}

#endif
