// Shape "trianglemesh": `point3 P` and `integer indices` (which may be absent for one triangle).
// The geometric normal is pbrt's: (p0 - p2) x (p1 - p2).
#include "scene/read.h"
#include "scene/shape/triangle.h"

#include <string.h>

static bool read(struct scene_builder *builder, struct params *params) {
  static const double only_triangle[3] = {0, 1, 2};
  static const char *const later[] = {"N", "uv", "S", "st"};
  for (int k = 0; k < params->count; k++)
    for (int j = 0; j < 4; j++)
      if (strcmp(params->item[k].name, later[j]) == 0)
        return params_complain(params, later[j],
                               "\"%s\" is not in this version (no shading normals, no textures); "
                               "take it out",
                               later[j]);
  ptrdiff_t n_numbers, n_indices;
  const double *index = params_array(params, "integer", "indices", &n_indices);
  const double *point = params_array(params, "point3", "P", &n_numbers);
  if (!params_finish(params)) return false;
  if (!point) return params_complain(params, "P", "\"point3 P\" is missing");
  if (!index && n_numbers != 9)
    return params_complain(params, "P", "\"integer indices\" is missing");
  if (n_indices % 3)
    return params_complain(params, "indices", "%td indices are not a multiple of 3", n_indices);
  ptrdiff_t n_vertices = n_numbers / 3, n_triangles = index ? n_indices / 3 : 1;
  if (n_vertices >= UINT32_MAX || n_triangles >= UINT32_MAX)
    return params_complain(params, "P", "more than 2^32 vertices or triangles");
  return scene_add_triangles(builder, params, (const double(*)[3])point, (uint32_t)n_vertices,
                             index ? index : only_triangle, (uint32_t)n_triangles);
}

static struct box bounds(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  float vertex[3][3];
  triangle_gather(scene, shape, primitive, vertex);
  return triangle_box(vertex);
}

// Twice the area long, before the flip.
static struct vec cross(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  float vertex[3][3];
  triangle_gather(scene, shape, primitive, vertex);
  return triangle_cross(vertex);
}

// A triangle without area is never hit, so its normal (zero) is never asked for.
static struct vec normal(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                         struct vec p) {
  (void)p;
  struct vec n = cross(scene, shape, primitive);
  double length = vec_length(n);
  return length > 0 ? vec_scale(n, (shape->flip ? -1 : 1) / length) : vec(0, 0, 0);
}

static double area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  return 0.5 * vec_length(cross(scene, shape, primitive));
}

// Barycentric (1 - s, s (1 - u1), s u1), s = sqrt(u0): a line across p0 in proportion to its
// length, then a point of the line.
static void sample(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                   double u0, double u1, struct vec *p, struct vec *ng) {
  float vertex[3][3];
  triangle_gather(scene, shape, primitive, vertex);
  struct vec p0 = triangle_vertex(vertex[0]), p1 = triangle_vertex(vertex[1]),
             p2 = triangle_vertex(vertex[2]);
  double s = sqrt(u0);
  *p = vec_along(vec_along(p0, vec_sub(p1, p0), s * (1 - u1)), vec_sub(p2, p0), s * u1);
  *ng = normal(scene, shape, primitive, *p);
}

const struct shape_type shape_trianglemesh = {
    .name = "trianglemesh",
    .about = "triangles from points and indices",
    .flat = true,
    .read = read,
    .bounds = bounds,
    .intersect = triangle_intersect,
    .normal = normal,
    .area = area,
    .sample = sample,
};
