// Meshes go into the scene's arrays: vertices and normals in world space, triangles and patches.
#include "mesh/mesh.h"
#include "scene/build.h"

#include <assert.h>
#include <float.h>

static bool is_float(double x) { return x >= -(double)FLT_MAX && x <= (double)FLT_MAX; }

static bool add_positions(struct scene_builder *builder, struct params *params,
                          const struct mesh *mesh) {
  struct scene *scene = builder->scene;
  scene->position = build_grow(builder->arena, scene->position, scene->n_positions,
                               mesh->n_vertices, sizeof *scene->position);
  for (uint32_t k = 0; k < mesh->n_vertices; k++) {
    const double *from = mesh->p[k];
    struct vec p = transform_point(&builder->world_from_object, vec(from[0], from[1], from[2]));
    if (!is_float(p.x) || !is_float(p.y) || !is_float(p.z))
      return params_complain(params, "P", "vertex %u is too far away for a float", k);
    float *to = scene->position[scene->n_positions + k];
    to[0] = (float)p.x, to[1] = (float)p.y, to[2] = (float)p.z;
  }
  scene->n_positions += mesh->n_vertices;
  return true;
}

// How normals go to world space: by the inverse's transpose, turned by ReverseOrientation.
static struct transform normal_transform(const struct scene_builder *builder) {
  struct transform inverse, t = transform_identity();
  transform_invert(builder->world_from_object, &inverse); // the reader checked it
  double sign = builder->reverse_orientation ? -1 : 1;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.m[i][j] = sign * inverse.m[j][i];
  return t;
}

static struct vec world_vector(const struct transform *to_world, const double v[3]) {
  return transform_direction(to_world, vec(v[0], v[1], v[2]));
}

// Appends vectors of vertices to `array`; the row of the first. pbrt interpolates them as long as
// they come, so lengths keep their ratios; divided by the largest they fit into floats.
static uint32_t add_vectors(struct scene_builder *builder, const struct transform *to_world,
                            double (*from)[3], uint32_t n, float (**array)[3], uint32_t *count) {
  uint32_t first = *count;
  double longest = 0;
  for (uint32_t k = 0; k < n; k++) {
    double length = vec_length(world_vector(to_world, from[k]));
    if (length > longest && length < INFINITY) longest = length;
  }
  *array = build_grow(builder->arena, *array, first, n, sizeof **array);
  for (uint32_t k = 0; k < n; k++) {
    struct vec v = world_vector(to_world, from[k]);
    v = longest > 0 ? vec_scale(v, 1 / longest) : vec(0, 0, 0);
    float *to = (*array)[first + k];
    to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z;
  }
  *count += n;
  return first;
}

static bool add_uvs(struct scene_builder *builder, struct params *params, const struct mesh *mesh,
                    struct shape *shape) {
  struct scene *scene = builder->scene;
  scene->uv =
      build_grow(builder->arena, scene->uv, scene->n_uvs, mesh->n_vertices, sizeof *scene->uv);
  for (uint32_t k = 0; k < mesh->n_vertices; k++)
    for (int j = 0; j < 2; j++) {
      if (!is_float(mesh->uv[k][j]))
        return params_complain(params, "uv", "uv of vertex %u is too large for a float", k);
      scene->uv[scene->n_uvs + k][j] = (float)mesh->uv[k][j];
    }
  shape->uv = scene->n_uvs;
  scene->n_uvs += mesh->n_vertices;
  return true;
}

static void add_triangles(struct scene_builder *builder, const struct mesh *mesh,
                          struct shape *shape) {
  struct scene *scene = builder->scene;
  scene->triangle = build_grow(builder->arena, scene->triangle, scene->n_triangles,
                               mesh->n_triangles, sizeof *scene->triangle);
  for (uint32_t k = 0; k < mesh->n_triangles; k++)
    for (int j = 0; j < 3; j++) {
      assert(mesh->triangle[k][j] < mesh->n_vertices);
      scene->triangle[scene->n_triangles + k][j] = shape->vertex + mesh->triangle[k][j];
    }
  shape->local = scene->n_triangles;
  shape->count = mesh->n_triangles;
  scene->n_triangles += mesh->n_triangles;
  scene->n_primitives += mesh->n_triangles;
}

// From around the face to p00, p10, p01, p11.
static void add_patches(struct scene_builder *builder, const struct mesh *mesh,
                        struct shape *shape) {
  static const int around[4] = {0, 1, 3, 2};
  struct scene *scene = builder->scene;
  scene->patch = build_grow(builder->arena, scene->patch, scene->n_patches, mesh->n_quads,
                            sizeof *scene->patch);
  for (uint32_t k = 0; k < mesh->n_quads; k++)
    for (int j = 0; j < 4; j++) {
      assert(mesh->quad[k][around[j]] < mesh->n_vertices);
      scene->patch[scene->n_patches + k][j] = shape->vertex + mesh->quad[k][around[j]];
    }
  shape->local = scene->n_patches;
  shape->count = mesh->n_quads;
  scene->n_patches += mesh->n_quads;
  scene->n_primitives += mesh->n_quads;
}

bool scene_add_mesh(struct scene_builder *builder, struct params *params, const struct mesh *mesh) {
  extern const struct shape_type shape_bilinearmesh;
  struct scene *scene = builder->scene;
  uint64_t n_primitives = (uint64_t)mesh->n_triangles + mesh->n_quads;
  if (!build_check_room(params, scene->n_positions, mesh->n_vertices)) return false;
  if (!build_check_room(params, scene->n_primitives, n_primitives)) return false;
  struct shape *shape = &scene->shape[scene->n_shapes - 1];
  shape->vertex = scene->n_positions;
  if (!add_positions(builder, params, mesh)) return false;
  struct transform normal_to_world = normal_transform(builder);
  if (mesh->n)
    shape->normal = add_vectors(builder, &normal_to_world, mesh->n, mesh->n_vertices,
                                &scene->normal, &scene->n_normals);
  if (mesh->s)
    shape->tangent = add_vectors(builder, &builder->world_from_object, mesh->s, mesh->n_vertices,
                                 &scene->tangent, &scene->n_tangents);
  if (mesh->uv && !add_uvs(builder, params, mesh, shape)) return false;
  if (mesh->n_triangles) add_triangles(builder, mesh, shape);
  if (!mesh->n_quads) return true;
  if (mesh->n_triangles) { // a shape of its own beside the triangles
    struct shape both = *shape;
    build_begin_shape(builder, both.type, both.material, both.flip);
    shape = &scene->shape[scene->n_shapes - 1];
    shape->vertex = both.vertex, shape->normal = both.normal, shape->uv = both.uv;
    shape->tangent = both.tangent, shape->alpha = both.alpha;
    shape->inside = both.inside, shape->outside = both.outside;
  }
  shape->type = &shape_bilinearmesh;
  add_patches(builder, mesh, shape);
  return true;
}
