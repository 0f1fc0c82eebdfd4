// What trianglemesh, plymesh and loopsubdiv share. The geometric normal is pbrt's, (p0 - p2) x (p1
// - p2), turned to the side of the interpolated normal where the vertices have normals, else
// reversed by ReverseOrientation xor a mirrored matrix. A triangle without area is never hit: it
// has no normal. Where a mesh needs one to be closed (a vertex in the middle of another triangle's
// edge), a gap as wide as the rounding of that vertex's projection stays open, 2^-52 of its
// distance from the ray's origin.
#include "scene/shape/triangle.h"

static const uint32_t *triangle_row(const struct scene *scene, const struct shape *shape,
                                    uint32_t primitive) {
  return scene->triangle[shape->local + (primitive - shape->first)];
}

struct box triangle_bounds(const struct scene *scene, const struct shape *shape,
                           uint32_t primitive) {
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

double triangle_area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  return 0.5 * vec_length(cross(scene, shape, primitive));
}

// Barycentric coordinates of p, which lies in the triangle but for rounding: with n = e0 x e1, e_i
// = p_i - p2 and p - p2 = b0 e0 + b1 e1, they are b0 n = (p - p2) x e1 and b1 n = e0 x (p - p2).
static void barycentric(const float vertex[3][3], struct vec p, double b[3]) {
  struct vec p2 = triangle_vertex(vertex[2]), v = vec_sub(p, p2);
  struct vec e0 = vec_sub(triangle_vertex(vertex[0]), p2),
             e1 = vec_sub(triangle_vertex(vertex[1]), p2), n = vec_cross(e0, e1);
  double n2 = vec_dot(n, n);
  b[0] = vec_dot(vec_cross(v, e1), n) / n2;
  b[1] = vec_dot(vec_cross(e0, v), n) / n2;
  b[2] = 1 - b[0] - b[1];
}

// Vectors of the vertices, `vector` of the shape's first, interpolated: not of unit length, zero
// where they cancel.
static struct vec interpolate(const float (*vector)[3], const struct shape *shape,
                              const uint32_t row[3], const double b[3]) {
  struct vec sum = vec(0, 0, 0);
  for (int i = 0; i < 3; i++)
    sum = vec_along(sum, triangle_vertex(vector[row[i] - shape->vertex]), b[i]);
  return sum;
}

static struct vec interpolated_normal(const struct scene *scene, const struct shape *shape,
                                      const uint32_t row[3], const double b[3]) {
  return interpolate((const float(*)[3])scene->normal + shape->normal, shape, row, b);
}

struct vec triangle_normal(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                           struct vec p) {
  if (shape->faceted) return scene->facet[primitive];
  float vertex[3][3];
  triangle_gather(scene, shape, primitive, vertex);
  struct vec n = triangle_cross(vertex);
  double length = vec_length(n), b[3];
  if (!(length > 0)) return vec(0, 0, 0); // never hit
  n = vec_scale(n, (shape->flip ? -1 : 1) / length);
  if (shape->normal == ROW_NONE) return n;
  barycentric(vertex, p, b);
  struct vec ns = interpolated_normal(scene, shape, triangle_row(scene, shape, primitive), b);
  return vec_dot(n, ns) < 0 ? vec_scale(n, -1) : n;
}

// The vertices' uv, or pbrt's for triangles that have none.
static void gather_uv(const struct scene *scene, const struct shape *shape, const uint32_t row[3],
                      double uv[3][2]) {
  static const double none[3][2] = {{0, 0}, {1, 0}, {1, 1}};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++)
      uv[i][k] = shape->uv == ROW_NONE ? none[i][k]
                                       : (double)scene->uv[shape->uv + (row[i] - shape->vertex)][k];
}

// Zero where uv does not tell points apart.
static struct vec derivative(const float vertex[3][3], const double uv[3][2]) {
  struct vec p2 = triangle_vertex(vertex[2]);
  struct vec dp0 = vec_sub(triangle_vertex(vertex[0]), p2),
             dp1 = vec_sub(triangle_vertex(vertex[1]), p2);
  double v0 = uv[0][1] - uv[2][1], v1 = uv[1][1] - uv[2][1];
  double determinant = (uv[0][0] - uv[2][0]) * v1 - v0 * (uv[1][0] - uv[2][0]);
  if (determinant == 0) return vec(0, 0, 0);
  return vec_scale(vec_along(vec_scale(dp0, v1), dp1, -v0), 1 / determinant);
}

void triangle_detail(const struct scene *scene, const struct shape *shape,
                     struct surface *surface) {
  const uint32_t *row = triangle_row(scene, shape, surface->primitive);
  float vertex[3][3];
  double b[3], uv[3][2];
  triangle_gather(scene, shape, surface->primitive, vertex);
  barycentric(vertex, surface->p, b);
  gather_uv(scene, shape, row, uv);
  for (int k = 0; k < 2; k++) surface->uv[k] = b[0] * uv[0][k] + b[1] * uv[1][k] + b[2] * uv[2][k];
  surface->dpdu = derivative(vertex, uv);
  if (shape->tangent != ROW_NONE) {
    struct vec s = interpolate((const float(*)[3])scene->tangent + shape->tangent, shape, row, b);
    if (vec_dot(s, s) > 0) surface->dpdu = s;
  }
  if (shape->normal == ROW_NONE) return;
  struct vec ns = interpolated_normal(scene, shape, row, b);
  double length = vec_length(ns);
  if (length > 0) surface->ns = vec_scale(ns, 1 / length);
}

// Barycentric (1 - s, s (1 - u1), s u1), s = sqrt(u0): a line across p0 in proportion to its
// length, then a point of the line.
void triangle_sample(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                     double u0, double u1, struct vec *p, struct vec *ng) {
  float vertex[3][3];
  triangle_gather(scene, shape, primitive, vertex);
  struct vec p0 = triangle_vertex(vertex[0]), p1 = triangle_vertex(vertex[1]),
             p2 = triangle_vertex(vertex[2]);
  double s = sqrt(u0);
  *p = vec_along(vec_along(p0, vec_sub(p1, p0), s * (1 - u1)), vec_sub(p2, p0), s * u1);
  *ng = triangle_normal(scene, shape, primitive, *p);
}
