#include "walk/differential.h"

// By central differences over 2^-9 of a pixel: the error is that part, squared, of the squared
// angle of a pixel; rounding leaves 2^-43 over that angle.
struct differential differential_of_camera(const struct camera *camera, double x, double y,
                                           const double u[2]) {
  const double h = 0x1p-10;
  struct differential out = {.length = 0};
  for (int k = 0; k < 2; k++) {
    double dx = k == 0 ? h : 0, dy = k == 0 ? 0 : h;
    struct ray after = camera_ray(camera, x + dx, y + dy, u),
               before = camera_ray(camera, x - dx, y - dy, u);
    out.p[k] = vec_scale(vec_sub(after.o, before.o), 1 / (2 * h));
    out.d[k] = vec_scale(vec_sub(after.d, before.d), 1 / (2 * h));
    out.camera_p[k] = out.p[k];
    out.camera_d[k] = out.d[k];
  }
  return out;
}

// Igehy 1999, equation 10 and 12: what is off the surface's tangent plane moves along d.
void differential_transfer(struct differential *differential, struct vec from, struct vec d,
                           const struct surface *surface) {
  double t = vec_length(vec_sub(surface->p, from)), facing = vec_dot(d, surface->ng);
  differential->length += t;
  for (int k = 0; k < 2; k++) {
    struct vec moved = vec_along(differential->p[k], differential->d[k], t);
    differential->p[k] = vec_along(moved, d, -vec_dot(moved, surface->ng) / facing);
  }
}

static struct vec normal_at(const struct scene *scene, const struct surface *surface,
                            struct vec p) {
  const struct shape *shape = &scene->shape[surface->shape];
  struct surface there = {.p = p, .primitive = surface->primitive, .shape = surface->shape};
  there.ng = there.ns = shape->type->normal(scene, shape, surface->primitive, p);
  if (shape->detailed) shape->type->detail(scene, shape, &there);
  return there.ns;
}

// The derivative of the shading normal along dp, by central differences over 2^-17 of the
// primitive's size: the error is the square of that part of its radius of curvature, rounding
// leaves 2^-35.
static struct vec normal_change(const struct scene *scene, const struct surface *surface,
                                struct vec dp) {
  const struct shape *shape = &scene->shape[surface->shape];
  double length = vec_length(dp);
  if ((shape->type->flat && !shape->detailed) || !(length > 0)) return vec(0, 0, 0);
  struct box box = shape->type->bounds(scene, shape, surface->primitive);
  struct vec size =
      vec((double)box.hi[0] - (double)box.lo[0], (double)box.hi[1] - (double)box.lo[1],
          (double)box.hi[2] - (double)box.lo[2]);
  double h = 0x1p-17 * vec_length(size);
  struct vec after = normal_at(scene, surface, vec_along(surface->p, dp, h / length)),
             before = normal_at(scene, surface, vec_along(surface->p, dp, -h / length));
  return vec_scale(vec_sub(after, before), length / (2 * h));
}

// Reflection: d' = d - 2 (d.n) n. Refraction: d' = d / eta - mu n with mu = (d.n) / eta - d'.n and
// d'.n = -sqrt(1 - (1 - (d.n)^2) / eta^2); n on the side that d comes from. Both differentiated
// (Igehy 1999, equations 14 to 19); eta = 1 leaves d alone, as a thin slab does.
void differential_scatter(struct differential *differential, const struct scene *scene,
                          const struct surface *surface, struct vec n, struct vec d, struct vec wi,
                          double eta2) {
  double side = vec_dot(d, n) > 0 ? -1 : 1;
  n = vec_scale(n, side);
  double cos_d = vec_dot(d, n), cos_wi = vec_dot(wi, n), eta = sqrt(eta2);
  for (int k = 0; k < 2; k++) {
    struct vec dn = vec_scale(normal_change(scene, surface, differential->p[k]), side);
    struct vec dd = differential->d[k];
    double change = vec_dot(dd, n) + vec_dot(d, dn);
    if (cos_wi > 0) {
      differential->d[k] = vec_along(vec_along(dd, dn, -2 * cos_d), n, -2 * change);
    } else {
      double mu = cos_d / eta - cos_wi, dmu = (1 / eta - cos_d / (eta2 * cos_wi)) * change;
      differential->d[k] = vec_along(vec_along(vec_scale(dd, 1 / eta), dn, -mu), n, -dmu);
    }
  }
}

static double root_mean_square(struct vec a, struct vec b) {
  return sqrt((vec_dot(a, a) + vec_dot(b, b)) / 2);
}

double differential_footprint(const struct differential *differential) {
  return root_mean_square(differential->p[0], differential->p[1]);
}

double differential_across(const struct differential *differential) {
  struct vec across[2];
  for (int k = 0; k < 2; k++)
    across[k] =
        vec_along(differential->camera_p[k], differential->camera_d[k], differential->length);
  return root_mean_square(across[0], across[1]);
}
