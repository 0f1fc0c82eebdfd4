// A triangle mesh that knows its neighbours. Edge k of a triangle leads from its vertex k to k + 1.
#ifndef MESH_LEVEL_H
#define MESH_LEVEL_H

#include "base/vec.h"
#include "mesh/mesh.h"

#define LEVEL_NONE UINT32_MAX

struct level {
  uint32_t n_vertices, n_triangles;
  struct vec *p;
  uint32_t *start; // a triangle of each vertex, or LEVEL_NONE
  bool *boundary;
  uint32_t (*vertex)[3];
  uint32_t (*across)[3]; // the neighbour at each edge, or LEVEL_NONE
};

static inline int level_next(int k) { return k == 2 ? 0 : k + 1; }
static inline int level_previous(int k) { return k == 0 ? 2 : k - 1; }

struct level level_new(uint32_t n_vertices, uint32_t n_triangles, struct arena *);

// False: the mesh has a triangle with a vertex twice, an edge of more than two triangles or of two
// that face opposite sides.
bool level_of_mesh(const struct mesh *, struct arena *, struct level *, struct problem *);

// Which corner of the triangle the vertex is.
int level_corner(const struct level *, uint32_t triangle, uint32_t vertex);

// The neighbours of a vertex that has a triangle, in pbrt's order, of a boundary from one end to
// the other; how many. `ring` has room for level_longest_ring.
int level_ring(const struct level *, uint32_t vertex, uint32_t *ring);

// The most neighbours a vertex has.
ptrdiff_t level_longest_ring(const struct level *, struct arena scratch);

#endif
