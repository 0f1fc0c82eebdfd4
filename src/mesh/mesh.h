// Polygon meshes on their way into a scene: object space, as a file or a parameter list gives them.
#ifndef MESH_MESH_H
#define MESH_MESH_H

#include "base/arena.h"
#include "base/file.h"
#include "base/problem.h"

#include <stdbool.h>
#include <stdint.h>

struct mesh {
  uint32_t n_vertices, n_triangles, n_quads;
  double (*p)[3];  // finite
  double (*n)[3];  // or NULL; of any length, zero where a vertex has none
  double (*uv)[2]; // or NULL; finite
  double (*s)[3];  // tangents, or NULL
  uint32_t (*triangle)[3];
  uint32_t (*quad)[4]; // around the face
};

// A PLY file's bytes, gzip-compressed or not: elements `vertex` (x y z; nx ny nz; u v, s t,
// texture_u texture_v or texture_s texture_t) and `face` (vertex_indices or vertex_index), others
// are skipped. Faces of more than four vertices become fans of triangles around their first vertex,
// which is right for convex ones. `file` is for messages.
bool mesh_read_ply(const char *file, struct text bytes, struct arena *, struct arena scratch,
                   struct mesh *, struct problem *);

// Loop subdivision of the triangles as pbrt-v4's loopsubdiv, from positions alone: refined `levels`
// (0 or more) times, then moved to the limit surface and given its normals. Every edge must belong
// to at most two triangles, of equal orientation.
bool mesh_subdivide(const struct mesh *, int levels, struct arena *, struct arena scratch,
                    struct mesh *, struct problem *);

#endif
