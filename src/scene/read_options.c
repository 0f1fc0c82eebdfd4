// Directives before WorldBegin that say how to render.
#include "scene/reader.h"

#include <limits.h>
#include <string.h>

static bool is_one_of(const char *name, const char *const *names, int n) {
  for (int i = 0; i < n; i++)
    if (strcmp(name, names[i]) == 0) return true;
  return false;
}
#define IS_ONE_OF(name, names) is_one_of(name, names, (int)(sizeof(names) / sizeof *(names)))

static bool wrong_type(struct reader *reader, const struct call *call, const char *advice) {
  return problem_at(reader->problem, call->type_place, "%s \"%s\" is not in this version; %s",
                    call->name, call->type, advice);
}

void read_default_options(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  scene->settings = (struct scene_settings){.filename = NULL,
                                            .max_depth = 5,
                                            .spp = 16,
                                            .exposure = 1,
                                            .radius = NAN,
                                            .alpha = NAN,
                                            .seed = -1};
  reader->sampler_seed = reader->option_seed = -1;
  reader->transform_times[END] = 1;
  read_default_film(reader);
}

// What no file can say: its integers are at most 2^53.
static const int64_t absent = INT64_MIN;

static int64_t read_at_least(struct params *params, const char *name, int64_t least,
                             int64_t fallback) {
  int64_t value = params_integer(params, name, absent);
  if (value == absent) return fallback;
  if (value < least) params_complain(params, name, "%s must be at least %d", name, (int)least);
  return value;
}

// A jittered grid is a random position in the pixel to us; without jitter, 1 x 1 is the centre.
static void read_stratified(struct params *params, struct scene_settings *settings) {
  int64_t x = read_at_least(params, "xsamples", 1, 4), y = read_at_least(params, "ysamples", 1, 4);
  if (x > INT_MAX || y > INT_MAX) {
    params_complain(params, "xsamples", "xsamples and ysamples must be less than 2^31");
    return;
  }
  settings->spp = x * y;
  settings->centre = !params_bool(params, "jitter", true);
  if (settings->centre && settings->spp != 1)
    params_complain(params, "jitter",
                    "without jitter xsamples and ysamples must be 1: the pixel's centre");
}

bool read_sampler(struct reader *reader, struct call *call) {
  static const char *const known[] = {"halton", "independent", "paddedsobol", "pmj02bn",
                                      "sobol",  "stratified",  "zsobol"};
  struct params *params = &call->params;
  struct scene_settings *settings = &reader->builder.scene->settings;
  if (!read_only_once(reader, call, &reader->sampler)) return false;
  if (!IS_ONE_OF(call->type, known)) return wrong_type(reader, call, "use \"independent\"");
  if (strcmp(call->type, "stratified") == 0)
    read_stratified(params, settings);
  else
    settings->spp = read_at_least(params, "pixelsamples", 1, 16);
  params_string(params, "randomization", NULL); // our numbers are always independent
  reader->sampler_seed = read_at_least(params, "seed", 0, -1);
  return params_finish(params);
}

// pbrt's integrators that all converge to the same image, our path tracer's.
static bool is_unbiased(const char *name) {
  static const char *const known[] = {"bdpt",       "lightpath",  "mlt",           "path",
                                      "randomwalk", "simplepath", "simplevolpath", "volpath"};
  return IS_ONE_OF(name, known);
}

// pbrt's integrators of other quantities, for `render` to refuse: an experiment has its own, so
// what they read does not matter.
static bool is_of_another_quantity(const char *name) {
  static const char *const known[] = {"ambientocclusion", "function"};
  return IS_ONE_OF(name, known);
}

// Parameters of pbrt's that change how, not what.
static void read_pbrt_integrator(struct params *params) {
  params_string(params, "lightsampler", NULL);
  params_bool(params, "samplelights", true);
  params_bool(params, "samplebsdf", true);
  params_bool(params, "visualizestrategies", false); // bdpt: images beside the image
  params_bool(params, "visualizeweights", false);
  static const char *const mlt[] = {"bootstrapsamples", "chains", "mutationsperpixel"};
  for (int i = 0; i < 3; i++) params_integer(params, mlt[i], 0);
  params_float(params, "largestepprobability", 0);
  params_float(params, "sigma", 0);
}

static void read_ranges(struct params *params, struct scene_settings *settings) {
  settings->radius = params_float(params, "radius", NAN);
  if (settings->radius <= 0) params_complain(params, "radius", "the radius must be positive");
  settings->alpha = params_float(params, "alpha", NAN);
  if (settings->alpha < 0 || settings->alpha > 1)
    params_complain(params, "alpha", "alpha must be in [0, 1]");
  int64_t depth = read_at_least(params, "maxdepth", 0, 5);
  if (depth > INT_MAX) params_complain(params, "maxdepth", "maxdepth must be less than 2^31");
  settings->max_depth = (int)depth;
}

static void read_photons(struct params *params, struct scene_settings *settings) {
  int64_t photons = read_at_least(params, "photons", 1, 0),
          pbrt = read_at_least(params, "photonsperiteration", 1, 0);
  if (photons && pbrt)
    params_complain(params, "photons", "photons and photonsperiteration are the same: give one");
  settings->photons = photons ? photons : pbrt;
  settings->iterations = read_at_least(params, "iterations", 1, 0);
}

static void read_names(struct params *params, struct scene_settings *settings) {
  static const char *const ways[] = {"photons", "nee"};
  settings->kernel = params_string(params, "kernel", NULL);
  settings->law = params_string(params, "law", NULL);
  settings->direct = params_string(params, "direct", NULL);
  if (settings->direct && !IS_ONE_OF(settings->direct, ways))
    params_complain(params, "direct", "direct is \"photons\" or \"nee\", not \"%s\"",
                    settings->direct);
}

bool read_integrator(struct reader *reader, struct call *call) {
  struct params *params = &call->params;
  struct scene_settings *settings = &reader->builder.scene->settings;
  if (!read_only_once(reader, call, &reader->integrator)) return false;
  bool unbiased = is_unbiased(call->type);
  settings->integrator = unbiased ? "path" : call->type;
  if (is_of_another_quantity(call->type)) return true;
  read_ranges(params, settings);
  read_photons(params, settings);
  read_names(params, settings);
  settings->seed = read_at_least(params, "seed", 0, -1);
  if (unbiased) read_pbrt_integrator(params);
  if (params_bool(params, "regularize", false))
    params_complain(params, "regularize", "regularize must be false: it changes the image");
  return params_finish(params);
}

// There is one here, and none can change the image.
bool read_accelerator(struct reader *reader, struct call *call) {
  (void)reader, (void)call;
  return true;
}

bool read_color_space(struct reader *reader, struct call *call) {
  if (strcmp(call->type, "srgb") == 0) return true;
  return wrong_type(reader, call, "use \"srgb\"");
}

// Without jitter pbrt sees the pixel's centre through the lens's, when the shutter is half through.
static void fix_eye(struct scene *scene) {
  struct camera *camera = &scene->camera;
  scene->settings.centre = true;
  camera->lens_radius = 0;
  camera->shutter_open = camera->shutter_close =
      camera->shutter_open + (camera->shutter_close - camera->shutter_open) / 2;
}

bool read_finish_options(struct reader *reader) {
  struct scene *scene = reader->builder.scene;
  if (scene->settings.seed < 0) scene->settings.seed = reader->sampler_seed;
  if (scene->settings.seed < 0) scene->settings.seed = reader->option_seed;
  memcpy(scene->motion_time, reader->transform_times, sizeof scene->motion_time);
  if (!read_finish_film(reader)) return false;
  if (reader->no_pixel_jitter) fix_eye(scene);
  return true;
}
