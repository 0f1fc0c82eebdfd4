// Bounds of a medium's density in coarse cells of its box, and a ray's way through them
// (Amanatides and Woo 1987), so that empty space costs little. Nothing is remembered between
// pieces: the cell at t is the one between whose planes t is, all computed in one way, so each
// piece ends after it begins.
//
// Rounding. Write u for the box's coordinates, where it is the unit cube, and A for the map to
// them from world space. The point that `at` computes for t, and the planes that bound a piece, are
// each displaced by at most 32 eps (|A| (|o| + t |d|) + |b| + 1) in u: some ten roundings of terms
// that large. A cell's bound is that of the cell grown by an eighth on all sides, the box's planes
// lie a sixteenth of a cell outside of it, and where the displacement, taken twice as large, may be
// more than a sixteenth of a cell (grids far from the origin, rays that come from far away), the
// bound of all holds for the whole way through the box, which is grown by the displacement.
#ifndef SCENE_MEDIUM_MAJORANT_H
#define SCENE_MEDIUM_MAJORANT_H

#include "scene/ray.h"
#include "scene/transform.h"

#include <assert.h>
#include <stdbool.h>

enum { MAJORANT_CELLS = 16 }; // at most, along each axis, as in pbrt-v4

static const double majorant_grown = 0.125, majorant_outside = 0.0625; // cells

struct majorant {
  struct transform unit_from_world;
  int n[3];
  const double *value; // [n[2]][n[1]][n[0]], at least sigma_t
  double most;
};

// A ray against the box.
struct majorant_ray {
  double o[3], d[3]; // in u
  double pad[3];     // of the box's planes, in u
  bool coarse;       // one bound for all of the box
  double in, out;    // it is within the padded box from here to there
};

// The displacement above, per unit of its terms.
static const double majorant_displaced = 0x1p-46; // 64 eps

// A time after which no computed point is in the box; see majorant_is_invertible.
static inline double majorant_last(const double o[3], const double d[3], const double still[3],
                                   const double moving[3]) {
  double last = INFINITY;
  for (int i = 0; i < 3; i++) {
    double speed = fabs(d[i]) - majorant_displaced * moving[i];
    double t = (2 + fabs(o[i]) + majorant_displaced * still[i]) / speed;
    if (speed > 0 && t < last) last = t;
  }
  assert(last < INFINITY);
  return last;
}

// False: it misses the box.
static inline bool majorant_enter(const struct majorant *majorant, const struct ray *ray,
                                  struct majorant_ray *out) {
  const struct transform *t = &majorant->unit_from_world;
  struct vec o = transform_point(t, ray->o), d = transform_direction(t, ray->d);
  double still[3], moving[3];
  *out = (struct majorant_ray){
      .o = {o.x, o.y, o.z}, .d = {d.x, d.y, d.z}, .in = -INFINITY, .out = INFINITY};
  for (int i = 0; i < 3; i++) {
    const double *m = t->m[i];
    still[i] = fabs(m[0] * ray->o.x) + fabs(m[1] * ray->o.y) + fabs(m[2] * ray->o.z) + fabs(m[3]);
    moving[i] = fabs(m[0] * ray->d.x) + fabs(m[1] * ray->d.y) + fabs(m[2] * ray->d.z);
  }
  double last = majorant_last(out->o, out->d, still, moving);
  for (int i = 0; i < 3; i++) {
    double displaced = majorant_displaced * (still[i] + last * moving[i] + 1);
    double pad = majorant_outside / majorant->n[i];
    out->coarse = out->coarse || !(displaced < pad);
    out->pad[i] = displaced < pad ? pad : displaced;
    if (out->d[i] == 0) {
      if (out->o[i] < -out->pad[i] || out->o[i] > 1 + out->pad[i]) return false;
      continue;
    }
    double t0 = (-out->pad[i] - out->o[i]) / out->d[i],
           t1 = (1 + out->pad[i] - out->o[i]) / out->d[i];
    double first = t0 < t1 ? t0 : t1, end = t0 < t1 ? t1 : t0;
    out->in = out->in < first ? first : out->in;
    out->out = end < out->out ? end : out->out;
  }
  return out->in < out->out;
}

// When it crosses the plane before cell k of axis i; of one direction times never decrease with k.
static inline double majorant_crossing(const struct majorant *majorant,
                                       const struct majorant_ray *ray, int i, int k) {
  double plane = k == 0                ? -ray->pad[i]
                 : k == majorant->n[i] ? 1 + ray->pad[i]
                                       : k / (double)majorant->n[i];
  return (plane - ray->o[i]) / ray->d[i];
}

// The cell of axis i at time t, between ray->in and ray->out.
static inline int majorant_cell(const struct majorant *majorant, const struct majorant_ray *ray,
                                int i, double t) {
  int n = majorant->n[i], forward = ray->d[i] > 0;
  double guess = floor((ray->o[i] + t * ray->d[i]) * n);
  int k = guess > 0 ? guess < n - 1 ? (int)guess : n - 1 : 0;
  if (ray->d[i] == 0) return k;
  int step = forward ? 1 : -1, last = forward ? n - 1 : 0, first = n - 1 - last;
  while (k != last && majorant_crossing(majorant, ray, i, k + forward) <= t) k += step;
  while (k != first && majorant_crossing(majorant, ray, i, k + !forward) > t) k -= step;
  return k;
}

static inline double majorant_value(const struct majorant *majorant, const int k[3]) {
  return majorant->value[(k[2] * majorant->n[1] + k[1]) * majorant->n[0] + k[0]];
}

// Through cells of one bound.
static inline void majorant_walk(const struct majorant *majorant, const struct majorant_ray *ray,
                                 double t, double *end, double *bound) {
  int k[3];
  double next[3];
  for (int i = 0; i < 3; i++) {
    k[i] = majorant_cell(majorant, ray, i, t);
    next[i] =
        ray->d[i] == 0 ? INFINITY : majorant_crossing(majorant, ray, i, k[i] + (ray->d[i] > 0));
  }
  *bound = majorant_value(majorant, k);
  for (;;) {
    int i = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    *end = next[i];
    if (!(next[i] < ray->out)) break;
    k[i] += ray->d[i] > 0 ? 1 : -1;
    if (majorant_value(majorant, k) != *bound) return;
    next[i] = majorant_crossing(majorant, ray, i, k[i] + (ray->d[i] > 0));
  }
  *end = ray->out;
}

// What medium_type.piece is.
static inline bool majorant_piece(const struct majorant *majorant, const struct ray *ray, double t,
                                  double *end, double *bound) {
  struct majorant_ray way;
  if (!majorant_enter(majorant, ray, &way) || !(t < way.out)) return false;
  if (t < way.in) {
    *end = way.in;
    *bound = 0;
  } else if (way.coarse) {
    *end = way.out;
    *bound = majorant->most;
  } else {
    majorant_walk(majorant, &way, t, end, bound);
  }
  return true;
}

// Whether every direction crosses the box clearly: its three coordinates are not nearly the same.
// Then |d| of u is, along some axis, at least 1e-7 of the terms it is the sum of: the smallest
// singular value of rows of unit length is at least two thirds of their determinant, 1e-6. Of
// lengths within 1e-100 and 1e100 squares, and ratios of squares, are numbers.
static inline bool majorant_is_invertible(const struct transform *unit_from_world) {
  struct transform rows = *unit_from_world;
  for (int i = 0; i < 3; i++) {
    double *m = rows.m[i], length = vec_length(vec(m[0], m[1], m[2]));
    if (!(length > 1e-100 && length < 1e100)) return false;
    for (int j = 0; j < 3; j++) m[j] /= length;
  }
  return fabs(transform_determinant(rows)) > 1e-6;
}

#endif
