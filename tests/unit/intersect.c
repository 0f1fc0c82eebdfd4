// The ray tests of single primitives, against geometry.
#include "scene/shape/sphere.h"
#include "scene/shape/triangle.h"
#include "tests/unit/meshes.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const double two_pi = 6.283185307179586;

static struct ray ray_of(struct vec o, struct vec d) {
  return (struct ray){o, d, INFINITY, PRIMITIVE_NONE};
}

static bool primitive_hit(const struct mesh *m, uint32_t p, const struct ray *ray, double *t) {
  const struct shape *shape = &m->scene.shape[m->scene.shape_of[p]];
  return shape->type->intersect(&m->scene, shape, p, ray, t);
}

// The first primitive of m.
static void expect_hit(const struct mesh *m, struct ray ray, double expected, double tolerance) {
  double t = NAN;
  assert_true(primitive_hit(m, 0, &ray, &t));
  if (!(fabs(t - expected) <= tolerance)) fail_msg("t = %.17g, not %.17g", t, expected);
}

static void expect_miss(const struct mesh *m, struct ray ray) {
  double t = NAN;
  if (primitive_hit(m, 0, &ray, &t)) fail_msg("hit at t = %.17g", t);
}

// ---- clip ----
// Components that make trouble: zeros of both signs, near zero, near overflow and underflow.
static double draw_component(struct draw *draw) {
  static const double special[] = {0, -0.0, 1e-17, -1e-17, 1e-310, -1e-310, 3e300, 9.5e-7, -1e-6};
  return draw_below(draw, 3) ? draw_between(draw, -1, 1) : special[draw_below(draw, 9)];
}

static float draw_float(struct draw *draw) {
  static const float special[] = {0, 1, -1, 0.5f, 1e-38f, -1e-20f, 3e38f};
  return draw_below(draw, 3) ? (float)draw_between(draw, -1, 1) : special[draw_below(draw, 7)];
}

static void the_clip_of_a_box_contains_the_clip_of_every_box_inside(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  int n_clipped = 0;
  for (int i = 0; i < 100000; i++) {
    struct box inner, outer;
    for (int k = 0; k < 3; k++) {
      float x[4];
      for (int j = 0; j < 4; j++) x[j] = draw_float(&draw);
      for (int j = 1; j < 4; j++) // insertion sort
        for (int l = j; l > 0 && x[l] < x[l - 1]; l--) {
          float swap = x[l];
          x[l] = x[l - 1], x[l - 1] = swap;
        }
      outer.lo[k] = x[0], outer.hi[k] = x[3];
      inner.lo[k] = x[1], inner.hi[k] = draw_below(&draw, 4) ? x[2] : x[1];
    }
    double o[3], d[3];
    for (int k = 0; k < 3; k++) {
      o[k] = draw_below(&draw, 3) ? draw_between(&draw, -1, 1) : (double)draw_float(&draw);
      double at = draw_between(&draw, (double)inner.lo[k], (double)inner.hi[k]);
      d[k] = draw_below(&draw, 4) ? at - o[k] : draw_component(&draw);
    }
    struct ray ray = ray_of(vec(o[0], o[1], o[2]), vec(d[0], d[1], d[2]));
    struct cone cone;
    cone_set(&cone, &ray);
    double t0, t1, outer_t0, outer_t1;
    if (!cone_clip(&cone, &inner, &t0, &t1)) continue;
    n_clipped++;
    assert_true(cone_clip(&cone, &outer, &outer_t0, &outer_t1));
    assert_true(outer_t0 <= t0 && t1 <= outer_t1);
  }
  assert_true(n_clipped > 30000);
}

// The origin p - t d is rounded by eps |origin|, far less than the cone is wide there.
static void the_clip_of_a_box_contains_the_t_of_its_points(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < 20000; i++) {
    struct vec a = draw_in_cube(&draw, 1), b = draw_in_cube(&draw, 1), d = draw_direction(&draw);
    struct vec mid = vec_scale(vec_add(a, b), 0.5), half = vec_scale(vec_sub(b, a), 0.5);
    struct box box = {{(float)(mid.x - fabs(half.x)), (float)(mid.y - fabs(half.y)), -0.3f},
                      {(float)(mid.x + fabs(half.x)), (float)(mid.y + fabs(half.y)), -0.3f}};
    if (i % 3 == 0) d.x = 0;
    if (i % 5 == 0) d.y = -0.0;
    struct vec p = vec(draw_between(&draw, (double)box.lo[0], (double)box.hi[0]),
                       draw_between(&draw, (double)box.lo[1], (double)box.hi[1]), (double)-0.3f);
    double t = draw_between(&draw, 1e-3, 100), t0, t1;
    struct ray ray = ray_of(vec_along(p, d, -t), d);
    struct cone cone;
    cone_set(&cone, &ray);
    assert_true(cone_clip(&cone, &box, &t0, &t1));
    assert_true(t0 <= t && t <= t1);
  }
}

static void a_box_beside_or_behind_the_ray_is_clipped_away(void **state) {
  (void)state;
  const struct box box = {{1, 1, 1}, {2, 2, 2}};
  static const double apart = 1e-3; // a thousand times the aperture at these distances
  const struct ray rays[] = {
      {{1.5, 1.5, 3}, {0, 0, 1}, INFINITY, PRIMITIVE_NONE},       // behind
      {{2 + apart, 1.5, 0}, {0, 0, 1}, INFINITY, PRIMITIVE_NONE}, // beside, parallel
      {{1.5, 1 - apart, 0}, {-0.0, 0, 1}, INFINITY, PRIMITIVE_NONE},
      {{1.5, 2 + apart, 5}, {0, 1e-9, -1}, INFINITY, PRIMITIVE_NONE},
      {{0, 0, 1.5}, {1, 2 + apart, 0}, INFINITY, PRIMITIVE_NONE}, // past the edge x = 1, y = 2
  };
  for (int i = 0; i < 5; i++) {
    struct cone cone;
    cone_set(&cone, &rays[i]);
    double t0, t1;
    assert_false(cone_clip(&cone, &box, &t0, &t1));
  }
}

// ---- triangles ----
static struct mesh one_triangle(struct vec a, struct vec b, struct vec c) {
  struct mesh m = mesh_new(1, 2);
  mesh_add_shape(&m, &shape_trianglemesh);
  mesh_add_triangle(&m, a, b, c);
  return m;
}

static void a_triangle_is_hit_on_both_sides_edges_and_corners_included(void **state) {
  (void)state;
  struct mesh m = one_triangle(vec(0, 0, 4), vec(1, 0, 4), vec(0, 1, 4));
  const double just = 1e-12;
  for (int side = -1; side <= 1; side += 2) {
    double z = 4 - 4 * side;
    struct vec d = vec(0, 0, 2 * side);
    expect_hit(&m, ray_of(vec(0.25, 0.375, z), d), 2, 0);
    expect_hit(&m, ray_of(vec(0.5, 0.5, z), d), 2, 0);
    expect_hit(&m, ray_of(vec(0, 0.5, z), d), 2, 0);
    expect_hit(&m, ray_of(vec(0, 0, z), d), 2, 0);
    expect_hit(&m, ray_of(vec(1, 0, z), d), 2, 0);
    expect_miss(&m, ray_of(vec(-just, 0.5, z), d));
    expect_miss(&m, ray_of(vec(0.5, -just, z), d));
    expect_miss(&m, ray_of(vec(0.5, 0.5 + just, z), d));
    expect_miss(&m, ray_of(vec(0.25, 0.375, z), vec_scale(d, -1)));
  }
  mesh_release(&m);
}

static void t_max_and_zero_are_excluded_and_leaving_is_ignored(void **state) {
  (void)state;
  struct mesh m = one_triangle(vec(0, 0, 4), vec(1, 0, 4), vec(0, 1, 4));
  struct ray ray = ray_of(vec(0.25, 0.375, 0), vec(0, 0, 2));
  ray.t_max = 2;
  expect_miss(&m, ray);
  ray.t_max = 2 + 2 * DBL_EPSILON;
  expect_hit(&m, ray, 2, 0);
  ray.leaving = 0;
  expect_miss(&m, ray);
  expect_miss(&m, ray_of(vec(0.25, 0.375, 4), vec(0, 0, 2)));
  mesh_release(&m);
}

static void a_triangle_without_area_or_seen_edge_on_is_never_hit(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < 2000; i++) {
    struct vec a = vec(draw_below(&draw, 64), draw_below(&draw, 64), draw_below(&draw, 64));
    struct vec b = vec(draw_below(&draw, 64), draw_below(&draw, 64), draw_below(&draw, 64));
    struct vec o = draw_in_cube(&draw, 100), third[] = {a, b, vec_scale(vec_add(a, b), 0.5)};
    struct mesh m = one_triangle(a, b, third[i % 3]);
    expect_miss(&m, ray_of(o, vec_sub(a, o)));
    expect_miss(&m, ray_of(o, vec_sub(third[2], o)));
    mesh_release(&m);
  }
  struct mesh m = one_triangle(vec(0, 0, 1), vec(1, 0, 1), vec(0, 1, 1));
  expect_miss(&m, ray_of(vec(-3, 0.25, 1), vec(1, 0, 0)));
  mesh_release(&m);
}

static void a_common_edge_belongs_to_both_triangles(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < 2000; i++) {
    struct mesh m = one_triangle(vec(0, 0, 0), vec(1, 1, 0), vec(0, 1, 0));
    mesh_add_triangle(&m, vec(1, 1, 0), vec(0, 0, 0), vec(1, 0, 0));
    // At a point of the diagonal, from a point above it: the diagonal's edge function is zero.
    double u = draw_unit(&draw), v = draw_between(&draw, -2, 3);
    struct ray ray = ray_of(vec(v, v, 1.5), vec_sub(vec(u, u, 0), vec(v, v, 1.5)));
    double t[2];
    assert_true(primitive_hit(&m, 0, &ray, &t[0]) && primitive_hit(&m, 1, &ray, &t[1]));
    assert_true(t[0] == t[1]); // one plane
    mesh_release(&m);
  }
}

// Aimed at the point with barycentric u, v from o: t = 1. The numerator n . p0' is off by at most
// 8 roundings of |n| |p0'|, and so is the target (p0' in place of p').
// Two triangles with a common edge; the fourth vertex is bent by `fold` (> 0: towards the viewer).
static struct mesh folded(struct draw *draw, double z, double fold) {
  struct mesh m = mesh_new(1, 2);
  mesh_add_shape(&m, &shape_trianglemesh);
  struct vec a = vec(-draw_between(draw, 1, 2), -draw_between(draw, 1, 2), z);
  struct vec c = vec(draw_between(draw, 1, 2), draw_between(draw, 1, 2), z);
  mesh_add_triangle(&m, a, vec(draw_between(draw, 1, 2), -draw_between(draw, 1, 2), z), c);
  mesh_add_triangle(&m, a, c, vec(-draw_between(draw, 1, 2), draw_between(draw, 1, 2), z + fold));
  return m;
}

// The same of two patches: plane, not parallelograms; the second is beyond the edge.
static struct mesh folded_patches(struct draw *draw, double z, double fold) {
  struct mesh m = mesh_new(1, 2);
  mesh_add_shape(&m, &shape_bilinearmesh);
  struct vec a = vec(-draw_between(draw, 1, 2), -draw_between(draw, 1, 2), z);
  struct vec c = vec(draw_between(draw, 1, 2), draw_between(draw, 1, 2), z);
  struct vec b = vec(draw_between(draw, 0, 1), -draw_between(draw, 2, 4), z);
  struct vec d = vec(-draw_between(draw, 0, 1), draw_between(draw, 2, 4), z + fold);
  mesh_add_bilinear(&m, (const struct vec[4]){a, vec_along(b, vec_sub(a, c), 0.2), c, b});
  mesh_add_bilinear(&m, (const struct vec[4]){c, d, a, vec_along(d, vec_sub(a, c), 0.3)});
  return m;
}

// What a ray that leaves primitive 0 at a point of the common edge meets of primitive 1, out of n
// tries towards the viewer's side; `across`: only directions that pass over primitive 1.
static int met_from_the_edge(const char *name, bool patches, double fold, bool across, int n) {
  struct draw draw = draw_named(name);
  int met = 0;
  for (int i = 0; i < n; i++) {
    double z = draw_between(&draw, -3, 3);
    struct mesh m = patches ? folded_patches(&draw, z, fold) : folded(&draw, z, fold);
    struct vec a = mesh_vertex(&m, 0), c = mesh_vertex(&m, 2), eye = vec(0.1, -0.2, 9);
    struct vec on_edge = vec_along(a, vec_sub(c, a), draw_between(&draw, 0.1, 0.9)), d;
    struct ray down = ray_of(eye, vec_normalize(vec_sub(on_edge, eye)));
    do d = vec(draw_between(&draw, -1, 1), draw_between(&draw, -1, 1), draw_between(&draw, 0, 0.2));
    while (across && vec_cross(vec_sub(c, a), d).z < 0.5);
    double t;
    if (primitive_hit(&m, 0, &down, &t)) { // rounding may leave the point to the neighbour
      struct ray up = ray_of(vec_along(down.o, down.d, t), d);
      up.leaving = 0;
      met += primitive_hit(&m, 1, &up, &t);
    }
    mesh_release(&m);
  }
  return met;
}

static void a_point_on_a_common_edge_is_not_shadowed_by_its_neighbour(void **state) {
  (void)state;
  for (int patches = 0; patches < 2; patches++) {
    assert_int_equal(met_from_the_edge("flat", patches, 0, false, 3000), 0);
    assert_int_equal(met_from_the_edge("bent away", patches, -0.5, false, 3000), 0);
    // Bent towards the viewer by more than the ray rises, the neighbour does shadow it, unless the
    // origin is rounded to its front.
    assert_true(met_from_the_edge("bent towards", patches, 8, true, 3000) > 500);
  }
}

static void the_t_of_a_triangle_is_where_its_plane_is(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < 20000; i++) {
    double scale = i % 2 ? 1 : 1e-3, far = i % 3 ? 1 : 1e4;
    struct vec at = draw_in_cube(&draw, far);
    struct mesh m = one_triangle(vec_add(at, draw_in_cube(&draw, scale)),
                                 vec_add(at, draw_in_cube(&draw, scale)),
                                 vec_add(at, draw_in_cube(&draw, scale)));
    struct vec a = mesh_vertex(&m, 0), ab = vec_sub(mesh_vertex(&m, 1), a),
               ac = vec_sub(mesh_vertex(&m, 2), a), o = draw_in_cube(&draw, far);
    struct vec n = vec_cross(ab, ac);
    double u = draw_between(&draw, 0.01, 0.98), v = (0.99 - u) * draw_unit(&draw) + 0.005;
    struct vec d = vec_sub(vec_along(vec_along(a, ab, u), ac, v), o);
    double size = vec_length(vec_sub(a, o)) + vec_length(a) + vec_length(ab) + vec_length(ac);
    double tolerance = 16 * DBL_EPSILON * vec_length(n) * size / fabs(vec_dot(n, d));
    double narrow = vec_length(n) / (vec_dot(ab, ab) + vec_dot(ac, ac));
    if (tolerance < 1e-9 && narrow > 1e-3) {
      expect_hit(&m, ray_of(o, d), 1, tolerance);
      expect_miss(&m, ray_of(o, vec_sub(vec_along(vec_along(a, ab, u), ac, 1.001 - u), o)));
      expect_miss(&m, ray_of(o, vec_sub(vec_along(vec_along(a, ab, -0.001), ac, v), o)));
    }
    mesh_release(&m);
  }
}

static void every_triangle_shape_is_known_to_the_tree(void **state) {
  (void)state;
  assert_true(shape_trianglemesh.intersect == triangle_intersect);
  assert_true(shape_sphere.intersect == sphere_intersect);
  assert_true(shape_disk.intersect == disk_intersect);
}

// ---- quadrics ----
static struct quadric quadric_plain(double radius) {
  struct quadric q = {.radius = radius, .z_min = -radius, .z_max = radius, .phi_max = two_pi};
  q.world_from_object = q.object_from_world = transform_identity();
  return q;
}

static struct mesh one_quadric(const struct shape_type *type, struct quadric q) {
  struct mesh m = mesh_new(1, 1);
  mesh_add_quadric(&m, type, q);
  return m;
}

static void a_sphere_is_hit_at_the_closest_root_ahead(void **state) {
  (void)state;
  struct mesh m = one_quadric(&shape_sphere, quadric_plain(1.5));
  expect_hit(&m, ray_of(vec(0, 0, -5), vec(0, 0, 2)), 1.75, 4 * DBL_EPSILON);
  expect_hit(&m, ray_of(vec(0, 0, -1), vec(0, 0, 2)), 1.25, 4 * DBL_EPSILON);
  expect_hit(&m, ray_of(vec(0.9, 0, -5), vec(0, 0, 1)), 5 - 1.2, 16 * DBL_EPSILON);
  expect_hit(&m, ray_of(vec(0, 0, 0), vec(0.3, 0, 0)), 5, 8 * DBL_EPSILON);
  expect_miss(&m, ray_of(vec(0, 0, 5), vec(0, 0, 2)));
  expect_miss(&m, ray_of(vec(1.5 + 1e-12, 0, -5), vec(0, 0, 2)));
  mesh_release(&m);
}

// b^2 - a c as it stands would lose all digits: b^2 = 1e16.
static void a_sphere_keeps_its_digits_far_away(void **state) {
  (void)state;
  struct mesh m = one_quadric(&shape_sphere, quadric_plain(1));
  expect_hit(&m, ray_of(vec(0.6, 0, -1e8), vec(0, 0, 1)), 1e8 - 0.8, 4 * DBL_EPSILON * 1e8);
  expect_hit(&m, ray_of(vec(0, -0.8, 1e8), vec(0, 0, -1)), 1e8 - 0.6, 4 * DBL_EPSILON * 1e8);
  mesh_release(&m);
}

// The origin is off the sphere by delta (its own rounding), which moves the other end of a chord at
// angle theta to the normal by delta (1 + 1 / cos theta).
static void a_ray_that_leaves_a_sphere_crosses_it_or_goes_free(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < 20000; i++) {
    struct quadric q = quadric_plain(1.37);
    struct vec center = vec_scale(draw_direction(&draw), i % 2 ? 0 : 1e5);
    const double c[3] = {center.x, center.y, center.z};
    for (int k = 0; k < 3; k++)
      q.world_from_object.m[k][3] = c[k], q.object_from_world.m[k][3] = -c[k];
    struct mesh m = one_quadric(&shape_sphere, q);
    struct vec n = draw_direction(&draw), d = draw_direction(&draw), s, t;
    if (i % 3 == 0) { // grazing
      vec_basis(n, &s, &t);
      d = vec_along(vec_add(vec_scale(s, 0.6), vec_scale(t, 0.8)), n,
                    draw_between(&draw, -1e-4, 1e-4));
    }
    struct ray ray = ray_of(vec_along(center, n, q.radius), d);
    ray.leaving = 0;
    double cosine = vec_dot(n, d) / vec_length(d);
    double delta = 8 * DBL_EPSILON * (vec_length(center) + q.radius);
    if (cosine > 0 && q.radius * cosine > 2 * delta) expect_miss(&m, ray);
    if (cosine < 0 && q.radius * cosine * cosine > 2 * delta)
      expect_hit(&m, ray, -2 * q.radius * cosine / vec_length(d),
                 2 * delta * (1 - 1 / cosine) / vec_length(d));
    mesh_release(&m);
  }
}

static void part_of_a_sphere_is_hit_where_it_is(void **state) {
  (void)state;
  struct quadric q = quadric_plain(1.5);
  q.z_min = 0;
  struct mesh m = one_quadric(&shape_sphere, q);
  expect_hit(&m, ray_of(vec(0, 0, -5), vec(0, 0, 2)), 3.25, 4 * DBL_EPSILON); // through the opening
  expect_hit(&m, ray_of(vec(0, 0, 5), vec(0, 0, -2)), 1.75, 4 * DBL_EPSILON);
  expect_miss(&m, ray_of(vec(-5, 0, -0.1), vec(1, 0, 0)));
  mesh_release(&m);
  q = quadric_plain(1.5), q.phi_max = two_pi / 2; // y >= 0
  m = one_quadric(&shape_sphere, q);
  expect_hit(&m, ray_of(vec(0.9, -5, 0), vec(0, 1, 0)), 6.2, 16 * DBL_EPSILON);
  expect_hit(&m, ray_of(vec(0.9, 5, 0), vec(0, -1, 0)), 3.8, 16 * DBL_EPSILON);
  expect_miss(&m, ray_of(vec(-5, -0.1, 0.3), vec(1, 0, 0)));
  mesh_release(&m);
}

// x -> 3 x + 1: t does not change under an affine map of the ray.
static void quadrics_are_hit_through_their_transform(void **state) {
  (void)state;
  struct quadric q = quadric_plain(1.5);
  q.height = 0.5;
  q.world_from_object.m[0][0] = 3, q.world_from_object.m[0][3] = 1;
  assert_true(transform_invert(q.world_from_object, &q.object_from_world));
  struct mesh m = one_quadric(&shape_sphere, q);
  expect_hit(&m, ray_of(vec(-9.5, 0, 0), vec(1, 0, 0)), 6, 32 * DBL_EPSILON);
  expect_hit(&m, ray_of(vec(1 + 3 * 0.9, 0, -5), vec(0, 0, 1)), 3.8, 32 * DBL_EPSILON);
  mesh_release(&m);
  m = one_quadric(&shape_disk, q);
  expect_hit(&m, ray_of(vec(5.4, 0, -1), vec(0, 0, 1)), 1.5, 4 * DBL_EPSILON);
  expect_miss(&m, ray_of(vec(5.6, 0, -1), vec(0, 0, 1)));
  mesh_release(&m);
}

static void a_disk_is_hit_within_its_ring_and_sector(void **state) {
  (void)state;
  struct quadric q = quadric_plain(2);
  q.height = 0.25, q.inner_radius = 0.5, q.phi_max = two_pi / 4; // x, y >= 0
  struct mesh m = one_quadric(&shape_disk, q);
  const double h = 0.7071067811865476;
  expect_hit(&m, ray_of(vec(0.51 * h, 0.51 * h, 1), vec(0, 0, -0.5)), 1.5, 0);
  expect_hit(&m, ray_of(vec(1.99 * h, 1.99 * h, 0), vec(0, 0, 0.5)), 0.5, 0);
  expect_miss(&m, ray_of(vec(0.49 * h, 0.49 * h, 1), vec(0, 0, -0.5)));
  expect_miss(&m, ray_of(vec(2.01 * h, 2.01 * h, 1), vec(0, 0, -0.5)));
  expect_miss(&m, ray_of(vec(-0.01, 1, 1), vec(0, 0, -0.5)));
  expect_miss(&m, ray_of(vec(1, -0.01, 1), vec(0, 0, -0.5)));
  expect_miss(&m, ray_of(vec(1, 1, 1), vec(0, 0, 0.5)));
  expect_miss(&m, ray_of(vec(-5, 1, 0.25), vec(1, 0, 0))); // in its plane
  struct ray ray = ray_of(vec(1, 1, 1), vec(0, 0, -0.5));
  ray.leaving = 0;
  expect_miss(&m, ray);
  mesh_release(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_clip_of_a_box_contains_the_clip_of_every_box_inside),
      cmocka_unit_test(the_clip_of_a_box_contains_the_t_of_its_points),
      cmocka_unit_test(a_box_beside_or_behind_the_ray_is_clipped_away),
      cmocka_unit_test(a_triangle_is_hit_on_both_sides_edges_and_corners_included),
      cmocka_unit_test(t_max_and_zero_are_excluded_and_leaving_is_ignored),
      cmocka_unit_test(a_triangle_without_area_or_seen_edge_on_is_never_hit),
      cmocka_unit_test(a_common_edge_belongs_to_both_triangles),
      cmocka_unit_test(a_point_on_a_common_edge_is_not_shadowed_by_its_neighbour),
      cmocka_unit_test(the_t_of_a_triangle_is_where_its_plane_is),
      cmocka_unit_test(every_triangle_shape_is_known_to_the_tree),
      cmocka_unit_test(a_sphere_is_hit_at_the_closest_root_ahead),
      cmocka_unit_test(a_sphere_keeps_its_digits_far_away),
      cmocka_unit_test(a_ray_that_leaves_a_sphere_crosses_it_or_goes_free),
      cmocka_unit_test(part_of_a_sphere_is_hit_where_it_is),
      cmocka_unit_test(quadrics_are_hit_through_their_transform),
      cmocka_unit_test(a_disk_is_hit_within_its_ring_and_sector),
  };
  return cmocka_run_group_tests_name("intersect", tests, NULL, NULL);
}
