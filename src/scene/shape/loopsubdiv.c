// Shape "loopsubdiv": `point3 P`, `integer indices`, `integer levels` [3]: the limit surface of
// Loop subdivision, with its normals (mesh/subdivide.c). `string scheme` [loop] is pbrt's only one.
#include "scene/shape/mesh_params.h"
#include "scene/shape/triangle.h"

#include <string.h>

static bool subdivide(struct scene_builder *builder, struct params *params, const struct mesh *cage,
                      int levels, struct arena fine_memory, struct arena scratch) {
  struct mesh fine;
  struct problem problem = {0};
  if (!mesh_subdivide(cage, levels, &fine_memory, scratch, &fine, &problem))
    return params_complain(params, "indices", "%s", problem.text);
  return scene_add_mesh(builder, params, &fine);
}

static bool read(struct scene_builder *builder, struct params *params) {
  struct mesh cage;
  ptrdiff_t n_indices;
  if (!mesh_params_vertices(params, &cage)) return false;
  int64_t levels = params_integer(params, "levels", 3);
  uint32_t *index = mesh_params_indices(params, 3, cage.n_vertices, builder->arena, &n_indices);
  if (strcmp(params_string(params, "scheme", "loop"), "loop") != 0)
    params_complain(params, "scheme", "the only scheme is \"loop\"");
  if (!(levels >= 0 && levels < 16)) // 4^16 triangles would be too many
    params_complain(params, "levels", "levels must be 0 to 15");
  if (!index || !params_finish(params)) return false;
  cage.triangle = (uint32_t(*)[3])index;
  cage.n_triangles = (uint32_t)(n_indices / 3);
  struct arena fine_memory = arena_reserve(), scratch = arena_reserve();
  bool ok = subdivide(builder, params, &cage, (int)levels, fine_memory, scratch);
  arena_release(fine_memory);
  arena_release(scratch);
  return ok;
}

const struct shape_type shape_loopsubdiv = {
    .name = "loopsubdiv",
    .about = "the limit surface of a triangle mesh under Loop subdivision",
    .flat = true,
    .read = read,
    .bounds = triangle_bounds,
    .intersect = triangle_intersect,
    .detail = triangle_detail,
    .normal = triangle_normal,
    .area = triangle_area,
    .sample = triangle_sample,
};
