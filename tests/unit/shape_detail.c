// Every registered shape against its parametrisation P(u, v), written down here from pbrt-v4's
// documentation with libm: texture coordinates, tangents and normals, what rays meet, where samples
// fall.
#include "scene_text.h"

#include <float.h>

// ---- P(u, v) ----
static struct vec around(const struct quadric *q, double radius, double u, double z) {
  double phi = u * q->phi_max;
  return transform_point(&q->world_from_object, vec(radius * cos(phi), radius * sin(phi), z));
}

static struct vec sphere_at(const struct scene *scene, double u, double v) {
  const struct quadric *q = &scene->quadric[0];
  double first = acos(q->z_min / q->radius), last = acos(q->z_max / q->radius);
  double theta = first + v * (last - first);
  return around(q, q->radius * sin(theta), u, q->radius * cos(theta));
}

static struct vec disk_at(const struct scene *scene, double u, double v) {
  const struct quadric *q = &scene->quadric[0];
  return around(q, q->radius + v * (q->inner_radius - q->radius), u, q->height);
}

static struct vec cylinder_at(const struct scene *scene, double u, double v) {
  const struct quadric *q = &scene->quadric[0];
  return around(q, q->radius, u, q->z_min + v * (q->z_max - q->z_min));
}

static struct vec vertex(const struct scene *scene, uint32_t row) {
  const float *p = scene->position[row];
  return vec(p[0], p[1], p[2]);
}

// uv (0, 0), (1, 0), (1, 1) where the vertices have none.
static struct vec triangle_at(const struct scene *scene, double u, double v) {
  const uint32_t *row = scene->triangle[0];
  struct vec p = vec_scale(vertex(scene, row[0]), 1 - u);
  return vec_along(vec_along(p, vertex(scene, row[1]), u - v), vertex(scene, row[2]), v);
}

// s = 0.25 + 0.5 b1 + 0.125 b2, t = 0.75 - 0.25 b1 - 0.5 b2, as the scene below says.
static struct vec mapped_triangle_at(const struct scene *scene, double s, double t) {
  double determinant = 0.5 * -0.5 - 0.125 * -0.25;
  double b1 = ((s - 0.25) * -0.5 - 0.125 * (t - 0.75)) / determinant;
  double b2 = (0.5 * (t - 0.75) - (s - 0.25) * -0.25) / determinant;
  return triangle_at(scene, b1 + b2, b2);
}

static struct vec patch_at(const struct scene *scene, double u, double v) {
  const uint32_t *row = scene->patch[0];
  struct vec p = vec_scale(vertex(scene, row[0]), (1 - u) * (1 - v));
  p = vec_along(p, vertex(scene, row[1]), u * (1 - v));
  p = vec_along(p, vertex(scene, row[2]), (1 - u) * v);
  return vec_along(p, vertex(scene, row[3]), u * v);
}

// s = 1 - v / 2, t = 3 u.
static struct vec mapped_patch_at(const struct scene *scene, double s, double t) {
  return patch_at(scene, t / 3, 2 - 2 * s);
}

#define TWISTED "\"point3 P\" [0 0 0  2 0.5 1  -0.5 2 1.5  2 3 -1.5] "

// side: of dP/du x dP/dv, where the normal is. lo and hi: of u and v, where all of it is the shape.
static const struct {
  const char *name, *text;
  struct vec (*at)(const struct scene *, double u, double v);
  double side, lo[2], hi[2];
  bool whole; // u and v from 0 to 1 are the shape
} cases[] = {
    {"sphere",
     "Translate 1 2 3 Shape \"sphere\" \"float radius\" 0.75",
     sphere_at,
     1,
     {0, 0},
     {1, 1},
     true},
    {"sphere",
     "ReverseOrientation Rotate 37 1 2 3 Scale 2 2 -2 Shape \"sphere\" \"float radius\" 0.5 "
     "\"float zmin\" -0.25 \"float zmax\" 0.375 \"float phimax\" 180",
     sphere_at,
     -1,
     {0, 0},
     {1, 1},
     true},
    {"sphere",
     "Translate -2 0 1 Rotate 20 1 1 0 Scale 1 3 0.5 Shape \"sphere\"",
     sphere_at,
     1,
     {0, 0},
     {1, 1},
     true},
    {"disk",
     "Scale 3 2 1 Shape \"disk\" \"float radius\" 1 \"float innerradius\" 0.5 \"float height\" 2 "
     "\"float phimax\" 90",
     disk_at,
     1,
     {0, 0},
     {1, 1},
     true},
    {"cylinder",
     "Translate 1 2 3 Scale 1 1 2 Shape \"cylinder\" \"float radius\" 0.75",
     cylinder_at,
     1,
     {0, 0},
     {1, 1},
     true},
    {"cylinder",
     "ReverseOrientation Rotate 37 1 2 3 Scale 2 3 -2 Shape \"cylinder\" \"float radius\" 0.5 "
     "\"float zmin\" 0.375 \"float zmax\" -0.25 \"float phimax\" 180",
     cylinder_at,
     -1,
     {0, 0},
     {1, 1},
     true},
    {"trianglemesh",
     "Scale 1 2 -1 Rotate 37 1 2 3 Shape \"trianglemesh\" \"point3 P\" "
     "[0.5 -1 2  3 0.25 1  -2 1.5 0.125]",
     triangle_at,
     -1,
     {0.55, 0.05},
     {0.95, 0.5},
     false},
    {"trianglemesh",
     "ReverseOrientation Shape \"trianglemesh\" \"point3 P\" [0.5 -1 2  3 0.25 1  -2 1.5 0.125] "
     "\"point2 uv\" [0.25 0.75  0.75 0.5  0.375 0.25]",
     mapped_triangle_at,
     1,
     {0.4, 0.45},
     {0.5, 0.55},
     false},
    {"plymesh",
     "Shape \"plymesh\" \"string filename\" \"tests/data/meshes/triangle.ply\"",
     triangle_at,
     1,
     {0.55, 0.05},
     {0.95, 0.5},
     false},
    {"loopsubdiv",
     "Shape \"loopsubdiv\" \"integer levels\" 0 \"point3 P\" [0 0 0  5 0 0  0 5 1]",
     triangle_at,
     -1,
     {0.55, 0.05},
     {0.95, 0.5},
     false}, // its normals turn it
    {"bilinearmesh",
     "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  3 0 0  1 4 0  2 4 0]",
     patch_at,
     1,
     {0, 0},
     {1, 1},
     true},
    {"bilinearmesh",
     "Translate 1 0 2 Scale 1 -1 1 Shape \"bilinearmesh\" " TWISTED,
     patch_at,
     -1,
     {0, 0},
     {1, 1},
     true},
    {"bilinearmesh",
     "Shape \"bilinearmesh\" " TWISTED "\"point2 uv\" [1 0  1 3  0.5 0  0.5 3]",
     mapped_patch_at,
     1,
     {0.5, 0},
     {1, 3},
     false},
    {"bilinearmesh",
     "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  3 0 0  0 4 1  0 4 1]",
     patch_at,
     1,
     {0, 0},
     {1, 1},
     true}, // a triangle
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

// Numbers are below 10, conditions below 10: ten operations, ten bits spare.
#define ROUNDING (10 * 10 * 16 * DBL_EPSILON)

// Central differences: curvatures below 100 times STEP^2, and rounding by STEP.
#define STEP 1e-5
#define DIFFERENCE (100 * STEP * STEP + ROUNDING / STEP)

static void derivatives(const struct scene *scene, int i, double u, double v, struct vec *du,
                        struct vec *dv) {
  struct vec a = cases[i].at(scene, u - STEP, v), b = cases[i].at(scene, u + STEP, v);
  struct vec c = cases[i].at(scene, u, v - STEP), d = cases[i].at(scene, u, v + STEP);
  *du = vec_scale(vec_sub(b, a), 0.5 / STEP), *dv = vec_scale(vec_sub(d, c), 0.5 / STEP);
}

static struct surface surface_at(const struct scene *scene, struct vec p) {
  struct surface surface = {.p = p};
  const struct shape *shape = &scene->shape[0];
  surface.ng = surface.ns = shape->type->normal(scene, shape, 0, p);
  shape->type->detail(scene, shape, &surface);
  return surface;
}

// Within the middle 90 % of the ranges of u and v.
static void draw_uv(struct draw *draw, int i, double *u, double *v) {
  draw_pair(draw, u, v);
  *u = cases[i].lo[0] + (cases[i].hi[0] - cases[i].lo[0]) * (0.05 + 0.9 * *u);
  *v = cases[i].lo[1] + (cases[i].hi[1] - cases[i].lo[1]) * (0.05 + 0.9 * *v);
}

static void uv_tangents_and_normals_are_those_of_the_parametrisation(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of_case(i);
    for (int k = 0; k < 500; k++) {
      double u, v;
      struct vec du, dv;
      draw_uv(&draw, i, &u, &v);
      struct surface s = surface_at(&scene, cases[i].at(&scene, u, v));
      derivatives(&scene, i, u, v, &du, &dv);
      if (!(fabs(s.uv[0] - u) <= 100 * ROUNDING && fabs(s.uv[1] - v) <= 100 * ROUNDING))
        fail_msg("case %d: uv (%.17g, %.17g), not (%.17g, %.17g)", i, s.uv[0], s.uv[1], u, v);
      if (!(vec_length(vec_sub(s.dpdu, du)) <= DIFFERENCE))
        fail_msg("case %d: dp/du (%g, %g, %g), not (%g, %g, %g)", i, s.dpdu.x, s.dpdu.y, s.dpdu.z,
                 du.x, du.y, du.z);
      struct vec n = vec_normalize(vec_scale(vec_cross(du, dv), cases[i].side));
      if (!(vec_length(vec_sub(s.ng, n)) <= 100 * DIFFERENCE))
        fail_msg("case %d: normal (%g, %g, %g), not (%g, %g, %g)", i, s.ng.x, s.ng.y, s.ng.z, n.x,
                 n.y, n.z);
      assert_true(fabs(vec_length(s.ns) - 1) <= 8 * DBL_EPSILON && vec_dot(s.ns, s.ng) > 0);
    }
  }
}

static void bounds_contain_the_surface(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of_case(i);
    struct box box = scene.shape[0].type->bounds(&scene, &scene.shape[0], 0);
    for (int k = 0; k <= 100 * 100; k++) {
      double u = cases[i].lo[0] + (cases[i].hi[0] - cases[i].lo[0]) * (k % 101) / 100;
      double v = cases[i].lo[1] + (cases[i].hi[1] - cases[i].lo[1]) * (k / 101) / 100;
      struct vec p = cases[i].at(&scene, u, v);
      const double q[3] = {p.x, p.y, p.z};
      for (int j = 0; j < 3; j++)
        assert_true(q[j] >= (double)box.lo[j] - ROUNDING && q[j] <= (double)box.hi[j] + ROUNDING);
    }
  }
}

// ---- rays ----
// o + t d = P(u, v) by Newton's method; false: no convergence, or outside. *doubtful: so close to
// the rim or to grazing that rounding decides.
static bool find_root(const struct scene *scene, int i, const struct ray *ray, double u, double v,
                      double *t, bool *doubtful) {
  struct vec du, dv, rest, p = cases[i].at(scene, u, v);
  *t = vec_dot(vec_sub(p, ray->o), ray->d) / vec_dot(ray->d, ray->d);
  for (int step = 0; step < 12; step++) {
    derivatives(scene, i, u, v, &du, &dv);
    struct vec n = vec_cross(du, dv);
    double determinant = vec_dot(n, ray->d);
    if (!(fabs(determinant) > 1e-12)) return false;
    rest = vec_sub(vec_along(ray->o, ray->d, *t), cases[i].at(scene, u, v));
    *t -= vec_dot(rest, n) / determinant;
    rest = vec_sub(vec_along(ray->o, ray->d, *t), cases[i].at(scene, u, v));
    u += vec_dot(vec_cross(rest, dv), n) / vec_dot(n, n);
    v += vec_dot(vec_cross(du, rest), n) / vec_dot(n, n);
    if (!(fabs(u) < 3 && fabs(v) < 3)) return false;
  }
  rest = vec_sub(vec_along(ray->o, ray->d, *t), cases[i].at(scene, u, v));
  if (!(vec_length(rest) <= 1e-9) || *t <= 0) return false;
  const double margin = 1e-5;
  if (u < -margin || u > 1 + margin || v < -margin || v > 1 + margin) return false;
  double cosine = vec_dot(vec_normalize(vec_cross(du, dv)), vec_normalize(ray->d));
  *doubtful |= u < margin || u > 1 - margin || v < margin || v > 1 - margin || fabs(cosine) < 1e-3;
  return true;
}

// All t at which the ray meets the surface, from a grid of starts; ascending.
static int all_roots(const struct scene *scene, int i, const struct ray *ray, double root[8],
                     bool *doubtful) {
  enum { GRID = 10 };
  int n = 0;
  for (int k = 0; k < GRID * GRID; k++) {
    double t;
    if (!find_root(scene, i, ray, (k % GRID + 0.5) / GRID, (k / GRID + 0.5) / GRID, &t, doubtful))
      continue;
    bool known = false;
    for (int j = 0; j < n; j++) known |= fabs(root[j] - t) <= 1e-7;
    if (known || n == 8) continue;
    int at = n++;
    for (; at > 0 && root[at - 1] > t; at--) root[at] = root[at - 1];
    root[at] = t;
  }
  return n;
}

static struct ray ray_towards(struct draw *draw, const struct box *box) {
  double a = draw_between(draw, 0, 1), b = draw_between(draw, 0, 1), c = draw_between(draw, 0, 1);
  struct vec aim =
      vec(box->lo[0] + a * (box->hi[0] - box->lo[0]), box->lo[1] + b * (box->hi[1] - box->lo[1]),
          box->lo[2] + c * (box->hi[2] - box->lo[2]));
  struct vec d = draw_direction(draw);
  return (struct ray){vec_along(aim, d, -8), vec_scale(d, 1.5), INFINITY, PRIMITIVE_NONE};
}

static void rays_meet_what_the_parametrisation_says(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < N_CASES; i++) {
    if (!cases[i].whole) continue;
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    struct box box = shape->type->bounds(&scene, shape, 0);
    int compared = 0, met = 0;
    for (int k = 0; k < 60; k++) {
      struct ray ray = ray_towards(&draw, &box);
      double root[8], t, way = 0;
      bool doubtful = false;
      int n = all_roots(&scene, i, &ray, root, &doubtful);
      if (doubtful) continue;
      compared++, met += n;
      for (int j = 0; j <= n; j++) { // each hit in its turn, and then none
        bool hit = shape->type->intersect(&scene, shape, 0, &ray, &t);
        if (hit != (j < n) || (hit && !(fabs(way + t - root[j]) <= 1e-7)))
          fail_msg("case %d, ray %d: hit %d of %d is %d at %.17g", i, k, j, n, hit, way + t);
        if (!hit) break;
        way += t;
        ray.o = vec_along(ray.o, ray.d, t), ray.leaving = 0;
      }
    }
    assert_true(compared >= 40 && met >= 10);
  }
}

// What a ray that leaves may meet is farther than its origin is rounded: closer chords than 1e-9
// are 1e-9 of all.
static void a_ray_that_leaves_does_not_meet_its_origin(void **state) {
  (void)state;
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    struct box box = shape->type->bounds(&scene, shape, 0);
    int left = 0;
    for (int k = 0; k < 10000; k++) {
      struct ray ray = ray_towards(&draw, &box);
      double t;
      if (!shape->type->intersect(&scene, shape, 0, &ray, &t)) continue;
      ray = (struct ray){vec_along(ray.o, ray.d, t), draw_direction(&draw), INFINITY, 0};
      left++;
      if (shape->type->intersect(&scene, shape, 0, &ray, &t) && (shape->type->flat || t < 1e-9))
        fail_msg("case %d: met again at t = %g", i, t);
    }
    assert_true(left > 500);
  }
}

// ---- samples ----
// 1 / density of the samples in each of 64 cells of u, v sums to the cell's part of the area, whose
// |dP/du x dP/dv| is summed over midpoints here. 40,000 samples: a part that is 10 % wrong in half
// of the cells is 400 beyond the 64 of the sum of squares.
static void samples_weighed_by_their_density_measure_the_area(void **state) {
  (void)state;
  enum { SIDE = 8, FINE = 24, N = 40000 };
  struct draw draw = draw_named(__func__);
  for (int i = 0; i < N_CASES; i++) {
    if (!cases[i].whole) continue;
    struct scene scene = scene_of_case(i);
    const struct shape *shape = &scene.shape[0];
    double part[SIDE * SIDE] = {0}, sum[SIDE * SIDE] = {0}, sum2[SIDE * SIDE] = {0}, total = 0;
    for (int k = 0; k < SIDE * FINE * SIDE * FINE; k++) {
      int a = k % (SIDE * FINE), b = k / (SIDE * FINE);
      struct vec du, dv;
      derivatives(&scene, i, (a + 0.5) / (SIDE * FINE), (b + 0.5) / (SIDE * FINE), &du, &dv);
      double here = vec_length(vec_cross(du, dv)) / (SIDE * FINE * SIDE * FINE);
      part[b / FINE * SIDE + a / FINE] += here, total += here;
    }
    double area = shape->type->area(&scene, shape, 0);
    // Midpoints: (1 / 192)^2 / 24 of the second derivatives, below 100.
    if (!(fabs(area - total) <= 2e-4 * total)) fail_msg("case %d: area %g, not %g", i, area, total);
    for (int k = 0; k < N; k++) {
      struct vec p, ng;
      double u0, u1;
      draw_pair(&draw, &u0, &u1);
      shape->type->sample(&scene, shape, 0, u0, u1, &p, &ng);
      struct surface s = surface_at(&scene, p);
      assert_true(vec_length(vec_sub(s.ng, ng)) <= 1e-6); // p is rounded
      double w = shape->type->density ? 1 / shape->type->density(&scene, shape, 0, p) : 1;
      int a = (int)(s.uv[0] * SIDE), b = (int)(s.uv[1] * SIDE);
      int cell = (b < SIDE ? b : SIDE - 1) * SIDE + (a < SIDE ? a : SIDE - 1);
      sum[cell] += w, sum2[cell] += w * w;
    }
    double chi2 = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
      double z = sum[k] - N * part[k] / total;
      chi2 += z * z / sum2[k];
    }
    if (!(chi2 <= chi2_limit(SIDE * SIDE))) fail_msg("case %d: chi-squared %g", i, chi2);
  }
}

// ---- normals of vertices ----
static void assert_vec(struct vec a, double x, double y, double z) {
  if (!(vec_length(vec_sub(a, vec_normalize(vec(x, y, z)))) <= 1e-6)) // they are floats
    fail_msg("(%g, %g, %g) is not along (%g, %g, %g)", a.x, a.y, a.z, x, y, z);
}

#define N3 "\"normal N\" [0 0 2  0 1 1  0 0 2] "
#define N4 "\"normal N\" [0 0 2  0 1 1  0 0 2  0 1 1] "

// Halfway between the first two vertices the mean of their normals as they are written, (0, 1/2,
// 3/2): lengths count, as in pbrt-v4. ReverseOrientation turns them, a mirror only mirrors them,
// and stretching z by 2 halves its component; the geometric normal goes with them.
static void normals_of_vertices_are_interpolated_and_choose_the_side(void **state) {
  (void)state;
  static const struct {
    const char *before;
    double x[3], ns[3], ng;
  } cases_n[] = {{"", {0.5, 0, 0}, {0, 0.5, 1.5}, 1},
                 {"ReverseOrientation ", {0.5, 0, 0}, {0, -0.5, -1.5}, -1},
                 {"Scale -1 1 1 ", {-0.5, 0, 0}, {0, 0.5, 1.5}, 1},
                 {"Scale 1 1 -2 ", {0.5, 0, 0}, {0, 0.5, -0.75}, -1},
                 {"ReverseOrientation Scale 1 1 -2 ", {0.5, 0, 0}, {0, -0.5, 0.75}, 1}};
  static const char *const shapes[] = {
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] " N3,
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [1 0 2] " N3,
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] " N4,
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [1 0 3 "
      "2] " N4};
  for (size_t c = 0; c < sizeof cases_n / sizeof *cases_n; c++)
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
      char text[512];
      snprintf(text, sizeof text, "WorldBegin LightSource \"point\" %s%s", cases_n[c].before,
               shapes[s]);
      struct scene scene = scene_of(text);
      const double *x = cases_n[c].x, *n = cases_n[c].ns;
      struct ray ray = {vec(x[0], x[1], 5), vec(0, 0, -1), INFINITY, PRIMITIVE_NONE};
      assert_true(scene.shape[0].detailed);
      struct surface surface;
      scene_surface(&scene, &ray, (struct hit){5, 0}, &surface);
      assert_vec(surface.ns, n[0], n[1], n[2]);
      assert_vec(surface.ng, 0, 0, cases_n[c].ng);
    }
}

// Where they cancel the geometric normal takes over, on the side of the vertices' order.
static void normals_that_cancel_are_none(void **state) {
  (void)state;
  struct scene scene =
      scene_of("WorldBegin LightSource \"point\" Shape \"trianglemesh\" \"point3 P\" "
               "[0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1 0 0 -1 0 0 0]");
  struct ray ray = {vec(0.5, 0, 5), vec(0, 0, -1), INFINITY, PRIMITIVE_NONE};
  struct surface surface;
  scene_surface(&scene, &ray, (struct hit){5, 0}, &surface);
  assert_vec(surface.ns, 0, 0, 1);
  assert_vec(surface.ng, 0, 0, 1);
}

// A texture wants them, so the shape is detailed. Halfway between the first two vertices the mean,
// as the matrix moves it; of no length it is dp/du.
static void tangents_of_vertices_are_interpolated(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "WorldBegin LightSource \"point\" ReverseOrientation Scale 1 2 -1 Shape \"trianglemesh\" "
      "\"point3 P\" [0 0 0 1 0 0 0 1 0] \"float alpha\" 0.5 \"vector3 S\" [0 2 0 1 0 1 -1 0 -1]");
  struct ray ray = {vec(0.5, 0, 5), vec(0, 0, -1), INFINITY, PRIMITIVE_NONE};
  struct surface surface;
  scene_surface(&scene, &ray, (struct hit){5, 0}, &surface);
  assert_vec(vec_normalize(surface.dpdu), 0.5, 2, -0.5);
  ray.o = vec(0.5, 1, 5); // between the last two
  scene_surface(&scene, &ray, (struct hit){5, 0}, &surface);
  assert_vec(vec_normalize(surface.dpdu), 1, 0, 0);
}

// ---- files ----
// A quad is a patch of the file's order around the face, in a shape beside the triangles'; both
// emit.
static void a_ply_file_may_hold_triangles_and_quads(void **state) {
  (void)state;
  struct scene scene = scene_of("WorldBegin Translate 10 0 0 AreaLightSource \"diffuse\" Shape "
                                "\"plymesh\" \"float alpha\" 0.5 \"string filename\" "
                                "\"tests/data/meshes/triangle-quad.ply\"");
  assert_int_equal(scene.n_shapes, 2);
  assert_int_equal(scene.n_primitives, 2);
  assert_int_equal(scene.n_lights, 2);
  assert_string_equal(scene.shape[0].type->name, "plymesh");
  assert_string_equal(scene.shape[1].type->name, "bilinearmesh");
  assert_true(scene.shape[0].alpha && scene.shape[1].alpha);
  static const double corner[4][3] = {{10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {11, 1, 0.5}};
  for (int k = 0; k < 4; k++) {
    struct vec p = vertex(&scene, scene.patch[0][k]);
    assert_true(p.x == corner[k][0] && p.y == corner[k][1] && p.z == corner[k][2]);
  }
  struct ray ray = {vec(11.3, 0.2, 9), vec(0, 0, -1), INFINITY, PRIMITIVE_NONE};
  double t;
  assert_true(scene.shape[0].type->intersect(&scene, &scene.shape[0], 0, &ray, &t));
  struct surface surface;
  scene_surface(&scene, &ray, (struct hit){t, 0}, &surface);
  assert_true(fabs(surface.uv[0] - 1.3) <= 1e-6 && fabs(surface.uv[1] - 0.2) <= 1e-6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_registered_shape_is_a_case_here),
      cmocka_unit_test(uv_tangents_and_normals_are_those_of_the_parametrisation),
      cmocka_unit_test(bounds_contain_the_surface),
      cmocka_unit_test(rays_meet_what_the_parametrisation_says),
      cmocka_unit_test(a_ray_that_leaves_does_not_meet_its_origin),
      cmocka_unit_test(samples_weighed_by_their_density_measure_the_area),
      cmocka_unit_test(normals_of_vertices_are_interpolated_and_choose_the_side),
      cmocka_unit_test(normals_that_cancel_are_none),
      cmocka_unit_test(tangents_of_vertices_are_interpolated),
      cmocka_unit_test(a_ply_file_may_hold_triangles_and_quads),
  };
  return cmocka_run_group_tests_name("shape_detail", tests, NULL, NULL);
}
