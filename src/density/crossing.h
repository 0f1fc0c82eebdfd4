// Where a beam passes an eye ray: the points of the two lines that are closest to each other.
#ifndef DENSITY_CROSSING_H
#define DENSITY_CROSSING_H

#include "walk/beams.h"
#include "walk/eye_segments.h"

struct crossing_point {
  double t, s;  // distances along the eye's ray and the beam
  double u2;    // of the two points, squared
  double sine2; // of the angle between the lines, squared
};

// False unless both points lie on the pieces, less than r apart. An end belongs to the piece that
// begins there, so that what passes where two touch is counted once. Parallel lines have no closest
// points: they never cross, which loses nothing where directions are distributed in space, but all
// of the single scattering of parallel light along a ray of its own direction.
//
// u is measured between the points as they are rounded, so that a box around either piece, widened
// by r, holds the other's point.
static inline bool crossing_find(const struct eye_segment *eye, const struct photon_beam *beam,
                                 double r2, struct crossing_point *point) {
  struct vec n = vec_cross(eye->d, beam->d), apart = vec_sub(beam->o, eye->o);
  point->sine2 = vec_dot(n, n);
  // u sine, by another way than below: to rounding.
  double volume = vec_dot(apart, n);
  if (!(volume * volume < r2 * point->sine2 * (1 + 0x1p-20))) return false; // also if parallel
  point->t = vec_dot(vec_cross(apart, beam->d), n) / point->sine2;
  if (!(point->t >= 0 && point->t < eye->length)) return false;
  point->s = vec_dot(vec_cross(apart, eye->d), n) / point->sine2;
  if (!(point->s >= 0 && point->s < beam->length)) return false;
  struct vec u =
      vec_sub(vec_along(eye->o, eye->d, point->t), vec_along(beam->o, beam->d, point->s));
  point->u2 = vec_dot(u, u);
  return point->u2 < r2;
}

#endif
