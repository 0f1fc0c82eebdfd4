// Shape "disk": `float height` [0], `radius` [1], `innerradius` [0], `phimax` [360], as pbrt-v4.
// Facing +z. pbrt-v4's light sampling ignores innerradius and phimax; ours does not.
#include "scene/shape/disk.h"
#include "scene/shape/quadric.h"

static bool read(struct scene_builder *builder, struct params *params) {
  struct quadric q = {.radius = quadric_read_radius(params),
                      .phi_max = quadric_read_phi_max(params)};
  q.height = params_float(params, "height", 0);
  q.inner_radius = params_float(params, "innerradius", 0);
  if (!(q.inner_radius >= 0 && q.inner_radius < q.radius))
    params_complain(params, "innerradius", "innerradius must be in [0, radius)");
  return params_finish(params) && scene_add_quadric(builder, params, &q);
}

static struct box bounds(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  const struct transform *t = &q->world_from_object;
  struct vec center = vec(0, 0, q->height);
  double half[3];
  for (int i = 0; i < 3; i++) half[i] = q->radius * vec_length(vec(t->m[i][0], t->m[i][1], 0));
  struct vec extent = vec(half[0], half[1], half[2]);
  return box_around(transform_point(t, center), extent, vec_add(box_terms(t, center), extent));
}

static struct vec normal(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                         struct vec p) {
  (void)primitive, (void)p;
  return quadric_normal(quadric_of(scene, shape), shape, vec(0, 0, 1));
}

// v goes from the rim to the middle.
static void detail(const struct scene *scene, const struct shape *shape, struct surface *surface) {
  const struct quadric *q = quadric_of(scene, shape);
  struct vec p = quadric_detail(q, surface);
  surface->uv[1] = (q->radius - vec_length(vec(p.x, p.y, 0))) / (q->radius - q->inner_radius);
}

// A plane figure is stretched evenly by any affine map, so samples stay uniform.
static double area(const struct scene *scene, const struct shape *shape, uint32_t primitive) {
  (void)primitive;
  const struct quadric *q = quadric_of(scene, shape);
  struct vec x = transform_direction(&q->world_from_object, vec(1, 0, 0)),
             y = transform_direction(&q->world_from_object, vec(0, 1, 0));
  double stretch = vec_length(vec_cross(x, y));
  return stretch * q->phi_max / 2 * (q->radius - q->inner_radius) * (q->radius + q->inner_radius);
}

static void sample(const struct scene *scene, const struct shape *shape, uint32_t primitive,
                   double u0, double u1, struct vec *p, struct vec *ng) {
  const struct quadric *q = quadric_of(scene, shape);
  double inner2 = q->inner_radius * q->inner_radius, outer2 = q->radius * q->radius, cosine, sine;
  double r = sqrt(inner2 + u0 * (outer2 - inner2));
  quadric_angle(q, u1, &cosine, &sine);
  *p = transform_point(&q->world_from_object, vec(r * cosine, r * sine, q->height));
  *ng = normal(scene, shape, primitive, *p);
}

const struct shape_type shape_disk = {
    .name = "disk",
    .about = "a disk facing +z, or a ring or sector of it",
    .flat = true,
    .read = read,
    .bounds = bounds,
    .intersect = disk_intersect,
    .detail = detail,
    .normal = normal,
    .area = area,
    .sample = sample,
};
