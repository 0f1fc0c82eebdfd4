// Every registered shape, in several transformations: what it samples, covers and is hit by agree.
#include "scene_text.h"

#include <float.h>

static const double pi = 0x1.921fb54442d18p+1;

// Maps of world points back to the two uniform numbers of a sample, and the distance from the
// surface in object space; from the definition of each shape, not from its code.
struct inverse {
  double u0, u1, distance;
};

static double turn(double x, double y) {
  double phi = atan2(y, x);
  return phi < 0 ? phi + 2 * pi : phi;
}

static struct inverse sphere_inverse(const struct scene *scene, struct vec p) {
  const struct quadric *q = &scene->quadric[0];
  p = transform_point(&q->object_from_world, p);
  return (struct inverse){(p.z - q->z_min) / (q->z_max - q->z_min), turn(p.x, p.y) / q->phi_max,
                          vec_length(p) - q->radius};
}

static struct inverse disk_inverse(const struct scene *scene, struct vec p) {
  const struct quadric *q = &scene->quadric[0];
  p = transform_point(&q->object_from_world, p);
  double ri2 = q->inner_radius * q->inner_radius;
  return (struct inverse){(p.x * p.x + p.y * p.y - ri2) / (q->radius * q->radius - ri2),
                          turn(p.x, p.y) / q->phi_max, p.z - q->height};
}

static struct vec vertex(const struct scene *scene, uint32_t k) {
  const float *p = scene->position[scene->triangle[0][k]];
  return vec(p[0], p[1], p[2]);
}

// p = p0 + a (p1 - p0) + b (p2 - p0): s = a + b has density 2 s, b / s is uniform.
static struct inverse triangle_inverse(const struct scene *scene, struct vec p) {
  struct vec p0 = vertex(scene, 0), e1 = vec_sub(vertex(scene, 1), p0),
             e2 = vec_sub(vertex(scene, 2), p0), v = vec_sub(p, p0), n = vec_cross(e1, e2);
  double a = vec_dot(vec_cross(v, e2), n) / vec_dot(n, n),
         b = vec_dot(vec_cross(e1, v), n) / vec_dot(n, n), s = a + b;
  return (struct inverse){s * s, b / s, vec_dot(v, n) / vec_length(n)};
}

static struct inverse cylinder_inverse(const struct scene *scene, struct vec p) {
  const struct quadric *q = &scene->quadric[0];
  p = transform_point(&q->object_from_world, p);
  return (struct inverse){(p.z - q->z_min) / (q->z_max - q->z_min), turn(p.x, p.y) / q->phi_max,
                          sqrt(p.x * p.x + p.y * p.y) - q->radius};
}

static struct vec corner(const struct scene *scene, uint32_t k) {
  const float *p = scene->position[scene->patch[0][k]];
  return vec(p[0], p[1], p[2]);
}

// u and v by Newton's method from every start of a grid: the nearest point wins. (These are not the
// uniform numbers of a sample, which no test of `even` shapes asks for.)
static struct inverse patch_inverse(const struct scene *scene, struct vec p) {
  struct inverse best = {.distance = INFINITY};
  for (int start = 0; start < 9; start++) {
    double u = start % 3 * 0.5, v = start / 3 * 0.5;
    struct vec rest = p;
    for (int step = 0; step < 20; step++) {
      struct vec a = vec_along(vec_scale(corner(scene, 0), 1 - v), corner(scene, 2), v);
      struct vec b = vec_along(vec_scale(corner(scene, 1), 1 - v), corner(scene, 3), v);
      struct vec du = vec_sub(b, a),
                 dv = vec_add(vec_scale(vec_sub(corner(scene, 2), corner(scene, 0)), 1 - u),
                              vec_scale(vec_sub(corner(scene, 3), corner(scene, 1)), u));
      rest = vec_sub(p, vec_along(a, du, u));
      struct vec n = vec_cross(du, dv);
      if (step == 19 || !(vec_dot(n, n) > 0)) break;
      u += vec_dot(vec_cross(rest, dv), n) / vec_dot(n, n);
      v += vec_dot(vec_cross(du, rest), n) / vec_dot(n, n);
    }
    bool within = u >= -1e-9 && u <= 1 + 1e-9 && v >= -1e-9 && v <= 1 + 1e-9;
    if (within && vec_length(rest) < best.distance) best = (struct inverse){u, v, vec_length(rest)};
  }
  return best;
}

// One primitive each; `area` in closed form (0: there is none); even: samples are uniform.
static const struct {
  const char *name, *text;
  struct inverse (*inverse)(const struct scene *, struct vec p);
  double area;
  bool even;
} cases[] = {
    {"trianglemesh", "Shape \"trianglemesh\" \"point3 P\" [0 0 0  3 0 0  0 4 0]", triangle_inverse,
     6, true},
    {"trianglemesh",
     "Scale 1 2 -1 Translate 7 -1 2 Rotate 37 1 2 3 Shape \"trianglemesh\" \"point3 P\" "
     "[0.5 -1 2  3 0.25 1  -2 1.5 0.125]",
     triangle_inverse, 0, true},
    {"sphere", "Translate 1 2 3 Shape \"sphere\" \"float radius\" 0.75", sphere_inverse,
     4 * 0x1.921fb54442d18p+1 * 0.5625, true},
    {"sphere",
     "ReverseOrientation Rotate 37 1 2 3 Scale 2 2 -2 Shape \"sphere\" \"float radius\" 0.5 "
     "\"float zmin\" -0.25 \"float zmax\" 0.375 \"float phimax\" 180",
     sphere_inverse, 4 * 0.5 * 0x1.921fb54442d18p+1 * 0.625, true},
    {"sphere", "Translate -2 0 1 Rotate 20 1 1 0 Scale 1 3 0.5 Shape \"sphere\"", sphere_inverse, 0,
     false},
    {"disk", "Translate 0 0 -4 Rotate 50 1 0 0 Shape \"disk\" \"float radius\" 1.5", disk_inverse,
     0x1.921fb54442d18p+1 * 2.25, true},
    {"disk",
     "Scale 3 2 1 Shape \"disk\" \"float radius\" 1 \"float innerradius\" 0.5 \"float height\" 2 "
     "\"float phimax\" 90",
     disk_inverse, 6 * 0.25 * 0x1.921fb54442d18p+1 * 0.75, true},
    {"cylinder", "Translate 1 2 3 Scale 1 1 2 Shape \"cylinder\" \"float radius\" 0.75",
     cylinder_inverse, 4 * 0x1.921fb54442d18p+1 * 1.5, true},
    {"cylinder",
     "ReverseOrientation Rotate 37 1 2 3 Scale 2 2 -2 Shape \"cylinder\" \"float radius\" 0.5 "
     "\"float zmin\" 0.375 \"float zmax\" -0.25 \"float phimax\" 180",
     cylinder_inverse, 4 * 0.5 * 0x1.921fb54442d18p+1 * 0.625, true},
    {"cylinder", "Translate -2 0 1 Rotate 20 1 1 0 Scale 1 3 0.5 Shape \"cylinder\"",
     cylinder_inverse, 0, false},
    {"bilinearmesh", "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  3 0 0  0 4 0  3 4 0]",
     patch_inverse, 12, false},
    {"bilinearmesh", "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  3 0 0  1 4 0  2 4 0]",
     patch_inverse, 8, false}, // a trapezoid
    {"bilinearmesh",
     "Translate 1 0 2 Scale 1 -1 1 Shape \"bilinearmesh\" \"point3 P\" [0 0 0  2 0.5 1  -0.5 2 "
     "1.5  2 3 -1.5]",
     patch_inverse, 0, false},
    {"bilinearmesh", // a triangle
     "Translate 1 2 3 Shape \"bilinearmesh\" \"point3 P\" [0 0 0  3 0 0  0 4 0  0 4 0]",
     patch_inverse, 6, false},
    {"plymesh", "Shape \"plymesh\" \"string filename\" \"tests/data/meshes/triangle.ply\"",
     triangle_inverse, 6, true},
    {"loopsubdiv", // a triangle's corners go to 3/5 of themselves and 1/5 of the others
     "Shape \"loopsubdiv\" \"integer levels\" 0 \"point3 P\" [0 0 0  5 0 0  0 5 0]",
     triangle_inverse, 2, true},
};
enum { N_CASES = (int)(sizeof cases / sizeof *cases) };

static struct scene scene_of_case(int i) {
  char text[512];
  snprintf(text, sizeof text, "WorldBegin LightSource \"point\" %s", cases[i].text);
  return scene_of(text);
}

static void every_registered_shape_is_a_case_here(void **state) {
  (void)state;
  for (const struct shape_type *const *type = shape_types; *type; type++) {
    bool found = false;
    for (int i = 0; i < N_CASES; i++) found |= strcmp(cases[i].name, (*type)->name) == 0;
    if (!found) fail_msg("add a case for the shape %s", (*type)->name);
  }
}

// Numbers here are below 10 and matrices have condition below 10: ten operations, ten bits spare.
#define ROUNDING (10 * 10 * 16 * DBL_EPSILON)

// Up to the rounding of p.
static bool inside(const struct box *box, struct vec p) {
  const double q[3] = {p.x, p.y, p.z};
  for (int k = 0; k < 3; k++)
    if (q[k] < (double)box->lo[k] - ROUNDING || q[k] > (double)box->hi[k] + ROUNDING) return false;
  return true;
}

static void samples_lie_on_the_surface_and_in_the_bounds(void **state) {
  (void)state;
  struct draw draw = draw_named("samples_lie_on_the_surface_and_in_the_bounds");
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    struct box box = shape->type->bounds(&scene, shape, 0);
    for (int k = 0; k < 2000; k++) {
      struct vec p, n;
      double u0, u1;
      draw_pair(&draw, &u0, &u1);
      shape->type->sample(&scene, shape, 0, u0, u1, &p, &n);
      struct inverse at = cases[i].inverse(&scene, p);
      assert_true(fabs(at.distance) <= ROUNDING);
      assert_true(at.u0 >= -ROUNDING && at.u0 <= 1 + ROUNDING && at.u1 <= 1 + ROUNDING);
      assert_true(fabs(vec_length(n) - 1) <= 8 * DBL_EPSILON);
      struct vec again = shape->type->normal(&scene, shape, 0, p);
      assert_true(vec_length(vec_sub(n, again)) <= ROUNDING * 100); // p is rounded
      assert_true(inside(&box, p));
    }
  }
}

// Exact boxes: no smaller than the surface, and no larger than by two float steps and the grid's
// curvature: samples on a 400 x 400 grid come within (pi / 400)^2 of every extreme point.
static void whole_shapes_touch_their_bounds(void **state) {
  (void)state;
  static const int whole[] = {0, 1, 2, 4, 5, 7, 9, 10, 11, 12, 13, 14, 15};
  for (size_t w = 0; w < sizeof whole / sizeof *whole; w++) {
    struct scene scene = scene_of_case(whole[w]);
    const struct shape *shape = &scene.shape[0];
    struct box box = shape->type->bounds(&scene, shape, 0);
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int a = 0; a <= 400; a++)
      for (int b = 0; b < 400; b++) {
        struct vec p, n;
        double u0 = a == 400 ? 1 - 0x1p-53 : a / 400.0;
        shape->type->sample(&scene, shape, 0, u0, b / 399.0, &p, &n);
        const double q[3] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; k++) {
          lo[k] = q[k] < lo[k] ? q[k] : lo[k];
          hi[k] = q[k] > hi[k] ? q[k] : hi[k];
        }
      }
    for (int k = 0; k < 3; k++) {
      double size = 1e-6 + hi[k] - lo[k];
      assert_true((double)box.lo[k] <= lo[k] + ROUNDING && (double)box.hi[k] >= hi[k] - ROUNDING);
      assert_true(lo[k] - (double)box.lo[k] <= size * 1e-3 + 4e-6);
      assert_true((double)box.hi[k] - hi[k] <= size * 1e-3 + 4e-6);
    }
  }
}

static void areas_equal_their_closed_forms(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    if (cases[i].area == 0) continue;
    struct scene scene = scene_of_case(i);
    double area = scene.shape[0].type->area(&scene, &scene.shape[0], 0);
    if (!(fabs(area - cases[i].area) <= 64 * DBL_EPSILON * cases[i].area))
      fail_msg("case %d: %.17g is not %.17g", i, area, cases[i].area);
  }
}

// A random line that meets the ball of radius R around c: a direction, and a point of the disc.
static struct ray line_through_ball(struct draw *draw, struct vec c, double radius) {
  struct vec d = draw_direction(draw), s, t;
  double u0, u1;
  draw_pair(draw, &u0, &u1);
  vec_basis(d, &s, &t);
  struct vec o = vec_along(vec_along(c, s, radius * sqrt(u0) * cos(2 * pi * u1)), t,
                           radius * sqrt(u0) * sin(2 * pi * u1));
  return (struct ray){vec_along(o, d, -2 * radius), d, INFINITY, PRIMITIVE_NONE};
}

static struct vec center_of(const struct box *box, double *radius) {
  struct vec lo = vec(box->lo[0], box->lo[1], box->lo[2]);
  struct vec hi = vec(box->hi[0], box->hi[1], box->hi[2]);
  *radius = vec_length(vec_sub(hi, lo)) / 2;
  return vec_scale(vec_add(lo, hi), 0.5);
}

// The hits of a line, each checked to lie on the shape within its limits and its box.
static int count_hits(const struct scene *scene, int i, struct ray ray) {
  const struct shape *shape = &scene->shape[0];
  int hits = 0;
  double t;
  while (shape->type->intersect(scene, shape, 0, &ray, &t)) {
    struct vec p = vec_along(ray.o, ray.d, t);
    struct inverse at = cases[i].inverse(scene, p);
    if (!(t > 0 && fabs(at.distance) <= ROUNDING * 100 && at.u0 >= -1e-12 && at.u0 <= 1 + 1e-12 &&
          at.u1 >= -1e-12 && at.u1 <= 1 + 1e-12))
      fail_msg("case %d: a hit off the shape: %g %g %g", i, at.u0, at.u1, at.distance);
    ray.o = p;
    ray.leaving = 0;
    if (++hits > 2) fail_msg("case %d: a line hits three times", i);
  }
  return hits;
}

// Crofton: lines uniform through a ball of radius R hit a surface of area A, on average,
// A / (2 pi R^2) times. 100,000 lines a case see an area 1.6 % wrong at 5 standard errors when the
// mean is 1/2. What intersect finds and what area says are independent codes.
static void lines_hit_in_proportion_to_the_area(void **state) {
  (void)state;
  enum { N = 100000 };
  struct draw draw = draw_named("lines_hit_in_proportion_to_the_area");
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    struct box box = shape->type->bounds(&scene, shape, 0);
    double radius, sum = 0, sum2 = 0;
    struct vec c = center_of(&box, &radius);
    for (int k = 0; k < N; k++) {
      int hits = count_hits(&scene, i, line_through_ball(&draw, c, radius));
      sum += hits, sum2 += hits * hits;
    }
    if (!cases[i].even && !shape->type->density) continue;
    double mean = sum / N, se = sqrt((sum2 / N - mean * mean) / N);
    double wanted = shape->type->area(&scene, shape, 0) / (2 * pi * radius * radius);
    if (!(fabs(mean - wanted) <= Z_LIMIT * se))
      fail_msg("case %d: %g hits a line, %g wanted, standard error %g", i, mean, wanted, se);
  }
}

// 64 cells of equal area, 64,000 samples: a density 10 % wrong in half of the cells is 640 beyond
// its 63, the limit is 140.
static void samples_are_uniform_over_the_area(void **state) {
  (void)state;
  enum { SIDE = 8, N = 64000 };
  struct draw draw = draw_named("samples_are_uniform_over_the_area");
  for (int i = 0; i < N_CASES; i++) {
    if (!cases[i].even) continue;
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    int count[SIDE * SIDE] = {0};
    for (int k = 0; k < N; k++) {
      struct vec p, n;
      double u0, u1;
      draw_pair(&draw, &u0, &u1);
      shape->type->sample(&scene, shape, 0, u0, u1, &p, &n);
      struct inverse at = cases[i].inverse(&scene, p);
      int a = (int)(at.u0 * SIDE), b = (int)(at.u1 * SIDE);
      count[(a < 0          ? 0
             : a > SIDE - 1 ? SIDE - 1
                            : a) *
                SIDE +
            (b < 0          ? 0
             : b > SIDE - 1 ? SIDE - 1
                            : b)]++;
    }
    double chi2 = 0, each = (double)N / (SIDE * SIDE);
    for (int k = 0; k < SIDE * SIDE; k++) chi2 += (count[k] - each) * (count[k] - each) / each;
    if (!(chi2 <= chi2_limit(SIDE * SIDE - 1))) fail_msg("case %d: chi-squared %g", i, chi2);
  }
}

// The normal is perpendicular to the surface: nearby samples lie across it, to second order.
static void normals_are_perpendicular_to_the_surface(void **state) {
  (void)state;
  struct draw draw = draw_named("normals_are_perpendicular_to_the_surface");
  const double step = 1e-5;
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    for (int k = 0; k < 500; k++) {
      double u0 = draw_between(&draw, 0.1, 0.9), u1 = draw_between(&draw, 0.1, 0.9);
      struct vec p, n, a, b, other;
      shape->type->sample(&scene, shape, 0, u0, u1, &p, &n);
      shape->type->sample(&scene, shape, 0, u0 + step, u1, &a, &other);
      shape->type->sample(&scene, shape, 0, u0, u1 + step, &b, &other);
      // Chord against tangent: the curvature (at most 20 here, of the flat ellipsoid) times half
      // the step's length.
      struct vec da = vec_sub(a, p), db = vec_sub(b, p);
      assert_true(fabs(vec_dot(vec_normalize(da), n)) <= 20 * vec_length(da) + 1e-9);
      assert_true(fabs(vec_dot(vec_normalize(db), n)) <= 20 * vec_length(db) + 1e-9);
    }
  }
}

static void spheres_face_outward_unless_mirrored_xor_reversed(void **state) {
  (void)state;
  struct scene plain = scene_of_case(2);
  struct vec p, n;
  plain.shape[0].type->sample(&plain, &plain.shape[0], 0, 0.3, 0.6, &p, &n);
  assert_true(vec_dot(n, vec_sub(p, vec(1, 2, 3))) > 0);
  struct scene both = scene_of_case(3); // reversed and mirrored: outward again
  both.shape[0].type->sample(&both, &both.shape[0], 0, 0.3, 0.6, &p, &n);
  assert_true(vec_dot(n, p) > 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_registered_shape_is_a_case_here),
      cmocka_unit_test(samples_lie_on_the_surface_and_in_the_bounds),
      cmocka_unit_test(whole_shapes_touch_their_bounds),
      cmocka_unit_test(areas_equal_their_closed_forms),
      cmocka_unit_test(lines_hit_in_proportion_to_the_area),
      cmocka_unit_test(samples_are_uniform_over_the_area),
      cmocka_unit_test(normals_are_perpendicular_to_the_surface),
      cmocka_unit_test(spheres_face_outward_unless_mirrored_xor_reversed),
  };
  return cmocka_run_group_tests_name("shape", tests, NULL, NULL);
}
