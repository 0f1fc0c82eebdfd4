// The parameters that trianglemesh, loopsubdiv and bilinearmesh share: `point3 P`, `integer
// indices`, `normal N`, `point2 uv`.
#ifndef SCENE_SHAPE_MESH_PARAMS_H
#define SCENE_SHAPE_MESH_PARAMS_H

#include "mesh/mesh.h"
#include "scene/read.h"

// An array with a value of `size` numbers for each vertex, NULL if it is absent.
static inline const double *mesh_params_per_vertex(struct params *params, const char *type,
                                                   const char *name, int size,
                                                   ptrdiff_t n_vertices) {
  ptrdiff_t n;
  const double *value = params_array(params, type, name, &n);
  if (value && n != size * n_vertices)
    params_complain(params, name, "%td values of \"%s\" for %td vertices", n / size, name,
                    n_vertices);
  return value;
}

// The indices, `corners` for each face; absent: one face of as many vertices. NULL: problem set.
static inline uint32_t *mesh_params_indices(struct params *params, int corners,
                                            ptrdiff_t n_vertices, struct arena *arena,
                                            ptrdiff_t *n) {
  const double *index = params_array(params, "integer", "indices", n);
  if (!index && n_vertices != corners)
    params_complain(params, "P", "\"integer indices\" is missing");
  if (*n % corners)
    params_complain(params, "indices", "%td indices are not a multiple of %d", *n, corners);
  if (!index) *n = corners;
  if (n_vertices >= UINT32_MAX || *n / corners >= UINT32_MAX)
    params_complain(params, "P", "more than 2^32 - 2 vertices or faces");
  if (params->problem->text[0]) return NULL;
  uint32_t *row = arena_new(arena, uint32_t, *n);
  for (ptrdiff_t k = 0; k < *n; k++) {
    if (index && !(index[k] >= 0 && index[k] < (double)n_vertices)) {
      params_complain(params, "indices", "index number %td is %.0f, but the vertices are 0 to %td",
                      k + 1, index[k], n_vertices - 1);
      return NULL;
    }
    row[k] = index ? (uint32_t)index[k] : (uint32_t)k;
  }
  return row;
}

// A mesh of P (which it shares with the parameters) and the arrays in N and uv, without faces.
// False: problem set.
static inline bool mesh_params_vertices(struct params *params, struct mesh *mesh) {
  ptrdiff_t n_numbers;
  const double *p = params_array(params, "point3", "P", &n_numbers);
  if (!p || n_numbers == 0) return params_complain(params, "P", "\"point3 P\" is missing");
  *mesh = (struct mesh){.n_vertices = (uint32_t)(n_numbers / 3), .p = (double(*)[3])p};
  if (n_numbers / 3 >= UINT32_MAX)
    return params_complain(params, "P", "more than 2^32 - 2 vertices");
  return true;
}

static inline bool mesh_params_attributes(struct params *params, struct mesh *mesh) {
  mesh->n = (double(*)[3])mesh_params_per_vertex(params, "normal", "N", 3, mesh->n_vertices);
  mesh->uv = (double(*)[2])mesh_params_per_vertex(params, "point2", "uv", 2, mesh->n_vertices);
  return !params->problem->text[0];
}

#endif
