#include "analysis/receiver.h"

#include "analysis/flat.h"

#include <math.h>
#include <string.h>

bool receiver_is_plane(const struct scene *scene, struct vec p, struct vec n, uint32_t light,
                       bool direct_only) {
  struct plane plane = flat_plane(scene, p, n);
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    const struct material *material = &scene->material[shape->material];
    bool emitter = shape->light == light;
    bool black = material->type->is_black && material->type->is_black(material);
    if (emitter && (direct_only || black)) continue;
    if (!flat_contains_shape(&plane, scene, shape)) return false;
  }
  return true;
}

// The circle is followed in steps; between two points it is nearer by at most half a step.
static double circle_distance(const struct quadric *disk, double radius, struct vec p) {
  const int steps = 4096;
  const double turn = 6.283185307179586;
  struct vec last = flat_rim(disk, radius, 0);
  double nearest = INFINITY;
  for (int k = 1; k <= steps; k++) {
    struct vec next = flat_rim(disk, radius, turn * k / steps);
    nearest = fmin(nearest, vec_length(vec_sub(p, next)) - vec_length(vec_sub(next, last)) / 2);
    last = next;
  }
  return nearest;
}

static double disk_clearance(const struct quadric *disk, struct vec p) {
  double nearest = circle_distance(disk, disk->radius, p);
  if (disk->inner_radius > 0) nearest = fmin(nearest, circle_distance(disk, disk->inner_radius, p));
  if (disk->phi_max < 6.283185307179586)
    for (int side = 0; side < 2; side++) {
      double phi = side * disk->phi_max;
      nearest = fmin(nearest, flat_segment_distance(p, flat_rim(disk, disk->inner_radius, phi),
                                                    flat_rim(disk, disk->radius, phi)));
    }
  return nearest;
}

static void add_triangles(const struct scene *scene, const struct shape *shape,
                          const struct plane *plane, struct edges *edges, struct arena *arena) {
  for (uint32_t t = 0; t < shape->count; t++) {
    struct vec vertex[3];
    flat_triangle(scene, shape, t, vertex);
    if (flat_contains_triangle(plane, vertex)) flat_toggle(edges, vertex, arena);
  }
}

double receiver_clearance(const struct scene *scene, struct vec p, struct vec n,
                          struct arena scratch) {
  struct plane plane = flat_plane(scene, p, n);
  struct edges edges = {0};
  double nearest = INFINITY;
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (flat_is_triangles(shape))
      add_triangles(scene, shape, &plane, &edges, &scratch);
    else if (flat_contains_shape(&plane, scene, shape))
      nearest = fmin(nearest, disk_clearance(&scene->quadric[shape->local], p));
  }
  for (ptrdiff_t k = 0; k < edges.count; k++)
    nearest = fmin(nearest, flat_segment_distance(p, edges.item[k].a, edges.item[k].b));
  return nearest;
}

// ---- what is not in the plane ----

static double triangle_distance(struct vec p, struct vec a, struct vec b, struct vec c) {
  struct vec ab = vec_sub(b, a), ac = vec_sub(c, a), ap = vec_sub(p, a);
  struct vec normal = vec_cross(ab, ac);
  double area2 = vec_dot(normal, normal);
  double v = vec_dot(vec_cross(ap, ac), normal), w = vec_dot(vec_cross(ab, ap), normal);
  if (v >= 0 && w >= 0 && v + w <= area2) return fabs(vec_dot(ap, normal)) / sqrt(area2);
  return fmin(flat_segment_distance(p, a, b),
              fmin(flat_segment_distance(p, b, c), flat_segment_distance(p, c, a)));
}

static double triangles_distance(const struct scene *scene, const struct shape *shape,
                                 const struct plane *plane) {
  double nearest = INFINITY;
  for (uint32_t t = 0; t < shape->count; t++) {
    struct vec v[3];
    flat_triangle(scene, shape, t, v);
    if (flat_contains_triangle(plane, v)) continue;
    nearest = fmin(nearest, triangle_distance(plane->p, v[0], v[1], v[2]));
  }
  return nearest;
}

// A hit's position is rounded to some ulps of what it was computed from.
static bool on_sphere(const struct quadric *sphere, struct vec p) {
  double distance = vec_length(transform_point(&sphere->object_from_world, p));
  return fabs(distance - sphere->radius) <= 0x1p-40 * sphere->radius;
}

static double box_distance(struct box box, struct vec p) {
  const double at[3] = {p.x, p.y, p.z};
  double sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    double outside = fmax(0, fmax(box.lo[axis] - at[axis], at[axis] - box.hi[axis]));
    sum += outside * outside;
  }
  return sqrt(sum);
}

static double shape_distance(const struct scene *scene, const struct shape *shape,
                             const struct plane *plane) {
  if (flat_is_triangles(shape)) return triangles_distance(scene, shape, plane);
  const struct quadric *quadric = &scene->quadric[shape->local]; // of disks and spheres
  bool sphere = strcmp(shape->type->name, "sphere") == 0;
  if (shape->type->flat ? flat_contains_shape(plane, scene, shape)
                        : sphere && on_sphere(quadric, plane->p))
    return INFINITY;
  return box_distance(shape->type->bounds(scene, shape, shape->first), plane->p);
}

double receiver_surroundings(const struct scene *scene, struct vec p, struct vec n,
                             struct arena scratch) {
  struct plane plane = flat_plane(scene, p, n);
  double nearest = receiver_clearance(scene, p, n, scratch);
  for (uint32_t s = 0; s < scene->n_shapes; s++)
    nearest = fmin(nearest, shape_distance(scene, &scene->shape[s], &plane));
  return nearest;
}
