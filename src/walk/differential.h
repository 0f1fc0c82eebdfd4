// How an eye path changes with the position in its pixel: ray differentials (Igehy 1999), carried
// from the camera through transfers and specular bounces. All derivatives are per pixel, in x and
// y.
#ifndef WALK_DIFFERENTIAL_H
#define WALK_DIFFERENTIAL_H

#include "scene/scene.h"

struct differential {
  struct vec p[2], d[2];               // of where the path is, and of its direction
  struct vec camera_p[2], camera_d[2]; // the same at its start
  double length;                       // of the path
};

// Through (x, y) and a point of the lens, as of camera_ray.
struct differential differential_of_camera(const struct camera *, double x, double y,
                                           const double u[2]);

// Along d (unit length) from `from` to a surface.
void differential_transfer(struct differential *, struct vec from, struct vec d,
                           const struct surface *);

// At a mirror, or between two media where eta = sqrt(eta2) is the index on the side of wi over that
// of the other: the path came along d and goes on along wi. n: the shading normal.
void differential_scatter(struct differential *, const struct scene *, const struct surface *,
                          struct vec n, struct vec d, struct vec wi, double eta2);

// The pixel's width where the path is: the root mean square of the lengths of the derivatives in x
// and y, the same for any rotation of the film. On the surface, through all bounces; 0 or infinite
// where all rays of the pixel meet or are parallel to the surface.
double differential_footprint(const struct differential *);

// The same across a straight ray as long as the path: its length times the pixel's angle, if the
// rays begin in one point.
double differential_across(const struct differential *);

#endif
