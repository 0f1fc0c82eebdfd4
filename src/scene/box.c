#include "scene/box.h"

#include <float.h>
#include <math.h>

struct box box_empty(void) {
  return (struct box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

struct box box_union(struct box a, struct box b) {
  for (int i = 0; i < 3; i++) {
    a.lo[i] = b.lo[i] < a.lo[i] ? b.lo[i] : a.lo[i];
    a.hi[i] = b.hi[i] > a.hi[i] ? b.hi[i] : a.hi[i];
  }
  return a;
}

struct box box_intersection(struct box a, struct box b) {
  for (int i = 0; i < 3; i++) {
    a.lo[i] = b.lo[i] > a.lo[i] ? b.lo[i] : a.lo[i];
    a.hi[i] = b.hi[i] < a.hi[i] ? b.hi[i] : a.hi[i];
  }
  return a;
}

float box_round_down(double x) {
  float f = (float)x;
  return (double)f > x ? nextafterf(f, -INFINITY) : f;
}

float box_round_up(double x) {
  float f = (float)x;
  return (double)f < x ? nextafterf(f, INFINITY) : f;
}

static void set_axis(struct box *box, int axis, double center, double half, double terms) {
  // Eight roundings of relative size DBL_EPSILON / 2, and the sums below.
  double reach = half + terms * (8 * DBL_EPSILON);
  box->lo[axis] = box_round_down(center - reach);
  box->hi[axis] = box_round_up(center + reach);
}

struct box box_around(struct vec center, struct vec half, struct vec terms) {
  struct box box;
  set_axis(&box, 0, center.x, half.x, terms.x);
  set_axis(&box, 1, center.y, half.y, terms.y);
  set_axis(&box, 2, center.z, half.z, terms.z);
  return box;
}

static struct transform magnitudes(const struct transform *t) {
  struct transform a;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) a.m[i][j] = fabs(t->m[i][j]);
  return a;
}

struct vec box_terms(const struct transform *t, struct vec p) {
  struct transform a = magnitudes(t);
  return transform_point(&a, vec(fabs(p.x), fabs(p.y), fabs(p.z)));
}

struct box box_transform(const struct transform *t, struct vec lo, struct vec hi) {
  struct transform a = magnitudes(t);
  struct vec center = vec_scale(vec_add(lo, hi), 0.5), half = vec_scale(vec_sub(hi, lo), 0.5);
  struct vec extent = transform_direction(&a, half);
  return box_around(transform_point(t, center), extent, vec_add(box_terms(t, center), extent));
}
