#include "analysis/shadow.h"

#include "analysis/flat.h"
#include "analysis/special.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// ---- who casts it ----

struct blockers {
  struct triangles {
    struct triangle {
      struct vec vertex[3]; // along the light onto the receiver
    } * item;
    ptrdiff_t count, capacity;
  } triangles;
  struct edges edges;
};

struct rays {
  struct plane receiver;
  struct vec wi;
  double distance;
};

// False: it is not between the receiver and the light.
static bool project(const struct rays *rays, struct vec vertex[3]) {
  for (int k = 0; k < 3; k++) {
    struct vec above = vec_sub(vertex[k], rays->receiver.p);
    double height = vec_dot(rays->receiver.n, above);
    if (!(height > rays->receiver.tolerance)) return false;
    if (!(vec_dot(above, rays->wi) < rays->distance)) return false;
    vertex[k] = vec_along(vertex[k], rays->wi, -height / vec_dot(rays->receiver.n, rays->wi));
  }
  return true;
}

// Edges are told apart by the vertices of the file, which projection rounds alike.
static bool add_shape(const struct scene *scene, const struct shape *shape, const struct rays *rays,
                      struct blockers *blockers, struct arena *arena) {
  for (uint32_t t = 0; t < shape->count; t++) {
    struct triangle *triangle = arena_push(arena, &blockers->triangles);
    flat_triangle(scene, shape, t, triangle->vertex);
    if (!project(rays, triangle->vertex)) return false;
    flat_toggle(&blockers->edges, triangle->vertex, arena);
  }
  return true;
}

static bool is_opaque(const struct scene *scene, const struct shape *shape, bool direct_only) {
  const struct material *material = &scene->material[shape->material];
  bool black = material->type->is_black && material->type->is_black(material);
  return !shape->see_through && !shape->alpha && !material->type->passed && (black || direct_only);
}

static bool add_blockers(const struct scene *scene, const struct rays *rays, bool direct_only,
                         struct blockers *blockers, struct arena *arena) {
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (flat_contains_shape(&rays->receiver, scene, shape)) continue;
    if (!flat_is_triangles(shape) || !is_opaque(scene, shape, direct_only)) return false;
    if (!add_shape(scene, shape, rays, blockers, arena)) return false;
  }
  return true;
}

static bool is_dark(const struct blockers *blockers, struct vec p) {
  for (ptrdiff_t k = 0; k < blockers->triangles.count; k++)
    if (flat_inside(p, blockers->triangles.item[k].vertex)) return true;
  return false;
}

// ---- what of it is in the disc ----

// The foot of the perpendicular from p to the edge's line.
static struct vec foot(struct vec p, const struct edge *edge) {
  struct vec along = vec_sub(edge->b, edge->a);
  return vec_along(edge->a, along, vec_dot(vec_sub(p, edge->a), along) / vec_dot(along, along));
}

// Whether points all over the disc are as dark as the half-plane says; those so near to the edge
// that rounding decides are not asked.
static bool is_half_plane(const struct blockers *blockers, const struct plane *receiver,
                          double radius, const struct edge *edge, bool dark) {
  enum { RINGS = 16, ANGLES = 64 };
  struct vec s, t, at_edge = edge ? foot(receiver->p, edge) : receiver->p;
  struct vec to_edge = vec_sub(at_edge, receiver->p);
  double distance2 = vec_dot(to_edge, to_edge);
  vec_basis(receiver->n, &s, &t);
  for (int k = 0; k < RINGS * ANGLES; k++) {
    double r = radius * (k / ANGLES + 1) / RINGS, phi = 2 * pi * (k % ANGLES + 0.5) / ANGLES;
    struct vec step = vec_along(vec_scale(s, r * cos(phi)), t, r * sin(phi));
    double past = vec_dot(step, to_edge) - distance2;
    if (edge && fabs(past) <= sqrt(distance2) * receiver->tolerance) continue;
    bool beyond = edge && past > 0;
    if (is_dark(blockers, vec_add(receiver->p, step)) != (dark != beyond)) return false;
  }
  return true;
}

bool shadow_find(const struct scene *scene, struct vec p, struct vec n, struct vec wi,
                 double distance, double radius, bool direct_only, struct arena scratch,
                 struct half_shadow *shadow) {
  struct rays rays = {flat_plane(scene, p, n), wi, distance};
  struct blockers blockers = {0};
  if (!add_blockers(scene, &rays, direct_only, &blockers, &scratch)) return false;
  const struct edge *found = NULL;
  for (ptrdiff_t k = 0; k < blockers.edges.count; k++) {
    const struct edge *edge = &blockers.edges.item[k];
    if (flat_segment_distance(p, edge->a, edge->b) >= radius) continue;
    if (found) return false;
    found = edge;
  }
  bool dark = is_dark(&blockers, p);
  if (!is_half_plane(&blockers, &rays.receiver, radius, found, dark)) return false;
  if (!found) {
    *shadow = (struct half_shadow){.shade = dark ? SHADE_DARK : SHADE_NONE, .distance = INFINITY};
    return true;
  }
  struct vec to_edge = vec_sub(foot(p, found), p);
  *shadow = (struct half_shadow){.shade = dark ? SHADE_DARK : SHADE_LIT,
                                 .distance = vec_length(to_edge),
                                 .across = vec_normalize(to_edge)};
  return shadow->distance > 0;
}

// ---- kernels across it ----

// A circle of radius u has the share arccos(t / u) / pi beyond the line. u = t cosh w makes a
// smooth function of what has a root at u = t: arccos(1 / cosh w) is Gudermann's function of w.
double shadow_beyond(const struct kernel *kernel, int power, double t) {
  enum { NODES = 100 };
  double x[NODES], weight[NODES], sum = 0;
  if (t >= 1) return 0;
  // As small as this the line might as well go through the centre: the integral is within t of it.
  if (t < 0x1p-50) t = 0x1p-50;
  double end = acosh(1 / t);
  special_gauss_legendre(NODES, x, weight);
  for (int k = 0; k < NODES; k++) {
    double w = end * x[k], u = t * cosh(w), psi = kernel_value(kernel, 2, fmin(u * u, 1));
    double gudermann = 2 * atan(tanh(w / 2));
    sum += weight[k] * pow(psi, power) * 2 * u * t * sinh(w) * gudermann;
  }
  return end * sum;
}
