// What the lights share: reading with checks, and the two samplings each of them is made of.
#ifndef SCENE_LIGHT_LIGHT_H
#define SCENE_LIGHT_LIGHT_H

#include "numeric/elementary.h"
#include "scene/read.h"

#include <string.h>

static const double light_pi = 0x1.921fb54442d18p+1;

// ---- reading ----

static inline bool light_given(const struct params *params, const char *type, const char *name) {
  for (int i = 0; i < params->count; i++)
    if (!strcmp(params->item[i].name, name) && !strcmp(params->item[i].type, type)) return true;
  return false;
}

// A float that must be greater than zero.
static inline double light_positive(struct params *params, const char *name, double fallback) {
  double value = params_float(params, name, fallback);
  if (value <= 0) params_complain(params, name, "\"%s\" must be greater than zero", name);
  return value;
}

static inline double light_scale(struct params *params) {
  double scale = params_float(params, "scale", 1);
  if (scale < 0) params_complain(params, "scale", "\"scale\" must not be negative");
  return scale;
}

// value = the spectrum `name` (1 1 1 if absent) times `scale`. pbrt-v4 takes what is not rgb at
// luminance 1.
static inline void light_spectrum(struct scene_builder *builder, struct params *params,
                                  const char *name, double value[3]) {
  value[0] = value[1] = value[2] = 1;
  spectrum_read(builder, params, name, SPECTRUM_ILLUMINANT, value);
  double scale = light_scale(params);
  for (int c = 0; c < 3; c++) value[c] *= scale;
}

// A `power` or `illuminance`: its value / divisor, 1 if absent. pbrt-v4 takes zero or less as
// absent; here that is an error, so that no file means two things.
static inline double light_total(struct params *params, const char *name, double divisor) {
  double value = params_float(params, name, NAN);
  if (isnan(value)) return 1;
  if (value <= 0) params_complain(params, name, "\"%s\" must be greater than zero", name);
  return value / divisor;
}

// `from` in world space and the unit vector from there to `to`.
static inline void light_from_to(struct scene_builder *builder, struct params *params,
                                 struct vec *from, struct vec *axis) {
  struct vec start = params_point3(params, "from", vec(0, 0, 0));
  struct vec end = params_point3(params, "to", vec(0, 0, 1));
  struct vec along = transform_direction(&builder->world_from_object, vec_sub(end, start));
  double length = vec_length(along);
  if (!(length > 0 && isfinite(length)))
    params_complain(params, "to", "\"from\" and \"to\" give no direction");
  *from = transform_point(&builder->world_from_object, start);
  *axis = vec_normalize(along);
}

// The light's axes in world space, of unit length, for lights with a map of directions. It keeps
// its areas only if the transformation keeps angles; matrices of a few digits do so to 1e-3, and
// the axes are made exactly orthogonal.
static inline bool light_axes(const struct scene_builder *builder, struct params *params,
                              struct vec axis[3]) {
  const struct transform *t = &builder->world_from_object;
  struct vec x = transform_direction(t, vec(1, 0, 0)), y = transform_direction(t, vec(0, 1, 0)),
             z = transform_direction(t, vec(0, 0, 1));
  double xx = vec_dot(x, x), yy = vec_dot(y, y), zz = vec_dot(z, z), most = 1e-3 * xx;
  bool similar = fabs(yy - xx) <= most && fabs(zz - xx) <= most && fabs(vec_dot(x, y)) <= most &&
                 fabs(vec_dot(y, z)) <= most && fabs(vec_dot(z, x)) <= most;
  if (!similar)
    return params_complain(params, "filename",
                           "the current transformation stretches the image: it may only turn, "
                           "mirror and scale all axes alike");
  axis[0] = vec_normalize(x);
  axis[1] = vec_normalize(vec_along(y, axis[0], -vec_dot(axis[0], y)));
  axis[2] = vec_cross(axis[0], axis[1]);
  if (vec_dot(axis[2], z) < 0) axis[2] = vec_scale(axis[2], -1);
  return true;
}

static inline struct vec light_from_axes(const struct vec axis[3], struct vec d) {
  return vec_along(vec_along(vec_scale(axis[0], d.x), axis[1], d.y), axis[2], d.z);
}

static inline struct vec light_to_axes(const struct vec axis[3], struct vec d) {
  return vec(vec_dot(d, axis[0]), vec_dot(d, axis[1]), vec_dot(d, axis[2]));
}

static inline double light_luminance(const double rgb[3]) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// The last words of every `read`: large numbers may have multiplied to infinity.
static inline bool light_finish(struct params *params, const struct light *light) {
  for (int c = 0; c < 3; c++)
    if (!isfinite(light->power[c])) params_complain(params, "scale", "the power is not finite");
  return params_finish(params);
}

static inline bool light_is_gray(const struct light *light) {
  return light->power[0] == light->power[1] && light->power[1] == light->power[2];
}

// ---- sampling ----

// Uniform on the unit disc: radius sqrt(u0), angle 2 pi u1.
static inline void light_sample_disc(double u0, double u1, double *x, double *y) {
  double sine, cosine, radius = sqrt(u0);
  num_sincos_turns(u1, &sine, &cosine);
  *x = radius * cosine;
  *y = radius * sine;
}

// pdf_solid_angle = cos / pi around the unit vector n (Malley: a point of the disc, lifted).
static inline struct vec light_sample_cosine(struct vec n, double u0, double u1) {
  struct vec s, t;
  double x, y;
  vec_basis(n, &s, &t);
  light_sample_disc(u0, u1, &x, &y);
  return vec_along(vec_along(vec_scale(n, sqrt(1 - u0)), s, x), t, y);
}

// Uniform on the sphere: the height is uniform (Archimedes).
static inline struct vec light_sample_sphere(double u0, double u1) {
  double sine, cosine, radius = 2 * sqrt(u0 * (1 - u0));
  num_sincos_turns(u1, &sine, &cosine);
  return vec(radius * cosine, radius * sine, 1 - 2 * u0);
}

// The sphere around the scene's bounds: where photons of a light at infinity pass.
static inline double light_bounding_sphere(const struct scene *scene, struct vec *centre) {
  const float *lo = scene->bounds.lo, *hi = scene->bounds.hi;
  struct vec low = vec(lo[0], lo[1], lo[2]), high = vec(hi[0], hi[1], hi[2]);
  *centre = vec_scale(vec_add(low, high), 0.5);
  return vec_length(vec_sub(high, low)) / 2;
}

// No ray finds a delta light by chance.
static inline double light_pdf_delta(const struct scene *scene, const struct light *light,
                                     struct vec p, const struct surface *surface, struct vec wi) {
  (void)scene, (void)light, (void)p, (void)surface, (void)wi;
  return 0;
}

// ---- closed forms ----

// How far from p, within the plane with normal n, is the plane with normal `axis` at distance
// `height` from p? INFINITY if they are parallel.
static inline double light_distance_in_plane(double height, struct vec axis, struct vec n) {
  double sine = vec_length(vec_cross(axis, n));
  return sine > 0 ? fabs(height) / sine : INFINITY;
}

#endif
