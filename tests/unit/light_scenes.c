// The scenes of scenes/: they read, are gray, and the pixels their headers name see the points and
// the irradiance they claim.
#define _GNU_SOURCE // mkstemp
#include "tests/light_fixture.h"

#include <math.h>

static struct arena arena;

static struct scene read_scene(const char *name) {
  struct scene scene = {0};
  struct problem problem = {0};
  if (!scene_read(arena_format(&arena, "scenes/%s.pbrt", name), &arena, &scene, &problem))
    fail_msg("%s", problem.text);
  return scene;
}

// What the centre of a pixel sees, by trying every primitive.
static struct surface seen(const struct scene *scene, int x, int y) {
  struct ray ray = camera_ray(&scene->camera, x + 0.5, y + 0.5, NULL);
  struct hit hit = {INFINITY, PRIMITIVE_NONE};
  for (uint32_t k = 0; k < scene->n_primitives; k++) {
    const struct shape *shape = &scene->shape[scene->shape_of[k]];
    double t;
    if (shape->type->intersect(scene, shape, k, &ray, &t) && t < hit.t) hit = (struct hit){t, k};
  }
  assert_true(hit.t < INFINITY);
  struct surface out;
  scene_surface(scene, &ray, hit, &out);
  return out;
}

// Along d from a surface: the distance to what is hit, INFINITY if nothing.
static double distance_to_next(const struct scene *scene, const struct surface *surface,
                               struct vec d) {
  struct ray ray = {surface->p, d, INFINITY, surface->primitive};
  for (uint32_t k = 0; k < scene->n_primitives; k++) {
    const struct shape *shape = &scene->shape[scene->shape_of[k]];
    double t;
    if (shape->type->intersect(scene, shape, k, &ray, &t)) ray.t_max = t;
  }
  return ray.t_max;
}

struct view {
  const char *scene;
  int x, y;
  double rho;        // distance from the axis of the light
  double irradiance; // on the side of the eye
  double laplacian;
};

static const double sqrt_half = 0x1.6a09e667f3bcdp-1;

static double irradiance_at(const struct scene *scene, struct vec p, struct vec n) {
  struct light_closed_form form;
  assert_true(scene->light[0].type->closed_form(scene, &scene->light[0], p, n, &form));
  return form.irradiance[0];
}

// Richardson's combination of two second differences: error of order h^4.
static double laplacian(const struct scene *scene, struct vec p, struct vec n) {
  struct vec s, t;
  vec_basis(n, &s, &t);
  double value[2], centre = irradiance_at(scene, p, n);
  for (int j = 0; j < 2; j++) {
    double h = j ? 4e-3 : 2e-3, sum = -4 * centre;
    for (int sign = -1; sign <= 1; sign += 2)
      sum += irradiance_at(scene, vec_along(p, s, sign * h), n) +
             irradiance_at(scene, vec_along(p, t, sign * h), n);
    value[j] = sum / (h * h);
  }
  return (4 * value[0] - value[1]) / 3;
}

static void check_view(const struct view *view) {
  struct scene scene = read_scene(view->scene);
  struct surface surface = seen(&scene, view->x, view->y);
  struct vec n = surface.ng, p = surface.p;
  if (vec_dot(n, camera_ray(&scene.camera, 0, 0, NULL).d) > 0) n = vec_scale(n, -1);
  double rho = sqrt(p.x * p.x + p.y * p.y), e = irradiance_at(&scene, p, n);
  double curvature = laplacian(&scene, p, n);
  // Tilted vertices are floats: the plane is off by some 1e-7. Elsewhere it is exact.
  if (!(fabs(rho - view->rho) < 3e-7 && fabs(e - view->irradiance) < 1e-6 &&
        fabs(curvature - view->laplacian) < 1e-5))
    fail_msg("%s (%d, %d): rho %.9g, irradiance %.9g, Laplacian %.9g", view->scene, view->x,
             view->y, rho, e, curvature);
}

static void test_views(void **state) {
  (void)state;
  double k = 2 * pi / (0.8 * sqrt_half), e0 = 1 / (4 * (1 + 0.8 * sin(k) / k));
  double iso = sqrt(2. / 3), disc = 0.8461985691461904; // where 3 rho^2 u = u^2 + 4 h^2 R^2
  double u = disc * disc + 0.75, pitch = sqrt_half / 20;
  const struct view views[] = {
      {"plane-uniform-beam", 32, 32, 0, 1 / pi, 0},
      {"plane-uniform-beam", 52, 32, sqrt_half, 1 / pi, 0},
      {"plane-uniform-beam", 60, 32, 28 * pitch, 1 / pi, 0},
      {"plane-quadratic-beam", 32, 32, 0, 2 / pi, -8 / pi},
      {"plane-quadratic-beam", 32, 52, sqrt_half, 1 / pi, -8 / pi},
      {"plane-gaussian-beam", 32, 32, 0, 2 / pi, -16 / pi},
      {"plane-gaussian-beam", 52, 32, sqrt_half, 2 / pi * exp(-1), 0},
      {"plane-cosine-grating", 32, 32, 0, 1.8 * e0, -0.8 * k * k * e0},
      {"plane-cosine-grating", 36, 32, 4 * pitch, e0, 0},
      {"plane-cosine-grating", 40, 32, 8 * pitch, 0.2 * e0, 0.8 * k * k * e0},
      {"plane-cosine-grating", 44, 32, 12 * pitch, e0, 0},
      {"plane-point-light", 32, 32, 0, 1 / pi, -8 / pi},
      {"plane-point-light", 52, 32, sqrt_half, 1 / pi / 2.25, 0},
      {"plane-point-light-isotropic", 32, 32, 0, 1, -6},
      {"plane-point-light-isotropic", 52, 32, iso, pow(5. / 3, -1.5), 0},
      {"plane-disc-light", 32, 32, 0, 1 / (pi * 1.25), -8 / (pi * 1.25 * 1.25 * 1.25)},
      {"plane-disc-light", 62, 32, disc, 2 / pi * (1 - u / sqrt(u * u + 1)), 0},
      {"plane-tilted", 32, 32, 0, 1.6 / pi, -5.248 / pi},
      {"plane-tilted", 52, 32, 0.8 * sqrt_half, 1.6 / pi * 0.68, -5.248 / pi},
      {"plane-tilted", 32, 52, sqrt_half, 0.8 / pi, -5.248 / pi},
  };
  for (size_t i = 0; i < sizeof views / sizeof *views; i++) check_view(&views[i]);
}

// Every photon of a plane's light carries the whole watt (isotropic: 4 pi).
static void test_gray(void **state) {
  (void)state;
  static const char *const names[] = {"plane-uniform-beam",  "plane-quadratic-beam",
                                      "plane-gaussian-beam", "plane-cosine-grating",
                                      "plane-point-light",   "plane-point-light-isotropic",
                                      "plane-disc-light",    "plane-tilted",
                                      "cornell-box",         "white-furnace"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    struct scene scene = read_scene(names[i]);
    struct features features = scene_features(&scene);
    assert_true(features.gray && scene.n_lights == 1);
    double power = scene.light[0].power[0];
    if (strncmp(names[i], "plane", 5) == 0 && !strstr(names[i], "isotropic"))
      assert_true(fabs(power - 1) < 1e-15);
    if (!strcmp(names[i], "cornell-box")) assert_true(fabs(power - 2.5 * pi) < 1e-6);
    if (!strcmp(names[i], "white-furnace")) assert_true(fabs(power - 2 * pi * pi) < 1e-13);
  }
}

static void test_tilted_plane(void **state) {
  (void)state;
  struct scene scene = read_scene("plane-tilted");
  double area = 0;
  assert_int_equal(scene.n_triangles, 1000);
  for (uint32_t k = 0; k < scene.n_positions; k++) {
    const float *p = scene.position[k];
    assert_true(fabs(0.6 * p[0] + 0.8 * p[2]) < 4e-7); // rounded coordinates below 4
  }
  for (uint32_t k = 0; k < scene.n_primitives; k++)
    area += scene.shape[0].type->area(&scene, &scene.shape[0], k);
  assert_true(fabs(area - 64) < 1e-4); // nowhere twice, nowhere open
}

// A point on the edge of two triangles may hide behind its neighbour by a rounding: no pixel's
// centre is on one.
static void test_no_pixel_on_an_edge(void **state) {
  (void)state;
  static const char *const names[] = {"plane-uniform-beam", "plane-point-light-isotropic",
                                      "plane-disc-light", "plane-tilted"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    struct scene scene = read_scene(names[i]);
    for (int j = 0; j < 65 * 65; j++) {
      struct surface surface = seen(&scene, j % 65, j / 65);
      struct vec n = surface.ng, s, t;
      vec_basis(n, &s, &t);
      for (int k = 0; k < 4; k++) { // the disc is 1 above
        struct vec side = vec_along(vec_scale(s, k % 2 - 0.5), t, k / 2 - 0.5);
        double distance = distance_to_next(&scene, &surface, vec_add(n, side));
        if (!(distance > 0.9)) fail_msg("%s (%d, %d): %g", names[i], j % 65, j / 65, distance);
      }
    }
  }
}

// The furnace's wall emits inwards, wherever one looks.
static void test_furnace(void **state) {
  (void)state;
  struct scene scene = read_scene("white-furnace");
  for (int x = 0; x < 65; x += 8)
    for (int y = 0; y < 65; y += 8) {
      struct surface surface = seen(&scene, x, y);
      struct vec w = vec_scale(camera_ray(&scene.camera, x + 0.5, y + 0.5, NULL).d, -1);
      double rgb[3];
      scene.light[0].type->radiance(&scene, &scene.light[0], &surface, w, rgb);
      assert_true(rgb[0] == 0.5);
    }
}

static void assert_sees(const struct scene *scene, int x, int y, uint32_t shape) {
  struct surface surface = seen(scene, x, y);
  if (surface.shape != shape)
    fail_msg("(%d, %d) sees shape %u at (%g, %g, %g), not %u", x, y, surface.shape, surface.p.x,
             surface.p.y, surface.p.z, shape);
}

static void test_cornell_probes(void **state) {
  (void)state;
  struct scene scene = read_scene("cornell-box");
  enum { FLOOR, CEILING, BACK, LEFT, RIGHT, LIGHT, TALL, LOW };
  assert_int_equal(scene.n_shapes, 8);
  assert_int_equal(scene.shape[LIGHT].light, 0);
  assert_sees(&scene, 32, 58, FLOOR);
  assert_sees(&scene, 32, 20, BACK);
  assert_sees(&scene, 42, 50, LOW);
  assert_sees(&scene, 24, 40, TALL);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"the named pixels see the point, irradiance and Laplacian their header claims", test_views,
       NULL, NULL, NULL},
      {"the scenes are gray, have one light and the power they claim", test_gray, NULL, NULL, NULL},
      {"the thousand triangles are one plane", test_tilted_plane, NULL, NULL, NULL},
      {"no pixel of a plane sees an edge of its triangles", test_no_pixel_on_an_edge, NULL, NULL,
       NULL},
      {"the furnace emits inwards everywhere", test_furnace, NULL, NULL, NULL},
      {"the Cornell box's probes see what its header says", test_cornell_probes, NULL, NULL, NULL},
  };
  return cmocka_run_group_tests_name("light_scenes", tests, NULL, NULL);
}
