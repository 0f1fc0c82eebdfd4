#include "scene/camera.h"

void camera_set_window(struct camera *camera) {
  double aspect = (double)camera->full_width / camera->full_height;
  double x = aspect > 1 ? aspect : 1, y = aspect > 1 ? 1 : 1 / aspect;
  double scale = camera->type->window_scale(camera);
  const double window[4] = {-x * scale, x * scale, -y * scale, y * scale};
  for (int k = 0; k < 4; k++) camera->window[k] = window[k];
}

struct ray camera_ray(const struct camera *camera, double x, double y, const double u[2]) {
  (void)u;
  double s = (x + camera->crop_x) / camera->full_width, t = (y + camera->crop_y) / camera->full_height;
  const double *w = camera->window;
  struct ray ray =
      camera->type->ray(camera, w[0] + s * (w[1] - w[0]), w[3] - t * (w[3] - w[2]));
  ray.o = transform_point(&camera->world_from_camera, ray.o);
  ray.d = vec_normalize(transform_direction(&camera->world_from_camera, ray.d));
  return ray;
}
