#include "scene/camera.h"

#include "numeric/elementary.h"

#include <assert.h>
#include <string.h>

const struct camera_type *camera_find(const char *name) {
  for (int k = 0; camera_types[k]; k++)
    if (!strcmp(camera_types[k]->name, name)) return camera_types[k];
  return NULL;
}

void camera_screen(double aspect, double screen[4]) {
  double x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
  screen[0] = -x, screen[1] = x;
  screen[2] = -y, screen[3] = y;
}

static struct vec lens_point(const struct camera *camera, const double u[2]) {
  double sine, cosine, r = u ? camera->lens_radius * sqrt(u[0]) : 0;
  num_sincos_turns(u ? u[1] : 0, &sine, &cosine);
  return vec(r * cosine, r * sine, 0);
}

// All rays through one point of the film meet in the plane z = focal_distance.
static void through_lens(const struct camera *camera, const double u[2], struct vec *o,
                         struct vec *d) {
  struct vec focus = vec_along(*o, *d, camera->focal_distance / d->z);
  *o = lens_point(camera, u);
  *d = vec_sub(focus, *o);
}

struct ray camera_ray(const struct camera *camera, double x, double y, const double u[2]) {
  double s = (x + camera->crop_x) / camera->full_width,
         t = (y + camera->crop_y) / camera->full_height;
  const double *w = camera->window;
  struct vec o, d;
  camera->type->ray(camera, w[0] + s * (w[1] - w[0]), w[3] - t * (w[3] - w[2]), &o, &d);
  if (camera->lens_radius > 0) through_lens(camera, u, &o, &d);
  o = transform_point(&camera->world_from_camera, o);
  d = vec_normalize(transform_direction(&camera->world_from_camera, d));
  return (struct ray){o, d, INFINITY, PRIMITIVE_NONE};
}

struct camera_finder camera_finder(const struct camera *camera) {
  const double *w = camera->window;
  struct camera_finder finder = {.camera = camera};
  bool regular = transform_invert(camera->world_from_camera, &finder.camera_from_world);
  assert(regular);
  (void)regular;
  finder.scale = (double)camera->full_width * camera->full_height /
                 fabs((w[1] - w[0]) * (w[3] - w[2])) *
                 fabs(transform_determinant(finder.camera_from_world));
  return finder;
}

// The point of the plane in focus on the ray from `lens` to p says which of the film. An element at
// p covers there what perspective from `lens` makes of it.
static bool find_through_lens(const struct camera *camera, struct vec p, struct vec lens,
                              double xy[2], struct vec *flow) {
  struct vec d = vec_sub(p, lens), on_focus;
  if (!(d.z > 0)) return false;
  double enlarged = camera->focal_distance / d.z;
  if (!camera->type->find(camera, vec_along(lens, d, enlarged), xy, &on_focus)) return false;
  *flow = vec_scale(d, fabs(on_focus.z) * enlarged * enlarged / d.z);
  return true;
}

bool camera_find_point(const struct camera_finder *finder, struct vec p, const double u[2],
                       struct sight *sight) {
  const struct camera *camera = finder->camera;
  const double *w = camera->window;
  double xy[2];
  struct vec flow, at = transform_point(&finder->camera_from_world, p), o;
  if (camera->lens_radius > 0) {
    o = lens_point(camera, u);
    if (!find_through_lens(camera, at, o, xy, &flow)) return false;
  } else {
    if (!camera->type->find(camera, at, xy, &flow)) return false;
    struct vec d;
    camera->type->ray(camera, xy[0], xy[1], &o, &d);
  }
  sight->x = (xy[0] - w[0]) / (w[1] - w[0]) * camera->full_width - camera->crop_x;
  sight->y = (w[3] - xy[1]) / (w[3] - w[2]) * camera->full_height - camera->crop_y;
  sight->o = transform_point(&camera->world_from_camera, o);
  struct vec along = vec_sub(p, sight->o);
  sight->distance = vec_length(along);
  sight->d = vec_scale(along, 1 / sight->distance);
  flow = transform_direction(&camera->world_from_camera, flow);
  sight->density = vec_length(flow) * finder->scale;
  return true;
}
