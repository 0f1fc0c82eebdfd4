// Shape "cylinder": `float radius` [1], `zmin` [-1], `zmax` [1], `phimax` [360], around the z axis,
// open at both ends, facing outward, as pbrt-v4.
#include "scene/shape/cylinder.h"
#include "scene/shape/quadric.h"

// At the angle of p in object space.
static double stretch_at(const struct quadric *q, struct vec p) {
  return quadric_stretch(q, vec(p.x / q->radius, p.y / q->radius, 0));
}

static double stretch(const struct quadric *q, double u0, double u1) {
  (void)u0;
  double cosine, sine;
  quadric_angle(q, u1, &cosine, &sine);
  return quadric_stretch(q, vec(cosine, sine, 0));
}

static bool read(struct scene_builder *builder, struct params *params) {
  struct quadric q = {.radius = quadric_read_radius(params),
                      .phi_max = quadric_read_phi_max(params)};
  double a = params_float(params, "zmin", -1), b = params_float(params, "zmax", 1);
  q.z_min = a < b ? a : b, q.z_max = a < b ? b : a; // pbrt takes them in either order
  if (a == b) params_complain(params, "zmax", "zmin and zmax are equal");
  if (!params_finish(params)) return false;
  if (!quadric_is_even(&builder->world_from_object, false))
    q.mean_stretch = quadric_mean_stretch(builder, q, stretch);
  return scene_add_quadric(builder, params, &q);
}

// Exact under any affine map: the image of the circle at half height, moved along the axis.
static struct box bounds(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  const struct transform *t = &q->world_from_object;
  struct vec center = vec(0, 0, 0.5 * q->z_min + 0.5 * q->z_max);
  double half[3], half_height = 0.5 * q->z_max - 0.5 * q->z_min;
  for (int i = 0; i < 3; i++)
    half[i] =
        q->radius * vec_length(vec(t->m[i][0], t->m[i][1], 0)) + half_height * fabs(t->m[i][2]);
  struct vec extent = vec(half[0], half[1], half[2]);
  return box_around(transform_point(t, center), extent, vec_add(box_terms(t, center), extent));
}

static struct vec normal(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                         struct vec p) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  struct vec at = transform_point(&q->object_from_world, p);
  return quadric_normal(q, shape, vec(at.x, at.y, 0));
}

static void detail(const struct scene *scene, const struct shape *shape, struct surface *surface) {
  const struct quadric *q = quadric_of(scene, shape);
  struct vec p = quadric_detail(q, surface);
  surface->uv[1] = (p.z - q->z_min) / (q->z_max - q->z_min);
}

static double area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  double object_area = q->radius * q->phi_max * (q->z_max - q->z_min);
  if (q->mean_stretch > 0) return q->mean_stretch * object_area;
  struct vec x = transform_direction(&q->world_from_object, vec(1, 0, 0)),
             z = transform_direction(&q->world_from_object, vec(0, 0, 1));
  return vec_length(x) * vec_length(z) * object_area;
}

static void sample(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                   double u0, double u1, struct vec *p, struct vec *ng) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  double z = q->z_min + u0 * (q->z_max - q->z_min), cosine, sine;
  if (z > q->z_max) z = q->z_max; // the sum may round up past it
  quadric_angle(q, u1, &cosine, &sine);
  *p = transform_point(&q->world_from_object, vec(q->radius * cosine, q->radius * sine, z));
  *ng = quadric_normal(q, shape, vec(cosine, sine, 0));
}

// Uniform on the cylinder, then stretched with it.
static double density(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                      struct vec p) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  if (!(q->mean_stretch > 0)) return 1;
  return q->mean_stretch / stretch_at(q, transform_point(&q->object_from_world, p));
}

const struct shape_type shape_cylinder = {
    .name = "cylinder",
    .about = "a cylinder around the z axis, or the part of it up to phimax, without its ends",
    .flat = false,
    .read = read,
    .bounds = bounds,
    .intersect = cylinder_intersect,
    .detail = detail,
    .normal = normal,
    .area = area,
    .sample = sample,
    .density = density,
};
