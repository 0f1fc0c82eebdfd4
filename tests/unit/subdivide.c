// Loop subdivision against its masks worked out by hand, and against what any of its surfaces
// obeys.
#include "mesh/mesh.h"
#include "numeric/rng.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

static struct arena keep, scratch;

static int reserve(void **state) {
  (void)state;
  keep = arena_reserve(), scratch = arena_reserve();
  return 0;
}

static struct mesh subdivided(const struct mesh *mesh, int levels, struct arena *arena) {
  struct mesh out;
  struct problem problem = {{0}};
  if (!mesh_subdivide(mesh, levels, arena, scratch, &out, &problem)) fail_msg("%s", problem.text);
  return out;
}

// Ten operations a level on numbers below 10, five levels.
#define ROUNDING (10 * 10 * 5 * DBL_EPSILON)

static void assert_near(const double *a, double x, double y, double z) {
  if (!(fabs(a[0] - x) <= ROUNDING && fabs(a[1] - y) <= ROUNDING && fabs(a[2] - z) <= ROUNDING))
    fail_msg("(%.17g, %.17g, %.17g) is not (%.17g, %.17g, %.17g)", a[0], a[1], a[2], x, y, z);
}

// ---- the octahedron ----
static double octahedron_p[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
static uint32_t octahedron_t[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}; // outward
static const struct mesh octahedron = {
    .n_vertices = 6, .n_triangles = 8, .p = octahedron_p, .triangle = octahedron_t};

// Valence 4: beta = 3/32, gamma = 1 / (4 + 4) = 1/8; the ring's sum is 0, so the limit is p / 2, at
// every level. An edge's vertex, 3/8 (a + b) + 1/8 (c - c) for any edge ab, is regular; its ring is
// a' and b' = 5/8 of a and b, and four edge vertices of sum 3/4 (a + b): 1/2 of it and 1/12 of
// them.
static void the_octahedron_goes_to_its_limits(void **state) {
  (void)state;
  for (int levels = 0; levels <= 5; levels++) {
    struct arena arena = keep;
    struct mesh m = subdivided(&octahedron, levels, &arena);
    assert_int_equal(m.n_triangles, 8 << 2 * levels);
    assert_int_equal(m.n_vertices, (4 << 2 * levels) + 2); // Euler
    for (int k = 0; k < 6; k++) {
      const double *p = octahedron_p[k], *n = m.n[k];
      assert_near(m.p[k], p[0] / 2, p[1] / 2, p[2] / 2);
      // Clockwise rings: pbrt's normals point inward where the triangles face outward.
      double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      assert_true(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] <= -(1 - 1e-12) * length && length > 0);
    }
    if (levels == 0) continue;
    const double edge = 0.5 * 3 / 8 + (5.0 / 8 + 3.0 / 4) / 12; // per unit of a + b
    int found = 0;
    for (uint32_t k = 6; k < m.n_vertices; k++)
      found += fabs(fabs(m.p[k][0]) - edge) <= ROUNDING && fabs(fabs(m.p[k][1]) - edge) <= ROUNDING;
    assert_int_equal(found, 4); // of the 12, those in the plane z = 0
  }
}

// The octahedron's 48 symmetries and those of the surface are the same: every vertex has its
// images. Coordinates are sums in different orders, so equal up to rounding.
static void the_octahedron_stays_symmetric(void **state) {
  (void)state;
  struct arena arena = keep;
  struct mesh m = subdivided(&octahedron, 3, &arena);
  for (uint32_t k = 0; k < m.n_vertices; k++)
    for (int image = 0; image < 2; image++) { // these two generate a group of order 6
      const double *p = m.p[k];
      double q[3] = {p[1], p[2], p[0]};
      if (image) q[0] = -p[0], q[1] = p[2], q[2] = p[1];
      double nearest = INFINITY;
      for (uint32_t j = 0; j < m.n_vertices; j++) {
        double d = fabs(m.p[j][0] - q[0]) + fabs(m.p[j][1] - q[1]) + fabs(m.p[j][2] - q[2]);
        nearest = d < nearest ? d : nearest;
      }
      assert_true(nearest <= ROUNDING);
    }
}

// ---- one triangle: all boundary, valence 2 ----
static double triangle_p[4][3] = {{0.5, -1, 2}, {3, 0.25, 1}, {-2, 1.5, 0.125}, {7, 7, 7}};
static uint32_t triangle_t[1][3] = {{0, 1, 2}};
static const struct mesh triangle = {
    .n_vertices = 4, .n_triangles = 1, .p = triangle_p, .triangle = triangle_t};

static void boundaries_follow_their_masks(void **state) {
  (void)state;
  struct arena arena = keep;
  struct mesh zero = subdivided(&triangle, 0, &arena), one = subdivided(&triangle, 1, &arena);
  assert_int_equal(one.n_triangles, 4);
  assert_int_equal(one.n_vertices, 7);
  for (int k = 0; k < 3; k++) {
    const double *a = triangle_p[k], *b = triangle_p[(k + 1) % 3], *c = triangle_p[(k + 2) % 3];
    double limit[3], even[3], odd[3];
    for (int j = 0; j < 3; j++) {
      limit[j] = 0.6 * a[j] + 0.2 * (b[j] + c[j]);
      // 3/5 of (6 a + b + c) / 8 and 1/5 of (a + b) / 2 and (a + c) / 2
      even[j] = 0.6 * (6 * a[j] + b[j] + c[j]) / 8 + 0.2 * (2 * a[j] + b[j] + c[j]) / 2;
      // 3/5 of (a + b) / 2 and 1/5 of (6 a + b + c) / 8 and (6 b + a + c) / 8
      odd[j] = 0.6 * (a[j] + b[j]) / 2 + 0.2 * (7 * a[j] + 7 * b[j] + 2 * c[j]) / 8;
    }
    assert_near(zero.p[k], limit[0], limit[1], limit[2]);
    assert_near(one.p[k], even[0], even[1], even[2]);
    assert_near(one.p[4 + k], odd[0], odd[1], odd[2]);
  }
  // A vertex without a triangle stays.
  assert_near(one.p[3], 7, 7, 7);
  assert_near(one.n[3], 0, 0, 0);
}

// ---- a height field ----
enum { SIDE = 7 };
struct grid {
  double p[SIDE * SIDE][3];
  uint32_t t[2 * (SIDE - 1) * (SIDE - 1)][3];
};

static struct mesh grid_mesh(struct grid *g) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < SIDE * SIDE; i++) {
    g->p[i][0] = i % SIDE, g->p[i][1] = i / SIDE, g->p[i][2] = 0;
    if (i % SIDE == SIDE - 1 || i / SIDE == SIDE - 1) continue;
    const uint32_t a[3] = {i, i + 1, i + SIDE + 1}, b[3] = {i, i + SIDE + 1, i + SIDE};
    memcpy(g->t[n++], a, sizeof a), memcpy(g->t[n++], b, sizeof b);
  }
  return (struct mesh){.n_vertices = SIDE * SIDE, .n_triangles = n, .p = g->p, .triangle = g->t};
}

// Linear functions are reproduced where the mesh is regular; a plane stays a plane everywhere.
static void planes_stay_planes(void **state) {
  (void)state;
  struct grid g;
  struct mesh flat = grid_mesh(&g);
  for (int i = 0; i < SIDE * SIDE; i++) g.p[i][2] = 0.5 * g.p[i][0] - 0.25 * g.p[i][1] + 3;
  for (int levels = 0; levels <= 3; levels++) {
    struct arena arena = keep;
    struct mesh m = subdivided(&flat, levels, &arena);
    for (uint32_t k = 0; k < m.n_vertices; k++) {
      const double *p = m.p[k], *n = m.n[k];
      assert_true(fabs(p[2] - (0.5 * p[0] - 0.25 * p[1] + 3)) <= 10 * ROUNDING);
      double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      double cosine = (0.5 * n[0] - 0.25 * n[1] - n[2]) / (sqrt(1.3125) * length);
      assert_true(fabs(cosine - 1) <= 1e-12); // below, as the rings are clockwise
    }
    for (uint32_t k = 0; k < SIDE * SIDE; k++) // vertices without a boundary nearby stay
      if (k % SIDE > 1 && k % SIDE < SIDE - 2 && k / SIDE > 1 && k / SIDE < SIDE - 2)
        assert_near(m.p[k], g.p[k][0], g.p[k][1], g.p[k][2]);
  }
}

static double draw(struct rng_key key, uint64_t k) {
  double u0, u1;
  rng_fill(key, 1, &k, 1, 0, &u0, &u1);
  return u0;
}

// A limit is one: the more the mesh was refined before, the same point. True of interior vertices
// of any valence two away from the boundary, whose weights 1/5 are no limit.
static void limits_do_not_depend_on_the_level(void **state) {
  (void)state;
  struct rng_key key = rng_key(rng_hash_name(__func__), 1, RNG_TEST);
  struct grid g;
  struct mesh rough = grid_mesh(&g);
  for (uint64_t i = 0; i < SIDE * SIDE; i++)
    for (uint64_t j = 0; j < 3; j++) g.p[i][j] += draw(key, 3 * i + j) - 0.5;
  // Turning a diagonal makes valences 5 and 7.
  uint32_t a = 3 * SIDE + 3, *t = g.t[2 * (3 * (SIDE - 1) + 3)], *u = t + 3;
  t[0] = a, t[1] = a + 1, t[2] = a + SIDE;
  u[0] = a + 1, u[1] = a + SIDE + 1, u[2] = a + SIDE;
  struct arena arena = keep;
  struct mesh zero = subdivided(&rough, 0, &arena);
  for (int levels = 1; levels <= 3; levels++) {
    struct mesh m = subdivided(&rough, levels, &arena);
    for (uint32_t k = 0; k < SIDE * SIDE; k++)
      if (k % SIDE > 0 && k % SIDE < SIDE - 1 && k / SIDE > 0 && k / SIDE < SIDE - 1)
        assert_near(m.p[k], zero.p[k][0], zero.p[k][1], zero.p[k][2]);
  }
}

// Every edge of a child belongs to two triangles of opposite directions, or one at the boundary,
// where there are twice as many as a level before.
static void refined_meshes_stay_manifold(void **state) {
  (void)state;
  struct grid g;
  struct mesh rough = grid_mesh(&g);
  for (int levels = 0; levels <= 2; levels++) {
    struct arena arena = keep;
    struct mesh m = subdivided(&rough, levels, &arena);
    int alone = 0;
    for (uint32_t i = 0; i < 3 * m.n_triangles; i++) {
      uint32_t from = m.triangle[i / 3][i % 3], to = m.triangle[i / 3][(i + 1) % 3], back = 0;
      for (uint32_t j = 0; j < 3 * m.n_triangles; j++) {
        uint32_t f = m.triangle[j / 3][j % 3], e = m.triangle[j / 3][(j + 1) % 3];
        assert_true(i == j || f != from || e != to);
        back += f == to && e == from;
      }
      alone += back == 0;
    }
    assert_int_equal(alone, 4 * (SIDE - 1) << levels);
  }
}

static void what_is_no_surface_is_refused(void **state) {
  (void)state;
  static uint32_t twice[1][3] = {{0, 1, 1}}, same[2][3] = {{0, 1, 2}, {0, 1, 3}};
  static uint32_t three[3][3] = {{0, 1, 2}, {1, 0, 3}, {0, 1, 3}};
  static const struct {
    uint32_t (*triangle)[3], n;
    int levels;
    const char *said;
  } cases[] = {{twice, 1, 1, "triangle 0 has vertex 1 twice"},
               {same, 2, 1, "triangles 0 and 1, which share an edge, face opposite sides"},
               {three, 3, 1, "more than two triangles share the edge from vertex 0 to 1"},
               {triangle_t, 1, 16, "16 levels make more than"},
               {triangle_t, 1, 2000000000, "2000000000 levels make more than"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct mesh in = triangle, out;
    struct problem problem = {{0}};
    struct arena arena = keep;
    in.triangle = cases[k].triangle, in.n_triangles = cases[k].n;
    assert_false(mesh_subdivide(&in, cases[k].levels, &arena, scratch, &out, &problem));
    if (!strstr(problem.text, cases[k].said)) fail_msg("%s", problem.text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_octahedron_goes_to_its_limits),
      cmocka_unit_test(the_octahedron_stays_symmetric),
      cmocka_unit_test(boundaries_follow_their_masks),
      cmocka_unit_test(planes_stay_planes),
      cmocka_unit_test(limits_do_not_depend_on_the_level),
      cmocka_unit_test(refined_meshes_stay_manifold),
      cmocka_unit_test(what_is_no_surface_is_refused),
  };
  return cmocka_run_group_tests_name("subdivide", tests, reserve, NULL);
}
