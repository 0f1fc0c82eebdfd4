// Spectra as a scene file gives them: rgb, blackbody, named, sampled in place or in a file.
#include "pbrt/suggest.h"
#include "scene/read.h"
#include "spectrum/spectrum.h"

#include <math.h>
#include <string.h>

static const char *const use_limits[] = {
    [SPECTRUM_ALBEDO] = "must be in [0, 1]",
    [SPECTRUM_UNBOUNDED] = "must not be negative",
    [SPECTRUM_ILLUMINANT] = "must not be negative",
};

static void check_rgb(struct params *params, const char *name, enum spectrum_use use,
                      const double rgb[3]) {
  for (int c = 0; c < 3; c++)
    if (!(rgb[c] >= 0 && (use != SPECTRUM_ALBEDO || rgb[c] <= 1))) {
      params_complain(params, name, "\"%s\" %s, and has %g", name, use_limits[use], rgb[c]);
      return;
    }
}

static const struct param *find_param(const struct params *params, const char *name) {
  for (int i = 0; i < params->count; i++)
    if (!strcmp(params->item[i].name, name)) return &params->item[i];
  return NULL;
}

static bool is_type(const struct param *param, const char *type) {
  return !strcmp(param->type, type);
}

static bool read_blackbody(struct params *params, const char *name, const struct param *param,
                           enum spectrum_use use, double rgb[3]) {
  if (use != SPECTRUM_ILLUMINANT)
    return params_complain(params, name, "\"%s\" is no light: a black body means nothing", name);
  if (param->count != 1)
    return params_complain(params, name, "\"blackbody %s\" needs one temperature", name);
  if (!(param->number[0] > 0))
    return params_complain(params, name, "the temperature must be greater than zero (kelvin)");
  spectrum_blackbody(param->number[0], rgb);
  return true;
}

static bool unknown_name(struct params *params, const char *name, const char *wanted) {
  enum { MAX_NAMES = 64 };
  const char *names[MAX_NAMES];
  int n = 0;
  for (; n < n_named_spectra && n < MAX_NAMES; n++) names[n] = named_spectra[n].name;
  const char *nearest = suggest_name(wanted, names, n);
  return params_complain(params, name, "there is no spectrum \"%s\"%s%s%s", wanted,
                         nearest ? "; did you mean \"" : "", nearest ? nearest : "",
                         nearest ? "\"?" : " (photonlab list spectra; a file has an extension)");
}

// Numbers in place, or those of a file. A name without a dot is not taken for a file's.
static bool read_samples(struct scene_builder *builder, struct params *params, const char *name,
                         const struct param *param, struct spectrum *spectrum) {
  if (param->number) {
    const char *wrong = spectrum_from_numbers(param->number, param->count, spectrum);
    return !wrong || params_complain(params, name, "\"%s\": %s", name, wrong);
  }
  if (param->count != 1)
    return params_complain(params, name, "\"spectrum %s\" needs one name", name);
  struct text text;
  struct problem problem = {0};
  if (!strchr(param->string[0], '.')) return unknown_name(params, name, param->string[0]);
  if (!scene_read_file(builder, params, name, param->string[0], builder->arena, &text))
    return false;
  return spectrum_parse(text, param->string[0], builder->arena, spectrum, &problem) ||
         params_complain(params, name, "%s", problem.text);
}

static const struct named_spectrum *find_named(const struct param *param) {
  return param->string && param->count == 1 ? spectrum_named(param->string[0]) : NULL;
}

static bool convert_named(struct params *params, const char *name,
                          const struct named_spectrum *named, enum spectrum_use use,
                          double rgb[3]) {
  bool light = named->kind == NAMED_ILLUMINANT;
  enum spectrum_use made_for = light ? SPECTRUM_ILLUMINANT : SPECTRUM_UNBOUNDED;
  if (use != made_for)
    return params_complain(params, name, "\"%s\" is %s, and \"%s\" is not", named->name,
                           light ? "a light's spectrum" : "an index of refraction", name);
  memcpy(rgb, named->rgb, sizeof named->rgb);
  return true;
}

static bool convert_samples(struct params *params, const char *name,
                            const struct spectrum *spectrum, enum spectrum_use use, double rgb[3]) {
  if (use == SPECTRUM_ALBEDO) {
    spectrum_albedo(spectrum, rgb);
    for (ptrdiff_t k = 0; k < spectrum->count; k++)
      if (spectrum->sample[k][1] > 1)
        return params_complain(params, name, "\"%s\" %s", name, use_limits[use]);
  } else if (use == SPECTRUM_UNBOUNDED) {
    spectrum_unbounded(spectrum, rgb);
  } else if (!spectrum_illuminant(spectrum, rgb)) {
    return params_complain(params, name, "\"%s\" has no light between 360 and 830 nm", name);
  }
  return true;
}

bool spectrum_read(struct scene_builder *builder, struct params *params, const char *name,
                   enum spectrum_use use, double rgb[3]) {
  const struct param *param = find_param(params, name);
  if (!param || is_type(param, "rgb")) {
    if (!params_rgb(params, name, rgb)) return false;
    check_rgb(params, name, use, rgb);
    return true;
  }
  if (!params_any(params, name)) return false;
  if (is_type(param, "blackbody")) return read_blackbody(params, name, param, use, rgb);
  if (!is_type(param, "spectrum"))
    return params_complain(params, name,
                           "\"%s\" must be of type rgb, spectrum or blackbody, not %s", name,
                           param->type);
  const struct named_spectrum *named = find_named(param);
  if (named) return convert_named(params, name, named, use, rgb);
  struct spectrum spectrum;
  return read_samples(builder, params, name, param, &spectrum) &&
         convert_samples(params, name, &spectrum, use, rgb);
}

static bool is_sampled(const struct param *param) {
  return param && is_type(param, "spectrum") && !find_named(param);
}

bool spectrum_read_metal(struct scene_builder *builder, struct params *params, const char *eta_name,
                         const char *k_name, double eta[3], double k[3]) {
  const struct param *eta_param = find_param(params, eta_name),
                     *k_param = find_param(params, k_name);
  if (!is_sampled(eta_param) || !is_sampled(k_param)) {
    bool has_eta = spectrum_read(builder, params, eta_name, SPECTRUM_UNBOUNDED, eta);
    return spectrum_read(builder, params, k_name, SPECTRUM_UNBOUNDED, k) || has_eta;
  }
  struct spectrum eta_spectrum, k_spectrum;
  if (!params_any(params, eta_name) || !params_any(params, k_name) ||
      !read_samples(builder, params, eta_name, eta_param, &eta_spectrum) ||
      !read_samples(builder, params, k_name, k_param, &k_spectrum))
    return false;
  spectrum_conductor(&eta_spectrum, &k_spectrum, eta, k);
  return true;
}

bool spectrum_read_index(struct scene_builder *builder, struct params *params, const char *name,
                         double *eta) {
  const struct param *param = find_param(params, name);
  if (!param || !is_type(param, "spectrum") || !params_any(params, name)) return false;
  const struct named_spectrum *named = find_named(param);
  double rgb[3];
  struct spectrum spectrum;
  if (named) {
    if (!convert_named(params, name, named, SPECTRUM_UNBOUNDED, rgb)) return false;
    *eta = rgb[1];
    return true;
  }
  if (!read_samples(builder, params, name, param, &spectrum)) return false;
  *eta = spectrum_index(&spectrum);
  return true;
}
