// Flat shapes: planes, triangles, and the edges that no two triangles share.
#ifndef ANALYSIS_FLAT_H
#define ANALYSIS_FLAT_H

#include "base/vec.h"
#include "scene/scene.h"

#include <stdbool.h>

struct plane {
  struct vec p, n;
  double tolerance; // of vertices, which are rounded to float
};
struct plane flat_plane(const struct scene *, struct vec p, struct vec n);

bool flat_is_triangles(const struct shape *); // rows of scene.triangle; disks are of scene.quadric
void flat_triangle(const struct scene *, const struct shape *, uint32_t t, struct vec vertex[3]);
bool flat_contains(const struct plane *, struct vec);
bool flat_contains_triangle(const struct plane *, const struct vec vertex[3]);
bool flat_contains_shape(const struct plane *, const struct scene *, const struct shape *);

// A point of the circle of this radius about a disk's axis; at disk->radius its rim.
struct vec flat_rim(const struct quadric *disk, double radius, double phi);

double flat_segment_distance(struct vec p, struct vec a, struct vec b);
// Whether p, in the triangle's plane, is in the triangle; it may be of either orientation.
bool flat_inside(struct vec p, const struct vec vertex[3]);

struct edges {
  struct edge {
    struct vec a, b;
  } * item;
  ptrdiff_t count, capacity;
};

// The edges of a triangle. One that comes a second time is inside: both are forgotten.
void flat_toggle(struct edges *, const struct vec vertex[3], struct arena *);

#endif
