#include "analysis/receiver.h"

#include <math.h>
#include <string.h>

// Vertices are rounded to float: half an ulp in each of three coordinates.
static double plane_tolerance(const struct scene *scene) {
  double largest = 0;
  for (int axis = 0; axis < 3; axis++)
    largest = fmax(largest, fmax(fabs(scene->bounds.lo[axis]), fabs(scene->bounds.hi[axis])));
  return 3 * largest * 0x1p-24;
}

struct plane {
  struct vec p, n;
  double tolerance;
};

static bool plane_contains(const struct plane *plane, struct vec point) {
  return fabs(vec_dot(plane->n, vec_sub(point, plane->p))) <= plane->tolerance;
}

static struct vec vertex(const struct scene *scene, uint32_t row) {
  const float *v = scene->position[row];
  return vec(v[0], v[1], v[2]);
}

// Triangles are rows of scene.triangle, disks of scene.quadric.
static bool is_triangles(const struct shape *shape) {
  return shape->type->flat && strcmp(shape->type->name, "disk") != 0;
}

static struct vec rim_point(const struct quadric *disk, double radius, double phi) {
  struct vec local = vec(radius * cos(phi), radius * sin(phi), disk->height);
  return transform_point(&disk->world_from_object, local);
}

static bool disk_in_plane(const struct quadric *disk, const struct plane *plane) {
  for (int k = 0; k < 3; k++)
    if (!plane_contains(plane, rim_point(disk, disk->radius, 2 * k))) return false;
  return true;
}

static bool triangle_in_plane(const struct scene *scene, const struct shape *shape, uint32_t t,
                              const struct plane *plane) {
  const uint32_t *row = scene->triangle[shape->local + t];
  for (int k = 0; k < 3; k++)
    if (!plane_contains(plane, vertex(scene, row[k]))) return false;
  return true;
}

static bool shape_in_plane(const struct scene *scene, const struct shape *shape,
                           const struct plane *plane) {
  if (!shape->type->flat) return false;
  if (!is_triangles(shape)) return disk_in_plane(&scene->quadric[shape->local], plane);
  for (uint32_t t = 0; t < shape->count; t++)
    if (!triangle_in_plane(scene, shape, t, plane)) return false;
  return true;
}

bool receiver_is_plane(const struct scene *scene, struct vec p, struct vec n, uint32_t light,
                       bool direct_only) {
  struct plane plane = {p, n, plane_tolerance(scene)};
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    const struct material *material = &scene->material[shape->material];
    bool emitter = shape->light == light;
    bool black = material->type->is_black && material->type->is_black(material);
    if (emitter && (direct_only || black)) continue;
    if (!shape_in_plane(scene, shape, &plane)) return false;
  }
  return true;
}

static double segment_distance(struct vec p, struct vec a, struct vec b) {
  struct vec edge = vec_sub(b, a);
  double t = vec_dot(vec_sub(p, a), edge) / vec_dot(edge, edge);
  return vec_length(vec_sub(p, vec_along(a, edge, t < 0 ? 0 : t > 1 ? 1 : t)));
}

// The circle is followed in steps; between two points it is nearer by at most half a step.
static double circle_distance(const struct quadric *disk, double radius, struct vec p) {
  const int steps = 4096;
  const double turn = 6.283185307179586;
  struct vec last = rim_point(disk, radius, 0);
  double nearest = INFINITY;
  for (int k = 1; k <= steps; k++) {
    struct vec next = rim_point(disk, radius, turn * k / steps);
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
      nearest = fmin(nearest, segment_distance(p, rim_point(disk, disk->inner_radius, phi),
                                               rim_point(disk, disk->radius, phi)));
    }
  return nearest;
}

struct edges {
  struct edge {
    struct vec a, b;
  } * item;
  ptrdiff_t count, capacity;
};

static bool same_point(struct vec a, struct vec b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

// An edge that comes a second time is inside the receiver: both are forgotten.
static void edges_toggle(struct edges *edges, struct edge edge, struct arena *arena) {
  for (ptrdiff_t k = 0; k < edges->count; k++) {
    struct edge other = edges->item[k];
    bool same = (same_point(edge.a, other.a) && same_point(edge.b, other.b)) ||
                (same_point(edge.a, other.b) && same_point(edge.b, other.a));
    if (!same) continue;
    edges->item[k] = edges->item[--edges->count];
    return;
  }
  *arena_push(arena, edges) = edge;
}

static void add_triangles(const struct scene *scene, const struct shape *shape,
                          const struct plane *plane, struct edges *edges, struct arena *arena) {
  for (uint32_t t = 0; t < shape->count; t++) {
    if (!triangle_in_plane(scene, shape, t, plane)) continue;
    const uint32_t *row = scene->triangle[shape->local + t];
    for (int k = 0; k < 3; k++) {
      struct edge edge = {vertex(scene, row[k]), vertex(scene, row[(k + 1) % 3])};
      edges_toggle(edges, edge, arena);
    }
  }
}

double receiver_clearance(const struct scene *scene, struct vec p, struct vec n,
                          struct arena scratch) {
  struct plane plane = {p, n, plane_tolerance(scene)};
  struct edges edges = {0};
  double nearest = INFINITY;
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (is_triangles(shape))
      add_triangles(scene, shape, &plane, &edges, &scratch);
    else if (shape_in_plane(scene, shape, &plane))
      nearest = fmin(nearest, disk_clearance(&scene->quadric[shape->local], p));
  }
  for (ptrdiff_t k = 0; k < edges.count; k++)
    nearest = fmin(nearest, segment_distance(p, edges.item[k].a, edges.item[k].b));
  return nearest;
}

// ---- what is not in the plane ----

static double triangle_distance(struct vec p, struct vec a, struct vec b, struct vec c) {
  struct vec ab = vec_sub(b, a), ac = vec_sub(c, a), ap = vec_sub(p, a);
  struct vec normal = vec_cross(ab, ac);
  double area2 = vec_dot(normal, normal);
  double v = vec_dot(vec_cross(ap, ac), normal), w = vec_dot(vec_cross(ab, ap), normal);
  if (v >= 0 && w >= 0 && v + w <= area2) return fabs(vec_dot(ap, normal)) / sqrt(area2);
  return fmin(segment_distance(p, a, b),
              fmin(segment_distance(p, b, c), segment_distance(p, c, a)));
}

static double triangles_distance(const struct scene *scene, const struct shape *shape,
                                 const struct plane *plane) {
  double nearest = INFINITY;
  for (uint32_t t = 0; t < shape->count; t++) {
    const uint32_t *row = scene->triangle[shape->local + t];
    if (triangle_in_plane(scene, shape, t, plane)) continue;
    struct vec a = vertex(scene, row[0]), b = vertex(scene, row[1]), c = vertex(scene, row[2]);
    nearest = fmin(nearest, triangle_distance(plane->p, a, b, c));
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
  if (is_triangles(shape)) return triangles_distance(scene, shape, plane);
  const struct quadric *quadric = &scene->quadric[shape->local]; // of disks and spheres
  bool sphere = strcmp(shape->type->name, "sphere") == 0;
  if (shape->type->flat ? disk_in_plane(quadric, plane) : sphere && on_sphere(quadric, plane->p))
    return INFINITY;
  return box_distance(shape->type->bounds(scene, shape, shape->first), plane->p);
}

double receiver_surroundings(const struct scene *scene, struct vec p, struct vec n,
                             struct arena scratch) {
  struct plane plane = {p, n, plane_tolerance(scene)};
  double nearest = receiver_clearance(scene, p, n, scratch);
  for (uint32_t s = 0; s < scene->n_shapes; s++)
    nearest = fmin(nearest, shape_distance(scene, &scene->shape[s], &plane));
  return nearest;
}
