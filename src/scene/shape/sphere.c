// Shape "sphere": `float radius` [1], `zmin` [-radius], `zmax` [radius], `phimax` [360], as
// pbrt-v4.
#include "scene/shape/sphere.h"
#include "scene/shape/quadric.h"

// The point of the sphere at these shares of its height and sweep; uniform in them (Archimedes).
static struct vec point(const struct quadric *q, double u0, double u1) {
  double z = q->z_min + u0 * (q->z_max - q->z_min), cosine, sine;
  if (z > q->z_max) z = q->z_max; // the sum may round up past it
  double r = sqrt((q->radius - z) * (q->radius + z));
  quadric_angle(q, u1, &cosine, &sine);
  return vec(r * cosine, r * sine, z);
}

static double stretch_at(const struct quadric *q, struct vec p) {
  return quadric_stretch(q, vec_scale(p, 1 / q->radius));
}

static double stretch(const struct quadric *q, double u0, double u1) {
  return stretch_at(q, point(q, u0, u1));
}

static bool read(struct scene_builder *builder, struct params *params) {
  struct quadric q = {.radius = quadric_read_radius(params),
                      .phi_max = quadric_read_phi_max(params)};
  q.z_min = params_float(params, "zmin", -q.radius);
  q.z_max = params_float(params, "zmax", q.radius);
  if (!(q.z_min >= -q.radius && q.z_min < q.radius))
    params_complain(params, "zmin", "zmin must be in [-radius, radius)");
  if (!(q.z_max > q.z_min && q.z_max <= q.radius))
    params_complain(params, "zmax", "zmax must be in (zmin, radius]");
  if (!params_finish(params)) return false;
  if (!quadric_is_even(&builder->world_from_object, true))
    q.mean_stretch = quadric_mean_stretch(builder, q, stretch);
  return scene_add_quadric(builder, params, &q);
}

// Exact for a whole sphere under any affine map: half the extent is the radius times the length of
// the matrix row. Of a part, also within the transformed box of the part's z.
static struct box bounds(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  const struct transform *t = &q->world_from_object;
  double half[3];
  for (int i = 0; i < 3; i++)
    half[i] = q->radius * vec_length(vec(t->m[i][0], t->m[i][1], t->m[i][2]));
  struct vec center = vec(t->m[0][3], t->m[1][3], t->m[2][3]),
             extent = vec(half[0], half[1], half[2]);
  struct box whole = box_around(center, extent, vec_add(box_terms(t, vec(0, 0, 0)), extent));
  if (q->z_min == -q->radius && q->z_max == q->radius) return whole;
  struct box slice =
      box_transform(t, vec(-q->radius, -q->radius, q->z_min), vec(q->radius, q->radius, q->z_max));
  return box_intersection(whole, slice);
}

static struct vec normal(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                         struct vec p) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  return quadric_normal(q, shape, transform_point(&q->object_from_world, p));
}

// v goes with the polar angle, from zmin to zmax.
static void detail(const struct scene *scene, const struct shape *shape, struct surface *surface) {
  const struct quadric *q = quadric_of(scene, shape);
  double z = quadric_detail(q, surface).z / q->radius;
  double theta = num_acos(z < -1 ? -1 : z > 1 ? 1 : z); // p is rounded
  double first = num_acos(q->z_min / q->radius), last = num_acos(q->z_max / q->radius);
  surface->uv[1] = (theta - first) / (last - first);
}

static double area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  const struct transform *t = &q->world_from_object;
  double object_area = q->radius * q->phi_max * (q->z_max - q->z_min);
  if (q->mean_stretch > 0) return q->mean_stretch * object_area;
  struct vec x = transform_direction(t, vec(1, 0, 0)), y = transform_direction(t, vec(0, 1, 0)),
             z = transform_direction(t, vec(0, 0, 1));
  double scale2 = (vec_dot(x, x) + vec_dot(y, y) + vec_dot(z, z)) / 3;
  return scale2 * object_area;
}

static void sample(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                   double u0, double u1, struct vec *p, struct vec *ng) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  struct vec at = point(q, u0, u1);
  *p = transform_point(&q->world_from_object, at);
  *ng = quadric_normal(q, shape, at);
}

// Uniform on the sphere, then stretched with it.
static double density(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                      struct vec p) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  if (!(q->mean_stretch > 0)) return 1;
  return q->mean_stretch / stretch_at(q, transform_point(&q->object_from_world, p));
}

const struct shape_type shape_sphere = {
    .name = "sphere",
    .about = "a sphere around the origin, or the part of it between zmin and zmax up to phimax",
    .flat = false,
    .read = read,
    .bounds = bounds,
    .intersect = sphere_intersect,
    .detail = detail,
    .normal = normal,
    .area = area,
    .sample = sample,
    .density = density,
};
