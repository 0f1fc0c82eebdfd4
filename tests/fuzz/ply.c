// Any bytes are a mesh or a problem of one line.
#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void check(bool right) {
  if (!right) abort();
}

static void check_mesh(const struct mesh *m) {
  for (uint32_t k = 0; k < m->n_vertices; k++)
    for (int j = 0; j < 3; j++) check(isfinite(m->p[k][j]) && (!m->n || isfinite(m->n[k][j])));
  for (uint32_t k = 0; m->uv && k < m->n_vertices; k++)
    check(isfinite(m->uv[k][0]) && isfinite(m->uv[k][1]));
  for (uint32_t k = 0; k < m->n_triangles; k++)
    for (int j = 0; j < 3; j++) check(m->triangle[k][j] < m->n_vertices);
  for (uint32_t k = 0; k < m->n_quads; k++)
    for (int j = 0; j < 4; j++) check(m->quad[k][j] < m->n_vertices);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct arena arena, scratch;
  if (!arena.next) arena = arena_reserve(), scratch = arena_reserve();
  if (size > 1 << 16) return 0; // gzip unpacks a thousandfold, and the arenas are small under asan
  struct arena a = arena, b = scratch;
  struct text text = {arena_string(&b, (const char *)data, (ptrdiff_t)size), (ptrdiff_t)size};
  struct mesh mesh;
  struct problem problem = {{0}};
  bool ok = mesh_read_ply("fuzz", text, &a, b, &mesh, &problem);
  check(ok == (problem.text[0] == 0) && !strchr(problem.text, '\n'));
  if (ok) check_mesh(&mesh);
  return 0;
}
