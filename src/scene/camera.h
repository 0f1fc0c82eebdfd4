// What the reader makes of Camera and Film.
#ifndef SCENE_CAMERA_H
#define SCENE_CAMERA_H

#include "scene/scene.h"

const struct camera_type *camera_find(const char *name); // NULL: none

// pbrt's default screen window x0 x1 y0 y1: the shorter axis spans [-1, 1].
void camera_screen(double aspect, double screen[4]);

// The inverse of camera_ray, for cameras whose type has `find`.
struct camera_finder {
  const struct camera *camera;
  struct transform camera_from_world;
  double scale; // pixels^2 of the film per area of the window, times volume in camera space per
                // world's
};
struct camera_finder camera_finder(const struct camera *);

// The ray that meets a point of the scene.
struct sight {
  double x, y;     // continuous pixel coordinates of the image, or beside it
  struct vec o, d; // d of unit length
  double distance;
  double density; // pixels^2 of the film per area of a surface at the point that faces the ray
};
// Through the point of the lens that u[2] is to camera_ray. False: no ray does.
bool camera_find_point(const struct camera_finder *, struct vec p, const double u[2],
                       struct sight *);

#endif
