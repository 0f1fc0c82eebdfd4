// Camera "spherical": all directions from a point, +y up. `string mapping` ["equalarea"]: of the
// square film (scene/octahedral.h), or "equirectangular": longitude and latitude.
#include "scene/octahedral.h"
#include "scene/scene.h"

#include <string.h>

static bool read(struct camera *camera, struct params *params) {
  const char *mapping = params_string(params, "mapping", "equalarea");
  camera->equirectangular = strcmp(mapping, "equirectangular") == 0;
  if (!camera->equirectangular && strcmp(mapping, "equalarea") != 0)
    params_complain(params, "mapping",
                    "mapping is \"equalarea\" or \"equirectangular\", not \"%s\"", mapping);
  return !params->problem->text[0];
}

// From 0 to 1, right and down.
static void set_window(struct camera *camera, const double screen[4]) {
  (void)screen;
  const double unit[4] = {0, 1, 1, 0};
  for (int k = 0; k < 4; k++) camera->window[k] = unit[k];
}

static struct vec equirectangular(double u, double v) {
  double sin_phi, cos_phi, sin_theta, cos_theta;
  num_sincos_turns(u, &sin_phi, &cos_phi);
  num_sincos_turns(v / 2, &sin_theta, &cos_theta);
  return vec(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta);
}

// Beyond an edge the square goes on with the same edge, the other way round.
static void wrap(double *across, double *along) {
  if (*across >= 0 && *across <= 1) return;
  *across = *across < 0 ? -*across : 2 - *across;
  *along = 1 - *along;
}

static struct vec equal_area(double s, double t) {
  wrap(&s, &t);
  wrap(&t, &s);
  return octahedral_direction(s, t);
}

static void ray(const struct camera *camera, double x, double y, struct vec *o, struct vec *d) {
  struct vec up = camera->equirectangular ? equirectangular(x, y) : equal_area(x, y);
  *o = vec(0, 0, 0);
  *d = vec(up.x, up.z, up.y);
}

const struct camera_type camera_spherical = {
    .name = "spherical",
    .about = "all directions, by equal areas or longitude and latitude",
    .has_lens = false,
    .read = read,
    .set_window = set_window,
    .ray = ray,
};
