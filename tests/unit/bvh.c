// The tree against the definition: the smallest (t, primitive) over all primitives, bit for bit, on
// scenes and rays chosen to be hard; and closed meshes, which no ray may leave.
#include "base/simd.h"
#include "bvh/tree.h"
#include "scene/skip.h"
#include "tests/unit/meshes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

// ---- scenes ----
static void add_triangles(struct mesh *m, struct draw *draw, int n, double room, struct vec size) {
  for (int i = 0; i < n; i++) {
    struct vec center = draw_in_cube(draw, room), corner[3];
    for (int j = 0; j < 3; j++) {
      struct vec v = draw_in_cube(draw, 1);
      corner[j] = vec_add(center, vec(v.x * size.x, v.y * size.y, v.z * size.z));
    }
    mesh_add_triangle(m, corner[0], corner[1], corner[2]);
  }
}

static void soup(struct mesh *m, struct draw *draw) {
  mesh_add_shape(m, &shape_trianglemesh);
  add_triangles(m, draw, 500, 4.7, vec(1.3, 1.3, 1.3));
}

static void slivers(struct mesh *m, struct draw *draw) {
  mesh_add_shape(m, &shape_trianglemesh);
  add_triangles(m, draw, 250, 2.1, vec(3.9, 1e-5, 1e-7));
  add_triangles(m, draw, 250, 2.1, vec(1e-6, 2.2, 1e-3));
}

static void coincident(struct mesh *m, struct draw *draw) {
  mesh_add_shape(m, &shape_trianglemesh);
  for (int i = 0; i < 40; i++) {
    struct vec a = draw_in_cube(draw, 1.7), b = draw_in_cube(draw, 1.7),
               c = draw_in_cube(draw, 1.7);
    for (int copy = 0; copy < 9; copy++) // with the vertices in another order, too
      if (copy % 2)
        mesh_add_triangle(m, a, b, c);
      else
        mesh_add_triangle(m, c, b, a);
  }
}

static void degenerate(struct mesh *m, struct draw *draw) {
  mesh_add_shape(m, &shape_trianglemesh);
  for (int i = 0; i < 150; i++) {
    struct vec a = draw_in_cube(draw, 2.3), b = draw_in_cube(draw, 2.3);
    mesh_add_triangle(m, a, a, a);
    mesh_add_triangle(m, a, b, a);
    mesh_add_triangle(m, a, b, vec_scale(vec_add(a, b), 0.5));
  }
  add_triangles(m, draw, 100, 2.3, vec(0.7, 0.7, 0.7));
}

static void tiny_in_huge(struct mesh *m, struct draw *draw) {
  (void)draw;
  mesh_add_shape(m, &shape_trianglemesh);
  mesh_add_grid_box(m, vec(0, 0, 0), 1e6, 2);
  mesh_add_icosphere(m, vec(3.25, -1.75, 2.5), 1e-3, 2);
}

static void far_away(struct mesh *m, struct draw *draw) {
  (void)draw;
  mesh_add_shape(m, &shape_trianglemesh);
  mesh_add_grid_box(m, vec(1e6, -1e6, 1e6), 3, 4);
  mesh_add_icosphere(m, vec(1e6, -1e6, 1e6), 1.9, 2);
}

static void boxes(struct mesh *m, struct draw *draw) {
  (void)draw;
  mesh_add_shape(m, &shape_trianglemesh);
  mesh_add_grid_box(m, vec(0, 0, 0), 1, 3);
  mesh_add_grid_box(m, vec(0.25, -0.5, 0.125), 0.5, 2);
}

// As many as need no tree (bvh/few.h): a room, a box that shares a plane with its floor, a fan, two
// in one place, one without area.
static void few(struct mesh *m, struct draw *draw) {
  mesh_add_shape(m, &shape_trianglemesh);
  mesh_add_grid_box(m, vec(0, 0, 0), 1, 1);
  mesh_add_grid_box(m, vec(0.25, -0.75, 0.125), 0.25, 1);
  struct vec hub = draw_in_cube(draw, 0.5), rim = draw_in_cube(draw, 0.5);
  for (int i = 0; i < 18; i++) {
    struct vec next = draw_in_cube(draw, 0.5);
    mesh_add_triangle(m, hub, rim, next);
    rim = next;
  }
  for (int i = 0; i < 2; i++) mesh_add_triangle(m, vec(-1, -1, 0), vec(0, 1, -1), hub);
  mesh_add_triangle(m, hub, rim, vec_along(hub, vec_sub(rim, hub), 0.5));
  add_triangles(m, draw, 3, 1, vec(1e-4, 0.7, 1e-4));
  assert_int_equal(m->scene.n_primitives, SKIP_FEW_TRIANGLES);
}

// Every split takes the largest few off one axis and leaves the rest: deeper than BVH_SAH_DEPTH.
static void ever_smaller(struct mesh *m, struct draw *draw) {
  (void)draw;
  mesh_add_shape(m, &shape_trianglemesh);
  for (int axis = 0; axis < 3; axis++) {
    double x = 1e37;
    for (int i = 0; i < 290; i++, x *= 0.53) {
      double a[3] = {0}, b[3] = {0}, c[3] = {0};
      a[axis] = x, b[axis] = 0.8 * x, c[axis] = 0.9 * x;
      b[(axis + 1) % 3] = 0.05 * x, c[(axis + 2) % 3] = 0.05 * x;
      mesh_add_triangle(m, vec(a[0], a[1], a[2]), vec(b[0], b[1], b[2]), vec(c[0], c[1], c[2]));
    }
  }
}

// Twisted, plane, folded, and with two corners in one place.
static void add_patches(struct mesh *m, struct draw *draw, int n, double room, double size) {
  for (int i = 0; i < n; i++) {
    struct vec center = draw_in_cube(draw, room), corner[4];
    for (int j = 0; j < 4; j++) corner[j] = vec_add(center, draw_in_cube(draw, size));
    int kind = draw_below(draw, 4);
    if (kind == 1) corner[3] = vec_sub(vec_add(corner[1], corner[2]), corner[0]);
    if (kind == 2) corner[3] = vec_along(corner[0], vec_sub(corner[1], corner[2]), 0.3);
    if (kind == 3) corner[3] = corner[2];
    mesh_add_bilinear(m, corner);
  }
}

static void patches(struct mesh *m, struct draw *draw) {
  mesh_add_shape(m, &shape_bilinearmesh);
  add_patches(m, draw, 200, 2.7, 1.3);
  mesh_add_shape(m, &shape_trianglemesh);
  add_triangles(m, draw, 20, 2.7, vec(1.3, 1.3, 1.3));
}

static struct quadric quadric_at(struct draw *draw, double room) {
  struct vec x = draw_direction(draw), y, z, at = draw_in_cube(draw, room);
  vec_basis(x, &y, &z);
  double s = draw_between(draw, 0.3, 1.9);
  struct transform t = {
      {{s * x.x, y.x, z.x, at.x}, {s * x.y, y.y, z.y, at.y}, {s * x.z, y.z, z.z, at.z}}};
  struct quadric q = {.world_from_object = t, .phi_max = 6.283185307179586};
  assert_true(transform_invert(t, &q.object_from_world));
  q.radius = draw_between(draw, 0.2, 1.1);
  q.z_min = -q.radius, q.z_max = q.radius;
  return q;
}

static void mixed(struct mesh *m, struct draw *draw) {
  for (int i = 0; i < 60; i++) {
    struct quadric q = quadric_at(draw, 3.4);
    if (i % 3 == 0) q.z_min *= draw_unit(draw), q.z_max *= draw_unit(draw);
    if (i % 4 == 0) q.phi_max *= draw_unit(draw);
    mesh_add_quadric(m, &shape_sphere, q);
    q.height = draw_between(draw, -1, 1), q.inner_radius = i % 2 ? 0 : 0.4 * q.radius;
    mesh_add_quadric(m, &shape_disk, q);
    mesh_add_quadric(m, &shape_cylinder, q);
    mesh_add_shape(m, &shape_bilinearmesh);
    add_patches(m, draw, 2, 3.4, 1.1);
    mesh_add_shape(m, &shape_trianglemesh);
    add_triangles(m, draw, 3, 3.4, vec(1.1, 1.1, 1.1));
  }
}

static const struct {
  const char *name;
  void (*add)(struct mesh *, struct draw *);
} hard_scenes[] = {
    {"soup", soup},
    {"slivers", slivers},
    {"coincident", coincident},
    {"degenerate", degenerate},
    {"tiny in huge", tiny_in_huge},
    {"far away", far_away},
    {"boxes", boxes},
    {"few", few},
    {"ever smaller", ever_smaller},
    {"patches", patches},
    {"mixed", mixed},
};
enum { N_SCENES = sizeof hard_scenes / sizeof *hard_scenes };

// ---- rays ----
static double side(const struct box *box, int axis) {
  return (double)box->hi[axis] - (double)box->lo[axis];
}

static struct vec draw_in_box(struct draw *draw, const struct box *box) {
  double at[3];
  for (int k = 0; k < 3; k++)
    at[k] = (double)box->lo[k] + side(box, k) * draw_between(draw, -0.2, 1.2);
  return vec(at[0], at[1], at[2]);
}

// A direction with most components +-0 or too small to matter.
static struct vec draw_axis(struct draw *draw) {
  static const double small[] = {0, -0.0, 6e-17, -6e-17, 1e-300, -3e-7, 2e-8};
  double d[3];
  for (int k = 0; k < 3; k++) d[k] = small[draw_below(draw, 7)];
  d[draw_below(draw, 3)] = draw_below(draw, 2) ? 1.75 : -0.375;
  return vec(d[0], d[1], d[2]);
}

struct picked {
  uint32_t primitive;
  struct vec p[3];
};

// Or three corners of a patch.
static struct picked pick_triangle(const struct mesh *m, struct draw *draw) {
  const struct scene *s = &m->scene;
  struct picked t;
  const struct shape *shape;
  do {
    t.primitive = (uint32_t)draw_below(draw, (int)s->n_primitives);
    shape = &s->shape[s->shape_of[t.primitive]];
  } while (shape->type != &shape_trianglemesh && shape->type != &shape_bilinearmesh);
  uint32_t k = shape->local + t.primitive - shape->first;
  const uint32_t *row = shape->type == &shape_trianglemesh ? s->triangle[k] : s->patch[k];
  for (int i = 0; i < 3; i++) t.p[i] = mesh_vertex(m, row[i]);
  return t;
}

static struct vec inside(const struct picked *t, double u, double v) {
  return vec_along(vec_along(t->p[0], vec_sub(t->p[1], t->p[0]), u), vec_sub(t->p[2], t->p[0]), v);
}

static struct ray draw_ray(const struct mesh *m, struct draw *draw, int kind) {
  struct ray ray = {draw_in_box(draw, &m->scene.bounds), draw_direction(draw), INFINITY,
                    PRIMITIVE_NONE};
  struct picked t = pick_triangle(m, draw), other = pick_triangle(m, draw);
  double u = draw_unit(draw), v = draw_unit(draw) * (1 - u);
  switch (kind) {
  case 0:
    break;
  case 1:
    ray.d = draw_axis(draw);
    break;
  case 2:
    ray.o = t.p[0], ray.d = draw_axis(draw);
    break;
  case 3:
    ray.d = vec_sub(t.p[draw_below(draw, 3)], ray.o);
    break;
  case 4:
    ray.d = vec_sub(inside(&t, u, 0), ray.o);
    break;
  case 5:
    ray.d = vec_sub(inside(&t, u, v), ray.o);
    break;
  case 6:
    ray.o = inside(&t, 3.5 * u - 1, v), ray.d = vec_sub(t.p[2], ray.o);
    break; // in its plane
  case 7:
    ray.o = t.p[1], ray.leaving = t.primitive;
    break;
  case 8:
    ray.o = t.p[1], ray.leaving = t.primitive, ray.d = vec_sub(other.p[0], ray.o);
    break;
  case 9:
    ray.o = inside(&t, u, v), ray.leaving = t.primitive, ray.d = vec_sub(other.p[1], ray.o);
  }
  return ray;
}
enum { N_KINDS = 10 };

// ---- equality ----
enum { MOST_RAYS = 1024 };

static void check_closest(const struct bvh *bvh, const struct ray *rays, int n,
                          const struct hit *expected) {
  struct hit hits[MOST_RAYS];
  unsigned char blocked[MOST_RAYS];
  bvh_closest(bvh, rays, hits, n);
  bvh_any(bvh, rays, blocked, n);
  for (int j = 0; j < n; j++) {
    assert_int_equal(hits[j].primitive, expected[j].primitive);
    assert_memory_equal(&hits[j].t, &expected[j].t, sizeof hits[j].t);
    assert_int_equal(blocked[j], expected[j].primitive != PRIMITIVE_NONE);
  }
}

static bool hits_at(const struct scene *scene, const struct ray *ray, struct hit hit) {
  const struct shape *shape = &scene->shape[scene->shape_of[hit.primitive]];
  double t;
  return shape->type->intersect(scene, shape, hit.primitive, ray, &t) && t == hit.t;
}

// Targets at the closest hit, a little before or behind it, or anywhere; emitters that are hit
// there, or any.
static void check_blockers(const struct scene *scene, const struct bvh *bvh, const struct ray *rays,
                           int n, const struct hit *closest) {
  struct hit hits[MOST_RAYS];
  double distance[MOST_RAYS] = {0};
  uint32_t emitter[MOST_RAYS] = {0};
  for (int j = 0; j < n; j++) {
    double t = closest[j].t < INFINITY ? closest[j].t : 1;
    const double at[] = {t, nextafter(t, 0), nextafter(t, INFINITY), 1.37 * t, 0.73 * t, INFINITY};
    distance[j] = at[j % 6];
    emitter[j] = j % 4 == 0   ? closest[j].primitive
                 : j % 4 == 1 ? PRIMITIVE_NONE
                              : (uint32_t)(j * 7919) % scene->n_primitives;
  }
  bvh_blockers(bvh, rays, distance, emitter, hits, n);
  for (int j = 0; j < n; j++) {
    struct hit none = {INFINITY, PRIMITIVE_NONE};
    bool is_near = closest[j].t < distance[j];
    if (is_near && closest[j].primitive != emitter[j]) {
      assert_true(hits[j].t < distance[j] && hits[j].primitive != emitter[j]);
      assert_true(hits_at(scene, &rays[j], hits[j]));
      continue;
    }
    struct hit expected = is_near ? closest[j] : none;
    assert_int_equal(hits[j].primitive, expected.primitive);
    assert_memory_equal(&hits[j].t, &expected.t, sizeof expected.t);
  }
}

// At every SIMD level.
static void check_equal(const struct mesh *m, const struct bvh *bvh, const struct ray *rays, int n,
                        struct hit *expected) {
  enum simd best = simd_best();
  assert_true(n <= MOST_RAYS);
  bvh_closest_brute_force(&m->scene, rays, expected, n);
  for (int level = 0; level <= (int)best; level++) {
    simd_choose((enum simd)level);
    check_closest(bvh, rays, n, expected);
    check_blockers(&m->scene, bvh, rays, n, expected);
  }
  simd_choose(best);
}

// With `n` rays of each kind; more than are in flight at once (search.lanes.c) also take the places
// of those that are done.
enum { MANY = 50, SOME = 20 };

static void check_scene(int scene, struct bvh_options options, int n, const char *name) {
  struct draw draw = draw_named(name);
  draw.path = (uint64_t)scene << 32;
  struct mesh m = mesh_new(400, 1000);
  hard_scenes[scene].add(&m, &draw);
  mesh_finish(&m);
  struct bvh *bvh = bvh_build(&m.scene, options, &m.arena);
  int n_hits = 0;
  for (int kind = 0; kind < N_KINDS; kind++) {
    struct ray ray[MANY];
    struct hit hit[MANY], again[MANY];
    for (int j = 0; j < n; j++) ray[j] = draw_ray(&m, &draw, kind);
    check_equal(&m, bvh, ray, n, hit);
    for (int j = 0; j < n; j++) n_hits += hit[j].primitive != PRIMITIVE_NONE;
    // A t_max at the closest hit excludes it; just beyond, it does not.
    for (int j = 0; j < n; j++) ray[j].t_max = j % 2 ? hit[j].t : nextafter(hit[j].t, INFINITY);
    check_equal(&m, bvh, ray, n, again);
    for (int j = 0; j < n; j++)
      assert_int_equal(again[j].primitive, j % 2 ? PRIMITIVE_NONE : hit[j].primitive);
  }
  if (n_hits < 30) fail_msg("%s: only %d rays hit anything", hard_scenes[scene].name, n_hits);
  mesh_release(&m);
}

static void a_few_triangles_have_no_tree_unless_it_is_asked_for(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  struct mesh m = mesh_new(400, 1000);
  few(&m, &draw);
  mesh_finish(&m);
  assert_non_null(bvh_build(&m.scene, (struct bvh_options){0}, &m.arena)->few);
  assert_null(bvh_build(&m.scene, (struct bvh_options){.tree = true}, &m.arena)->few);
  mesh_add_triangle(&m, vec(0, 0, 0), vec(1, 0, 0), vec(0, 1, 0));
  mesh_finish(&m);
  assert_null(bvh_build(&m.scene, (struct bvh_options){0}, &m.arena)->few);
  mesh_release(&m);
}

static void the_tree_finds_what_brute_force_finds(void **state) {
  (void)state;
  for (int i = 0; i < N_SCENES; i++) check_scene(i, (struct bvh_options){0}, MANY, __func__);
}

static void leaves_of_one_primitive_change_nothing(void **state) {
  (void)state;
  for (int i = 0; i < N_SCENES; i++)
    check_scene(i, (struct bvh_options){.leaf_size = 1}, SOME, __func__);
}

static void one_leaf_of_everything_changes_nothing(void **state) {
  (void)state;
  for (int i = 0; i < N_SCENES; i++)
    check_scene(i, (struct bvh_options){.leaf_size = 100000}, SOME, __func__);
}

static void parts_of_a_few_primitives_change_nothing(void **state) {
  (void)state;
  for (int i = 0; i < N_SCENES; i++)
    check_scene(i, (struct bvh_options){.threads = 2, .part_size = 7}, SOME, __func__);
}

static void check_same_tree(const struct bvh *a, const struct bvh *b) {
  struct bvh_statistics s = bvh_statistics(a), t = bvh_statistics(b);
  assert_memory_equal(&s, &t, sizeof s);
  assert_int_equal(a->root, b->root);
  assert_int_equal(a->n_nodes, b->n_nodes);
  assert_int_equal(a->n_blocks, b->n_blocks);
  assert_int_equal(a->n_others, b->n_others);
  if (a->n_nodes) assert_memory_equal(a->node, b->node, a->n_nodes * sizeof *a->node);
  if (a->n_blocks) assert_memory_equal(a->block, b->block, a->n_blocks * sizeof *a->block);
  if (a->n_others) assert_memory_equal(a->other, b->other, a->n_others * sizeof *a->other);
}

static void the_tree_does_not_depend_on_the_number_of_threads(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < N_SCENES; i++) {
    struct mesh m = mesh_new(400, 1000);
    hard_scenes[i].add(&m, &draw);
    mesh_finish(&m);
    static const int threads[] = {1, 2, 7};
    struct bvh *bvh[3];
    for (int k = 0; k < 3; k++) {
      struct bvh_options options = {.threads = threads[k], .part_size = 7};
      bvh[k] = bvh_build(&m.scene, options, &m.arena);
      check_same_tree(bvh[0], bvh[k]);
    }
    mesh_release(&m);
  }
}

// ---- watertight ----
struct target {
  struct mesh *mesh;
  struct vec center;
  double half; // of a cube inside the mesh
};

// Every third ray at a vertex, at an edge, at the middle of an edge.
static struct ray aimed_ray(const struct target *target, struct draw *draw, int j) {
  struct vec o = vec_add(target->center, draw_in_cube(draw, target->half));
  struct picked t = pick_triangle(target->mesh, draw);
  double u = j % 3 == 0 ? 0 : j % 3 == 1 ? draw_unit(draw) : 0.5;
  int corner = draw_below(draw, 3);
  struct vec a = t.p[corner], b = t.p[(corner + 1) % 3];
  struct vec at = vec_along(a, vec_sub(b, a), u), d = vec_sub(at, o);
  return (struct ray){o, j % 2 ? vec_normalize(d) : d, INFINITY, PRIMITIVE_NONE};
}

static void check_closed(struct mesh *m, struct vec center, double half, int leaf_size,
                         const char *name) {
  enum { N = 1 << 17, BATCH = 1 << 10 };
  static struct ray ray[BATCH];
  static struct hit hit[BATCH];
  struct draw draw = draw_named(name);
  struct target target = {m, center, half};
  mesh_finish(m);
  struct bvh *bvh = bvh_build(&m->scene, (struct bvh_options){.leaf_size = leaf_size}, &m->arena);
  int leaks = 0;
  for (int batch = 0; batch < N / BATCH; batch++) {
    for (int j = 0; j < BATCH; j++) ray[j] = aimed_ray(&target, &draw, j);
    bvh_closest(bvh, ray, hit, BATCH);
    for (int j = 0; j < BATCH; j++) leaks += hit[j].primitive == PRIMITIVE_NONE;
  }
  if (leaks) fail_msg("%d of %d rays leave the closed mesh", leaks, N);
  mesh_release(m);
}

static void no_ray_leaves_a_sphere_of_triangles(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 20 << 8);
  mesh_add_shape(&m, &shape_trianglemesh);
  mesh_add_icosphere(&m, vec(0.3, -0.2, 0.7), 2.385, 4);
  check_closed(&m, vec(0.3, -0.2, 0.7), 1.2, 0, __func__);
}

static void no_ray_leaves_a_box_of_triangles(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 12 * 20 * 20);
  mesh_add_shape(&m, &shape_trianglemesh);
  mesh_add_grid_box(&m, vec(0, 0, 0), 1, 20);
  check_closed(&m, vec(0, 0, 0), 0.999, 1, __func__);
}

static void no_ray_leaves_a_box_of_patches(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 6 * 20 * 20 * 2);
  mesh_add_shape(&m, &shape_bilinearmesh);
  mesh_add_grid_box(&m, vec(0, 0, 0), 1, 20);
  check_closed(&m, vec(0, 0, 0), 0.999, 1, __func__);
}

// Moved corners make every patch a twisted one; neighbours still share them.
static void no_ray_leaves_a_body_of_twisted_patches(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 6 * 12 * 12 * 2);
  mesh_add_shape(&m, &shape_bilinearmesh);
  mesh_add_grid_box(&m, vec(0, 0, 0), 1, 12);
  for (uint32_t k = 0; k < m.scene.n_positions; k++) {
    float *p = m.scene.position[k];
    float scale = 1 + 0.3f * p[0] * p[1] + 0.2f * p[1] * p[2] * p[2];
    for (int j = 0; j < 3; j++) p[j] *= scale;
  }
  check_closed(&m, vec(0, 0, 0), 0.3, 0, __func__);
}

static void no_ray_leaves_a_sphere_a_million_away(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 20 << 6);
  mesh_add_shape(&m, &shape_trianglemesh);
  mesh_add_icosphere(&m, vec(1e6, -1e6, 1e6), 5.7, 3);
  check_closed(&m, vec(1e6, -1e6, 1e6), 2.5, 0, __func__);
}

static void no_ray_leaves_a_sphere_of_a_millimetre(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 20 << 8);
  mesh_add_shape(&m, &shape_trianglemesh);
  mesh_add_icosphere(&m, vec(0.3, -0.2, 0.7), 1e-3, 4);
  check_closed(&m, vec(0.3, -0.2, 0.7), 5e-4, 1, __func__);
}

// ---- the tree itself ----
static void a_hundred_thousand_coincident_triangles_are_a_balanced_tree(void **state) {
  (void)state;
  enum { N = 100000 };
  struct mesh m = mesh_new(1, N);
  mesh_add_shape(&m, &shape_trianglemesh);
  for (int i = 0; i < N; i++) mesh_add_triangle(&m, vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1));
  mesh_finish(&m);
  struct bvh *bvh = bvh_build(&m.scene, (struct bvh_options){0}, &m.arena);
  assert_true(bvh_statistics(bvh).depth <= 17); // ceil(log2(N))
  struct ray ray = {vec(0, 0, 0), vec(0.3, 0.4, 0.5), INFINITY, PRIMITIVE_NONE};
  struct hit hit;
  bvh_closest(bvh, &ray, &hit, 1);
  assert_int_equal(hit.primitive, 0); // the smallest number
  ray.leaving = 7;
  bvh_closest(bvh, &ray, &hit, 1);
  assert_int_equal(hit.primitive, PRIMITIVE_NONE); // all lie in the plane that is left
  mesh_release(&m);
}

static void the_depth_is_bounded(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 1000);
  ever_smaller(&m, NULL);
  mesh_finish(&m);
  struct bvh *bvh = bvh_build(&m.scene, (struct bvh_options){.leaf_size = 1}, &m.arena);
  struct bvh_statistics statistics = bvh_statistics(bvh);
  assert_true(statistics.depth >
              64 / 7); // BVH_SAH_DEPTH: the bound of the binary tree is put to use
  assert_true(statistics.depth <= 64 + 10); // + ceil(log2(870))
  assert_int_equal(statistics.leaves, m.scene.n_primitives);
  assert_true(statistics.nodes >= (m.scene.n_primitives - 1 + 6) / 7);
  assert_true(statistics.nodes < m.scene.n_primitives);
  mesh_release(&m);
}

static void an_empty_scene_is_never_hit(void **state) {
  (void)state;
  struct mesh m = mesh_new(1, 1);
  struct bvh *bvh = bvh_build(&m.scene, (struct bvh_options){0}, &m.arena);
  struct ray ray = {vec(0, 0, 0), vec(0, 0, 1), INFINITY, PRIMITIVE_NONE};
  struct hit hit;
  unsigned char blocked;
  bvh_closest(bvh, &ray, &hit, 1);
  bvh_any(bvh, &ray, &blocked, 1);
  assert_int_equal(hit.primitive, PRIMITIVE_NONE);
  assert_true(hit.t == INFINITY);
  assert_false(blocked);
  mesh_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_few_triangles_have_no_tree_unless_it_is_asked_for),
      cmocka_unit_test(the_tree_finds_what_brute_force_finds),
      cmocka_unit_test(leaves_of_one_primitive_change_nothing),
      cmocka_unit_test(one_leaf_of_everything_changes_nothing),
      cmocka_unit_test(parts_of_a_few_primitives_change_nothing),
      cmocka_unit_test(the_tree_does_not_depend_on_the_number_of_threads),
      cmocka_unit_test(no_ray_leaves_a_sphere_of_triangles),
      cmocka_unit_test(no_ray_leaves_a_box_of_triangles),
      cmocka_unit_test(no_ray_leaves_a_box_of_patches),
      cmocka_unit_test(no_ray_leaves_a_body_of_twisted_patches),
      cmocka_unit_test(no_ray_leaves_a_sphere_a_million_away),
      cmocka_unit_test(no_ray_leaves_a_sphere_of_a_millimetre),
      cmocka_unit_test(a_hundred_thousand_coincident_triangles_are_a_balanced_tree),
      cmocka_unit_test(the_depth_is_bounded),
      cmocka_unit_test(an_empty_scene_is_never_hit),
  };
  return cmocka_run_group_tests_name("bvh", tests, NULL, NULL);
}
