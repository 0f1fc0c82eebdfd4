#include "scene/camera.h"

#include "numeric/elementary.h"

void camera_set_window(struct camera *camera) {
  double sine, cosine;
  num_sincos_turns(camera->fov / 720, &sine, &cosine);
  double half = sine / cosine, width = camera->width, height = camera->height;
  camera->half_x = width > height ? half * (width / height) : half;
  camera->half_y = height > width ? half * (height / width) : half;
}

struct ray camera_ray(const struct camera *camera, double x, double y) {
  double u = 2 * x / camera->width - 1, v = 1 - 2 * y / camera->height;
  struct vec d = vec(u * camera->half_x, v * camera->half_y, 1);
  const struct transform *t = &camera->world_from_camera;
  return (struct ray){.o = vec(t->m[0][3], t->m[1][3], t->m[2][3]),
                      .d = vec_normalize(transform_direction(t, d)),
                      .t_max = INFINITY,
                      .leaving = PRIMITIVE_NONE};
}
