// Camera "perspective": `float fov` [90] degrees across the shorter axis.
#include "numeric/elementary.h"
#include "scene/scene.h"

static bool read(struct camera *camera, struct params *params) {
  camera->fov = params_float(params, "fov", 90);
  if (!(camera->fov > 0 && camera->fov < 180))
    params_complain(params, "fov", "fov must be between 0 and 180 degrees");
  return !params->problem->text[0];
}

// The window at z = 1 is the screen window times tan(fov / 2).
static void set_window(struct camera *camera, const double screen[4]) {
  double sine, cosine;
  num_sincos_turns(camera->fov / 720, &sine, &cosine);
  double scale = sine / cosine;
  for (int k = 0; k < 4; k++) camera->window[k] = screen[k] * scale;
}

static void ray(const struct camera *camera, double x, double y, struct vec *o, struct vec *d) {
  (void)camera;
  *o = vec(0, 0, 0);
  *d = vec(x, y, 1);
}

// A sphere's element seen from the centre, onto the plane z = 1.
static bool find(const struct camera *camera, struct vec p, double xy[2], struct vec *flow) {
  (void)camera;
  if (!(p.z > 0)) return false;
  xy[0] = p.x / p.z, xy[1] = p.y / p.z;
  *flow = vec_scale(p, 1 / (p.z * p.z * p.z));
  return true;
}

const struct camera_type camera_perspective = {
    .name = "perspective",
    .about = "a pinhole or thin lens, fov across the shorter axis",
    .has_lens = true,
    .read = read,
    .set_window = set_window,
    .ray = ray,
    .find = find,
};
