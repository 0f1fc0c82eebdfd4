#include "mesh/ply.h"
#include "base/gzip.h"

#include <math.h>

// The columns of a vertex that are kept.
enum { X, Y, Z, NX, NY, NZ, U, V, N_COLUMNS, NO_COLUMN = -1 };

static const char *const column_names[U] = {"x", "y", "z", "nx", "ny", "nz"};
static const char *const uv_names[][2] = {
    {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};

// ---- what the header declares ----
static const struct ply_element *find_element(const struct ply *ply, const char *name) {
  for (ptrdiff_t k = 0; k < ply->elements.count; k++)
    if (ply_is(ply->elements.item[k].name, name)) return &ply->elements.item[k];
  return NULL;
}

// Its number in the element, or NO_COLUMN.
static ptrdiff_t find_scalar(const struct ply_element *element, const char *name) {
  for (ptrdiff_t k = 0; k < element->properties.count; k++)
    if (ply_is(element->properties.item[k].name, name) && !element->properties.item[k].list)
      return k;
  return NO_COLUMN;
}

// The list of a face's vertices, or NULL.
static const struct ply_property *find_indices(const struct ply_element *face) {
  for (ptrdiff_t k = 0; k < face->properties.count; k++) {
    const struct ply_property *property = &face->properties.item[k];
    if (property->list && property->type < PLY_FLOAT32 &&
        (ply_is(property->name, "vertex_indices") || ply_is(property->name, "vertex_index")))
      return property;
  }
  return NULL;
}

// Every row takes this many bytes or more; in text a digit and a space for each value.
static int64_t least_row(const struct ply *ply, const struct ply_element *element) {
  int64_t size = 0;
  for (ptrdiff_t k = 0; k < element->properties.count; k++) {
    const struct ply_property *property = &element->properties.item[k];
    size += ply->binary ? ply_size(property->list ? property->count_type : property->type) : 2;
  }
  return size;
}

// Before anything is allocated for the rows, or a loop runs over them.
static bool check_rows(const struct ply *ply, const struct ply_element *element) {
  int64_t least = least_row(ply, element), room = ply->end - ply->at + !ply->binary;
  if (least == 0 || element->count <= room / least) return true;
  return ply_complain(ply, "%lld rows of element %s do not fit into the rest of the file",
                      (long long)element->count, ply_quote(element->name).text);
}

// ---- vertices ----
// source[c]: the property that column c comes from. The first complete pair of uv names counts.
static bool find_columns(const struct ply *ply, const struct ply_element *vertex,
                         ptrdiff_t source[N_COLUMNS]) {
  for (int c = X; c < U; c++) source[c] = find_scalar(vertex, column_names[c]);
  for (int c = X; c <= Z; c++)
    if (source[c] == NO_COLUMN)
      return ply_complain(ply, "its vertices have no %s", column_names[c]);
  for (int c = 0; c < 4; c++) {
    source[U] = find_scalar(vertex, uv_names[c][0]);
    source[V] = find_scalar(vertex, uv_names[c][1]);
    if (source[U] != NO_COLUMN && source[V] != NO_COLUMN) break;
  }
  return true;
}

static bool store_vertex(const struct ply *ply, const double value[N_COLUMNS], uint32_t k,
                         struct mesh *mesh) {
  if (!isfinite(value[X]) || !isfinite(value[Y]) || !isfinite(value[Z]))
    return ply_complain(ply, "vertex %u is not finite", k);
  if (mesh->uv && (!isfinite(value[U]) || !isfinite(value[V])))
    return ply_complain(ply, "the texture coordinates of vertex %u are not finite", k);
  bool normal = isfinite(value[NX]) && isfinite(value[NY]) && isfinite(value[NZ]);
  for (int j = 0; j < 3; j++) mesh->p[k][j] = value[X + j];
  for (int j = 0; mesh->n && j < 3; j++) mesh->n[k][j] = normal ? value[NX + j] : 0;
  for (int j = 0; mesh->uv && j < 2; j++) mesh->uv[k][j] = value[U + j];
  return true;
}

static bool read_vertices(struct ply *ply, const struct ply_element *vertex, struct arena *arena,
                          struct arena scratch, struct mesh *mesh) {
  ptrdiff_t source[N_COLUMNS], n = vertex->properties.count;
  if (!find_columns(ply, vertex, source)) return false;
  int *column = arena_new(&scratch, int, n);
  for (ptrdiff_t k = 0; k < n; k++) column[k] = NO_COLUMN;
  for (int c = 0; c < N_COLUMNS; c++)
    if (source[c] != NO_COLUMN) column[source[c]] = c;
  mesh->p = arena_alloc(arena, mesh->n_vertices, sizeof *mesh->p, alignof(double));
  if (source[NX] != NO_COLUMN && source[NY] != NO_COLUMN && source[NZ] != NO_COLUMN)
    mesh->n = arena_alloc(arena, mesh->n_vertices, sizeof *mesh->n, alignof(double));
  if (source[U] != NO_COLUMN && source[V] != NO_COLUMN)
    mesh->uv = arena_alloc(arena, mesh->n_vertices, sizeof *mesh->uv, alignof(double));
  for (uint32_t row = 0; row < mesh->n_vertices; row++) {
    double value[N_COLUMNS] = {0};
    for (ptrdiff_t k = 0; k < n; k++) {
      const struct ply_property *property = &vertex->properties.item[k];
      bool ok = column[k] == NO_COLUMN ? ply_skip_property(ply, property)
                                       : ply_read_value(ply, property->type, &value[column[k]]);
      if (!ok) return false;
    }
    if (!store_vertex(ply, value, row, mesh)) return false;
  }
  return true;
}

// ---- faces ----
static bool read_index(struct ply *ply, enum ply_type type, uint32_t n_vertices, uint32_t *index) {
  double value;
  if (!ply_read_value(ply, type, &value)) return false;
  if (!(value >= 0 && value < n_vertices && value == floor(value)))
    return ply_complain(ply, "%g is not a vertex of 0 to %u", value, n_vertices - 1);
  *index = (uint32_t)value;
  return true;
}

static bool read_quad(struct ply *ply, enum ply_type type, struct mesh *mesh) {
  uint32_t *quad = mesh->quad[mesh->n_quads++];
  for (int k = 0; k < 4; k++)
    if (!read_index(ply, type, mesh->n_vertices, &quad[k])) return false;
  return true;
}

static bool read_fan(struct ply *ply, enum ply_type type, int64_t count, struct mesh *mesh) {
  uint32_t first, last, next;
  if (!read_index(ply, type, mesh->n_vertices, &first)) return false;
  if (!read_index(ply, type, mesh->n_vertices, &last)) return false;
  for (; count > 2; count--) {
    if (!read_index(ply, type, mesh->n_vertices, &next)) return false;
    uint32_t *triangle = mesh->triangle[mesh->n_triangles++];
    triangle[0] = first, triangle[1] = last, triangle[2] = next;
    last = next;
  }
  return true;
}

// Appends a face, or only counts what it will be while the mesh has no arrays.
static bool read_face(struct ply *ply, const struct ply_property *indices, struct mesh *mesh) {
  int64_t count;
  if (!ply_read_count(ply, indices, &count)) return false;
  if (count < 3) return ply_complain(ply, "a face of %lld vertices", (long long)count);
  if (mesh->triangle)
    return count == 4 ? read_quad(ply, indices->type, mesh)
                      : read_fan(ply, indices->type, count, mesh);
  int64_t n_triangles = mesh->n_triangles + (count == 4 ? 0 : count - 2);
  if (n_triangles >= UINT32_MAX || mesh->n_quads == UINT32_MAX)
    return ply_complain(ply, "it has more than 2^32 - 2 faces");
  mesh->n_triangles = (uint32_t)n_triangles;
  mesh->n_quads += count == 4;
  return ply_skip_values(ply, indices->type, count);
}

static bool walk_faces(struct ply *ply, const struct ply_element *face,
                       const struct ply_property *indices, struct mesh *mesh) {
  for (int64_t row = 0; row < face->count; row++)
    for (ptrdiff_t k = 0; k < face->properties.count; k++) {
      const struct ply_property *property = &face->properties.item[k];
      if (property == indices ? !read_face(ply, indices, mesh) : !ply_skip_property(ply, property))
        return false;
    }
  return true;
}

static bool read_faces(struct ply *ply, const struct ply_element *face, struct arena *arena,
                       struct mesh *mesh) {
  const struct ply_property *indices = find_indices(face);
  if (!indices)
    return ply_complain(ply, "its faces have no list vertex_indices (or vertex_index) of integers");
  struct ply counting = *ply;
  if (!walk_faces(&counting, face, indices, mesh)) return false;
  mesh->triangle = arena_alloc(arena, mesh->n_triangles, sizeof *mesh->triangle, alignof(uint32_t));
  mesh->quad = arena_alloc(arena, mesh->n_quads, sizeof *mesh->quad, alignof(uint32_t));
  mesh->n_triangles = mesh->n_quads = 0;
  return walk_faces(ply, face, indices, mesh);
}

// ---- all of it ----
static bool skip_rows(struct ply *ply, const struct ply_element *element) {
  if (element->properties.count == 0) return true;
  for (int64_t row = 0; row < element->count; row++)
    for (ptrdiff_t k = 0; k < element->properties.count; k++)
      if (!ply_skip_property(ply, &element->properties.item[k])) return false;
  return true;
}

static bool check_header(const struct ply *ply, const struct ply_element *vertex,
                         const struct ply_element *face) {
  if (!vertex || vertex->count == 0) return ply_complain(ply, "it has no vertices");
  if (!face || face->count == 0) return ply_complain(ply, "it has no faces");
  return vertex->count < UINT32_MAX || ply_complain(ply, "it has more than 2^32 - 2 vertices");
}

// Bytes after the last row are left alone, as pbrt's reader does.
bool mesh_read_ply(const char *file, struct text bytes, struct arena *arena, struct arena scratch,
                   struct mesh *mesh, struct problem *problem) {
  *mesh = (struct mesh){0};
  if (gzip_is(bytes) && !gzip_expand(file, bytes, &scratch, &bytes, problem)) return false;
  struct ply ply = {.file = file, .begin = bytes.data, .at = bytes.data, .problem = problem};
  ply.end = bytes.data + bytes.length;
  if (!ply_read_header(&ply, &scratch)) return false;
  const struct ply_element *vertex = find_element(&ply, "vertex"),
                           *face = find_element(&ply, "face");
  if (!check_header(&ply, vertex, face)) return false;
  mesh->n_vertices = (uint32_t)vertex->count;
  for (ptrdiff_t k = 0; k < ply.elements.count; k++) {
    const struct ply_element *element = &ply.elements.item[k];
    if (!check_rows(&ply, element)) return false;
    bool ok = element == vertex ? read_vertices(&ply, element, arena, scratch, mesh)
              : element == face ? read_faces(&ply, element, arena, mesh)
                                : skip_rows(&ply, element);
    if (!ok) return false;
  }
  return true;
}
