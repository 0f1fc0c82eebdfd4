#include "analysis/flat.h"

#include <math.h>
#include <string.h>

// Half an ulp of a float in each of three coordinates.
struct plane flat_plane(const struct scene *scene, struct vec p, struct vec n) {
  double largest = 0;
  for (int axis = 0; axis < 3; axis++)
    largest = fmax(largest, fmax(fabs(scene->bounds.lo[axis]), fabs(scene->bounds.hi[axis])));
  return (struct plane){p, n, 3 * largest * 0x1p-24};
}

bool flat_is_triangles(const struct shape *shape) {
  return shape->type->flat && strcmp(shape->type->name, "disk") != 0;
}

void flat_triangle(const struct scene *scene, const struct shape *shape, uint32_t t,
                   struct vec vertex[3]) {
  const uint32_t *row = scene->triangle[shape->local + t];
  for (int k = 0; k < 3; k++) {
    const float *v = scene->position[row[k]];
    vertex[k] = vec(v[0], v[1], v[2]);
  }
}

bool flat_contains(const struct plane *plane, struct vec point) {
  return fabs(vec_dot(plane->n, vec_sub(point, plane->p))) <= plane->tolerance;
}

bool flat_contains_triangle(const struct plane *plane, const struct vec vertex[3]) {
  for (int k = 0; k < 3; k++)
    if (!flat_contains(plane, vertex[k])) return false;
  return true;
}

struct vec flat_rim(const struct quadric *disk, double radius, double phi) {
  struct vec local = vec(radius * cos(phi), radius * sin(phi), disk->height);
  return transform_point(&disk->world_from_object, local);
}

static bool contains_disk(const struct plane *plane, const struct quadric *disk) {
  for (int k = 0; k < 3; k++)
    if (!flat_contains(plane, flat_rim(disk, disk->radius, 2 * k))) return false;
  return true;
}

bool flat_contains_shape(const struct plane *plane, const struct scene *scene,
                         const struct shape *shape) {
  if (!shape->type->flat) return false;
  if (!flat_is_triangles(shape)) return contains_disk(plane, &scene->quadric[shape->local]);
  for (uint32_t t = 0; t < shape->count; t++) {
    struct vec vertex[3];
    flat_triangle(scene, shape, t, vertex);
    if (!flat_contains_triangle(plane, vertex)) return false;
  }
  return true;
}

double flat_segment_distance(struct vec p, struct vec a, struct vec b) {
  struct vec edge = vec_sub(b, a);
  double t = vec_dot(vec_sub(p, a), edge) / vec_dot(edge, edge);
  return vec_length(vec_sub(p, vec_along(a, edge, t < 0 ? 0 : t > 1 ? 1 : t)));
}

bool flat_inside(struct vec p, const struct vec vertex[3]) {
  struct vec normal = vec_cross(vec_sub(vertex[1], vertex[0]), vec_sub(vertex[2], vertex[0]));
  for (int k = 0; k < 3; k++) {
    struct vec edge = vec_sub(vertex[(k + 1) % 3], vertex[k]);
    if (vec_dot(vec_cross(edge, vec_sub(p, vertex[k])), normal) < 0) return false;
  }
  return true;
}

static bool same_point(struct vec a, struct vec b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void toggle(struct edges *edges, struct edge edge, struct arena *arena) {
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

void flat_toggle(struct edges *edges, const struct vec vertex[3], struct arena *arena) {
  for (int k = 0; k < 3; k++) toggle(edges, (struct edge){vertex[k], vertex[(k + 1) % 3]}, arena);
}
