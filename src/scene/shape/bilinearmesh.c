// Shape "bilinearmesh": `point3 P`, `integer indices` (four for each patch: p00, p10, p01, p11; may
// be absent for one patch), `normal N`, `point2 uv`. The geometric normal is dp/du x dp/dv, with
// the rules of triangles for its side.
#include "scene/shape/gauss.h"
#include "scene/shape/mesh_params.h"
#include "scene/shape/patch.h"

static bool read(struct scene_builder *builder, struct params *params) {
  struct mesh mesh;
  ptrdiff_t n_indices, n_faces;
  if (!mesh_params_vertices(params, &mesh) || !mesh_params_attributes(params, &mesh)) return false;
  uint32_t *index = mesh_params_indices(params, 4, mesh.n_vertices, builder->arena, &n_indices);
  params_array(params, "integer", "faceIndices", &n_faces);
  if (!index || !params_finish(params)) return false;
  for (ptrdiff_t k = 0; k < n_indices; k += 4) { // a mesh's quads go around
    uint32_t p01 = index[k + 2];
    index[k + 2] = index[k + 3], index[k + 3] = p01;
  }
  mesh.quad = (uint32_t(*)[4])index;
  mesh.n_quads = (uint32_t)(n_indices / 4);
  return scene_add_mesh(builder, params, &mesh);
}

static struct box bounds(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  float vertex[4][3];
  patch_gather(scene, shape, primitive, vertex);
  return patch_box(vertex); // the patch lies in the hull of its corners
}

static struct patch gather(const struct scene *scene, const struct shape *shape,
                           uint32_t primitive) {
  float vertex[4][3];
  patch_gather(scene, shape, primitive, vertex);
  return patch_of(vertex);
}

static struct vec point(const struct patch *patch, double u, double v) {
  struct vec p = vec_along(vec_along(patch->p00, patch->e10, u), patch->e00, v);
  return vec_along(p, patch->twist, u * v);
}

static struct vec along_u(const struct patch *patch, double v) {
  return vec_along(patch->e10, patch->twist, v);
}

static struct vec along_v(const struct patch *patch, double u) {
  return vec_along(patch->e00, patch->twist, u);
}

// dp/du x dp/dv: as long as the area du dv covers, and linear in u and v.
static struct vec cross(const struct patch *patch, double u, double v) {
  return vec_cross(along_u(patch, v), along_v(patch, u));
}

// ---- from a point back to u, v ----
static double clamp(double x) { return x > 0 ? (x < 1 ? x : 1) : 0; }

// A Gauss-Newton step towards the point of the patch closest to p.
static void approach(const struct patch *patch, struct vec p, double *u, double *v) {
  struct vec du = along_u(patch, *v), dv = along_v(patch, *u), n = vec_cross(du, dv);
  double n2 = vec_dot(n, n);
  if (!(n2 > 0)) return;
  struct vec rest = vec_sub(p, point(patch, *u, *v));
  *u = clamp(*u + vec_dot(vec_cross(rest, dv), n) / n2);
  *v = clamp(*v + vec_dot(vec_cross(du, rest), n) / n2);
}

// v of the line of constant u, and how far (squared) p then is from the patch.
static double fit(const struct patch *patch, struct vec p, double *u, double *v) {
  *u = clamp(*u);
  struct vec along = along_v(patch, *u), rest = vec_sub(p, point(patch, *u, 0));
  *v = clamp(vec_dot(rest, along) / vec_dot(along, along));
  rest = vec_sub(p, point(patch, *u, *v));
  return vec_dot(rest, rest);
}

// p - p00 - u e10 and e00 + u twist are parallel: their cross product is a quadratic in u, solved
// across the diagonals. The steps then take out what p is off the patch, by rounding.
static void invert(const struct patch *patch, struct vec p, double *u, double *v) {
  struct vec r = vec_sub(p, patch->p00);
  struct vec axis = vec_cross(vec_add(vec_add(patch->e10, patch->e00), patch->twist),
                              vec_sub(patch->e00, patch->e10));
  double a = vec_dot(axis, vec_cross(r, patch->e00));
  double b = vec_dot(axis, vec_sub(vec_cross(r, patch->twist), vec_cross(patch->e10, patch->e00)));
  double c = -vec_dot(axis, vec_cross(patch->e10, patch->twist));
  double root[2] = {0.5, 0.5}, other;
  if (!patch_roots(a, b, c, root)) root[0] = root[1] = -b / (2 * c); // touching, but for rounding
  double near = fit(patch, p, &root[0], v), far = fit(patch, p, &root[1], &other);
  *u = root[0];
  if (far < near || !(near >= 0)) *u = root[1], *v = other;
  approach(patch, p, u, v);
  approach(patch, p, u, v);
}

// ---- normals, texture coordinates ----
// The interpolation of four corners' values.
static double blend(const double corner[4], double u, double v) {
  return (1 - u) * ((1 - v) * corner[0] + v * corner[2]) +
         u * ((1 - v) * corner[1] + v * corner[3]);
}

static struct vec interpolated_normal(const struct scene *scene, const struct shape *shape,
                                      uint32_t primitive, double u, double v) {
  const uint32_t *row = scene->patch[shape->local + (primitive - shape->first)];
  double n[3], corner[4];
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 4; i++)
      corner[i] = (double)scene->normal[shape->normal + (row[i] - shape->vertex)][k];
    n[k] = blend(corner, u, v);
  }
  return vec(n[0], n[1], n[2]);
}

// At a corner without an angle the normal is that of the diagonals.
static struct vec normal_at(const struct scene *scene, const struct shape *shape,
                            uint32_t primitive, const struct patch *patch, double u, double v) {
  struct vec n = cross(patch, u, v);
  if (!(vec_dot(n, n) > 0))
    n = vec_cross(vec_add(vec_add(patch->e10, patch->e00), patch->twist),
                  vec_sub(patch->e00, patch->e10));
  double length = vec_length(n);
  if (!(length > 0)) return vec(0, 0, 0); // without area it is never hit
  n = vec_scale(n, (shape->flip ? -1 : 1) / length);
  if (shape->normal == ROW_NONE) return n;
  struct vec ns = interpolated_normal(scene, shape, primitive, u, v);
  return vec_dot(n, ns) < 0 ? vec_scale(n, -1) : n;
}

static struct vec normal(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                         struct vec p) {
  struct patch patch = gather(scene, shape, primitive);
  double u, v;
  invert(&patch, p, &u, &v);
  return normal_at(scene, shape, primitive, &patch, u, v);
}

// The vertices' s, t at u, v and dp/ds by the inverse of their derivatives. (pbrt-v4 inverts each
// derivative for itself, which is the same where s and t follow u and v or v and u.)
static void map_texture(const struct scene *scene, const struct shape *shape,
                        const struct patch *patch, double u, double v, struct surface *surface) {
  const uint32_t *row = scene->patch[shape->local + (surface->primitive - shape->first)];
  double du[2], dv[2];
  for (int k = 0; k < 2; k++) {
    double c[4];
    for (int i = 0; i < 4; i++) c[i] = (double)scene->uv[shape->uv + (row[i] - shape->vertex)][k];
    surface->uv[k] = blend(c, u, v);
    du[k] = (1 - v) * (c[1] - c[0]) + v * (c[3] - c[2]);
    dv[k] = (1 - u) * (c[2] - c[0]) + u * (c[3] - c[1]);
  }
  double determinant = du[0] * dv[1] - dv[0] * du[1];
  struct vec dpds = vec_along(vec_scale(along_u(patch, v), dv[1]), along_v(patch, u), -du[1]);
  surface->dpdu = determinant != 0 ? vec_scale(dpds, 1 / determinant) : vec(0, 0, 0);
}

static void detail(const struct scene *scene, const struct shape *shape, struct surface *surface) {
  struct patch patch = gather(scene, shape, surface->primitive);
  double u, v;
  invert(&patch, surface->p, &u, &v);
  surface->uv[0] = u, surface->uv[1] = v;
  surface->dpdu = along_u(&patch, v);
  if (shape->uv != ROW_NONE) map_texture(scene, shape, &patch, u, v, surface);
  if (shape->normal == ROW_NONE) return;
  struct vec ns = interpolated_normal(scene, shape, surface->primitive, u, v);
  double length = vec_length(ns);
  if (length > 0) surface->ns = vec_scale(ns, 1 / length);
}

// ---- area and samples ----
// Exact for plane patches that do not fold, but for rounding.
static double area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  struct patch patch = gather(scene, shape, primitive);
  double sum = 0;
  for (int i = 0; i < GAUSS_POINTS; i++)
    for (int j = 0; j < GAUSS_POINTS; j++)
      sum += gauss_weight[i] * gauss_weight[j] *
             vec_length(cross(&patch, gauss_node[i], gauss_node[j]));
  return sum;
}

// What samples are drawn from: the area at the corners, bilinear between them.
static void corner_areas(const struct patch *patch, double w[4]) {
  for (int i = 0; i < 4; i++) w[i] = vec_length(cross(patch, i % 2, i / 2));
}

// x in [0, 1] with a density that goes linearly from w0 to w1.
static double sample_linear(double u, double w0, double w1) {
  return u * (w0 + w1) / (w0 + sqrt((1 - u) * w0 * w0 + u * w1 * w1));
}

static void sample(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                   double u0, double u1, struct vec *p, struct vec *ng) {
  struct patch patch = gather(scene, shape, primitive);
  double w[4];
  corner_areas(&patch, w);
  double u = u0 > 0 ? clamp(sample_linear(u0, w[0] + w[2], w[1] + w[3])) : 0;
  double w0 = (1 - u) * w[0] + u * w[1], w1 = (1 - u) * w[2] + u * w[3];
  double v = u1 > 0 ? clamp(sample_linear(u1, w0, w1)) : 0;
  *p = point(&patch, u, v);
  *ng = normal_at(scene, shape, primitive, &patch, u, v);
}

static double density(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                      struct vec p) {
  struct patch patch = gather(scene, shape, primitive);
  double u, v, w[4];
  invert(&patch, p, &u, &v);
  corner_areas(&patch, w);
  double mean = (w[0] + w[1] + w[2] + w[3]) / 4;
  return blend(w, u, v) / (mean * vec_length(cross(&patch, u, v))) * area(scene, shape, primitive);
}

const struct shape_type shape_bilinearmesh = {
    .name = "bilinearmesh",
    .about = "bilinear patches from points and indices, with normals and uv",
    .flat = false,
    .read = read,
    .bounds = bounds,
    .intersect = patch_intersect,
    .detail = detail,
    .normal = normal,
    .area = area,
    .sample = sample,
    .density = density,
};
