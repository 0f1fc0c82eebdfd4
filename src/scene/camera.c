#include "scene/camera.h"

#include "numeric/elementary.h"

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

// All rays through one point of the film meet in the plane z = focal_distance.
static void through_lens(const struct camera *camera, const double u[2], struct ray *ray) {
  double sine, cosine, r = u ? camera->lens_radius * sqrt(u[0]) : 0;
  num_sincos_turns(u ? u[1] : 0, &sine, &cosine);
  struct vec focus = vec_along(ray->o, ray->d, camera->focal_distance / ray->d.z);
  ray->o = vec(r * cosine, r * sine, 0);
  ray->d = vec_sub(focus, ray->o);
}

struct ray camera_ray(const struct camera *camera, double x, double y, const double u[2]) {
  double s = (x + camera->crop_x) / camera->full_width,
         t = (y + camera->crop_y) / camera->full_height;
  const double *w = camera->window;
  struct ray ray = camera->type->ray(camera, w[0] + s * (w[1] - w[0]), w[3] - t * (w[3] - w[2]));
  if (camera->lens_radius > 0) through_lens(camera, u, &ray);
  ray.o = transform_point(&camera->world_from_camera, ray.o);
  ray.d = vec_normalize(transform_direction(&camera->world_from_camera, ray.d));
  return ray;
}
