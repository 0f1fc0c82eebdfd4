// Shape "plymesh": `string filename`, a PLY file of triangles and quads, with normals and uv if it
// has them (mesh/mesh.h). Quads are bilinear patches, as in pbrt-v4.
#include "mesh/mesh.h"
#include "scene/read.h"
#include "scene/shape/triangle.h"

static bool read_file(struct scene_builder *builder, struct params *params, const char *filename,
                      struct arena mesh_memory, struct arena scratch) {
  struct text bytes;
  struct mesh mesh;
  struct problem problem = {0};
  if (!scene_read_file(builder, params, "filename", filename, &scratch, &bytes)) return false;
  if (!mesh_read_ply(filename, bytes, &mesh_memory, scratch, &mesh, &problem))
    return params_complain(params, "filename", "%s", problem.text);
  return scene_add_mesh(builder, params, &mesh);
}

static bool read(struct scene_builder *builder, struct params *params) {
  const char *filename = params_string(params, "filename", NULL);
  if (!params_finish(params)) return false;
  if (!filename) return params_complain(params, "filename", "\"string filename\" is missing");
  // What the file holds is needed only until the scene has it.
  struct arena mesh_memory = arena_reserve(), scratch = arena_reserve();
  bool ok = read_file(builder, params, filename, mesh_memory, scratch);
  arena_release(mesh_memory);
  arena_release(scratch);
  return ok;
}

const struct shape_type shape_plymesh = {
    .name = "plymesh",
    .about = "triangles and quads of a PLY file",
    .flat = true,
    .read = read,
    .bounds = triangle_bounds,
    .intersect = triangle_intersect,
    .detail = triangle_detail,
    .normal = triangle_normal,
    .area = triangle_area,
    .sample = triangle_sample,
};
