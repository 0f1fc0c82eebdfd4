// Camera "orthographic": parallel rays along +z, from the screen window at z = 0. With a lens all
// rays start on the lens, as in pbrt-v4, which puts it around the origin for every pixel.
#include "scene/scene.h"

static bool read(struct camera *camera, struct params *params) {
  (void)camera;
  return !params->problem->text[0];
}

static void set_window(struct camera *camera, const double screen[4]) {
  for (int k = 0; k < 4; k++) camera->window[k] = screen[k];
}

static void ray(const struct camera *camera, double x, double y, struct vec *o, struct vec *d) {
  (void)camera;
  *o = vec(x, y, 0);
  *d = vec(0, 0, 1);
}

static bool find(const struct camera *camera, struct vec p, double xy[2], struct vec *flow) {
  (void)camera;
  xy[0] = p.x, xy[1] = p.y;
  *flow = vec(0, 0, 1);
  return p.z > 0;
}

const struct camera_type camera_orthographic = {
    .name = "orthographic",
    .about = "parallel rays through the screen window",
    .has_lens = true,
    .read = read,
    .set_window = set_window,
    .ray = ray,
    .find = find,
};
