// What sphere, disk and cylinder share: a row of scene.quadric, reading phimax, normals and texture
// coordinates through a transform.
#ifndef SCENE_SHAPE_QUADRIC_H
#define SCENE_SHAPE_QUADRIC_H

#include "numeric/elementary.h"
#include "scene/box.h"
#include "scene/read.h"
#include "scene/shape/gauss.h"

// Matrices in text files carry six digits or more, so that a written rotation is one to about 1e-6.
// Within this tolerance the density of uniform samples is off by at most twice as much, relative.
static const double quadric_similarity_tolerance = 1e-5;

static const double quadric_two_pi = 0x1.921fb54442d18p+2;

static inline const struct quadric *quadric_of(const struct scene *scene,
                                               const struct shape *shape) {
  return &scene->quadric[shape->local];
}

// `float phimax` in degrees -> radians; 360 gives 2 pi exactly.
static inline double quadric_read_phi_max(struct params *params) {
  double degrees = params_float(params, "phimax", 360);
  if (!(degrees > 0 && degrees <= 360))
    params_complain(params, "phimax", "phimax must be in (0, 360] degrees");
  return degrees / 360 * quadric_two_pi;
}

static inline double quadric_read_radius(struct params *params) {
  double radius = params_float(params, "radius", 1);
  if (!(radius > 0)) params_complain(params, "radius", "the radius must be positive");
  return radius;
}

// The object-space normal n in world space, of unit length, flipped as the shape says.
static inline struct vec quadric_normal(const struct quadric *quadric, const struct shape *shape,
                                        struct vec n) {
  n = vec_normalize(transform_normal(&quadric->object_from_world, n));
  return shape->flip ? vec_scale(n, -1) : n;
}

// cos and sin of the angle u phi_max.
static inline void quadric_angle(const struct quadric *quadric, double u, double *cosine,
                                 double *sine) {
  num_sincos_turns(u * (quadric->phi_max / quadric_two_pi), sine, cosine);
}

// Whether the images of the axes are perpendicular, and those of x and y, or of all three, of equal
// length: uniform points of a cylinder, or of a sphere, then stay uniform.
static inline bool quadric_is_even(const struct transform *t, bool all) {
  struct vec x = transform_direction(t, vec(1, 0, 0)), y = transform_direction(t, vec(0, 1, 0)),
             z = transform_direction(t, vec(0, 0, 1));
  double xx = vec_dot(x, x), yy = vec_dot(y, y), zz = vec_dot(z, z);
  double most = quadric_similarity_tolerance * xx;
  double most_z = quadric_similarity_tolerance * sqrt(xx * zz);
  return fabs(yy - xx) <= most && fabs(vec_dot(x, y)) <= most && fabs(vec_dot(x, z)) <= most_z &&
         fabs(vec_dot(y, z)) <= most_z && (!all || fabs(zz - xx) <= most);
}

// uv[0] = phi / phimax and dp/du, which all quadrics share; gives p in object space.
static inline struct vec quadric_detail(const struct quadric *quadric, struct surface *surface) {
  struct vec p = transform_point(&quadric->object_from_world, surface->p);
  double phi = num_atan2(p.y, p.x);
  surface->uv[0] = (phi < 0 ? phi + quadric_two_pi : phi) / quadric->phi_max;
  struct vec dpdu = vec(-quadric->phi_max * p.y, quadric->phi_max * p.x, 0);
  surface->dpdu = transform_direction(&quadric->world_from_object, dpdu);
  return p;
}

// How much the area at a point grows on its way to world space, n its unit normal in object space:
// |det M| |M^-T n|.
static inline double quadric_stretch(const struct quadric *quadric, struct vec n) {
  return fabs(transform_determinant(quadric->world_from_object)) *
         vec_length(transform_normal(&quadric->object_from_world, n));
}

// Where quadric_is_even does not hold, the mean of `stretch` over the quadric, which it takes from
// shares of its height and sweep: quarters of the one and eighths of the other.
static inline double quadric_mean_stretch(const struct scene_builder *builder, struct quadric q,
                                          double (*stretch)(const struct quadric *, double u0,
                                                            double u1)) {
  q.world_from_object = builder->world_from_object;
  transform_invert(q.world_from_object, &q.object_from_world); // the reader checked it
  double sum = 0;
  for (int i = 0; i < 4 * GAUSS_POINTS; i++)
    for (int j = 0; j < 8 * GAUSS_POINTS; j++) {
      int a = i % GAUSS_POINTS, b = j % GAUSS_POINTS;
      sum += gauss_weight[a] * gauss_weight[b] *
             stretch(&q, (i / GAUSS_POINTS + gauss_node[a]) / 4,
                     (j / GAUSS_POINTS + gauss_node[b]) / 8);
    }
  return sum / (4 * 8);
}

#endif
