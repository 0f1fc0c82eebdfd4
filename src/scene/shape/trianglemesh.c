// Shape "trianglemesh": `point3 P`, `integer indices` (which may be absent for one triangle),
// `normal N`, `vector3 S` (tangents), `point2 uv`. `faceIndices`, which only Ptex textures read,
// mean nothing here.
#include "scene/shape/mesh_params.h"
#include "scene/shape/triangle.h"

static bool read(struct scene_builder *builder, struct params *params) {
  struct mesh mesh;
  ptrdiff_t n_indices, n_faces;
  if (!mesh_params_vertices(params, &mesh) || !mesh_params_attributes(params, &mesh)) return false;
  mesh.s = (double(*)[3])mesh_params_per_vertex(params, "vector3", "S", 3, mesh.n_vertices);
  uint32_t *index = mesh_params_indices(params, 3, mesh.n_vertices, builder->arena, &n_indices);
  params_array(params, "integer", "faceIndices", &n_faces);
  if (!index || !params_finish(params)) return false;
  mesh.triangle = (uint32_t(*)[3])index;
  mesh.n_triangles = (uint32_t)(n_indices / 3);
  return scene_add_mesh(builder, params, &mesh);
}

const struct shape_type shape_trianglemesh = {
    .name = "trianglemesh",
    .about = "triangles from points and indices, with normals and uv",
    .flat = true,
    .read = read,
    .bounds = triangle_bounds,
    .intersect = triangle_intersect,
    .detail = triangle_detail,
    .normal = triangle_normal,
    .area = triangle_area,
    .sample = triangle_sample,
};
