#include "run/picture.h"

struct image picture_new(const struct measurement *measure, struct arena *arena) {
  static const char *const names[] = {"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  const struct camera *camera = &measure->scene->camera;
  return image_new(camera->width, camera->height, 6, names, arena);
}

struct image picture_of(const struct measurement *measure, const struct moments *moments,
                        struct arena *arena) {
  int n_channels = measure->features.n_channels;
  struct image image = picture_new(measure, arena);
  for (long j = 0; j < measure->n_points; j++)
    for (int c = 0; c < 3; c++) {
      struct moments m = moments[j * n_channels + (n_channels == 3 ? c : 0)];
      image.plane[c][j] = (float)m.mean;
      image.plane[3 + c][j] = m.n > 1 ? (float)moments_variance(m) : NAN;
    }
  return image;
}
