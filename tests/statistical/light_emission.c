// Photons of the lights without a surface: where they start, where they go, what they carry.
// Levels and what is found: tests/light_statistics.h.
#define _GNU_SOURCE // mkstemp
#include "tests/light_statistics.h"

static struct arena arena;

static void test_isotropic(void **state) {
  (void)state;
  struct scene scene =
      light_scene("LightSource \"point\" \"point3 from\" [1 2 3]" LIGHT_PLANE, &arena);
  struct stream stream = stream_begin("light isotropic emission");
  struct histogram histogram = {0};
  for (uint64_t j = 0; j < N; j++) {
    struct vec d = emit(&scene, &stream, j).ray.d;
    histogram_add(&histogram, (1 + d.z) / 2, turn(d.x, d.y)); // Archimedes
  }
  assert_uniform(&histogram);
}

static void test_lambertian(void **state) {
  (void)state;
  struct scene scene = light_scene("LightSource \"point\" \"point3 from\" [1 2 3] \"point3 to\" "
                                   "[1.36 1.52 2.2] \"string emission\" \"lambertian\"" LIGHT_PLANE,
                                   &arena);
  struct stream stream = stream_begin("light lambertian emission");
  struct histogram histogram = {0};
  for (uint64_t j = 0; j < N; j++)
    add_cosine_law(&histogram, vec(0.36, -0.48, -0.8), emit(&scene, &stream, j).ray.d);
  assert_uniform(&histogram);
}

static const struct vec beam_from = {1, 2, 3}, beam_axis = {0.36, -0.48, -0.8};

#define BEAM(rest)                                                                                 \
  "LightSource \"beam\" \"point3 from\" [1 2 3] \"point3 to\" [1.36 1.52 2.2] "                    \
  "\"float power\" 2.385 " rest LIGHT_PLANE

typedef void distribution(double x, double y, double *a, double *b);

static void uniform_cdf(double x, double y, double *a, double *b) {
  *a = (x * x + y * y) / (1.7 * 1.7);
  *b = turn(x, y);
}

static void quadratic_cdf(double x, double y, double *a, double *b) {
  double outside = 1 - (x * x + y * y) / (1.7 * 1.7);
  *a = 1 - outside * outside;
  *b = turn(x, y);
}

static void gaussian_cdf(double x, double y, double *a, double *b) {
  *a = 1 - exp(-(x * x + y * y) / (2 * 0.6 * 0.6));
  *b = turn(x, y);
}

// Half side 1.7, wavelength 0.9 (3.78 periods), contrast 1: zeros inside.
static void cosine_cdf(double x, double y, double *a, double *b) {
  double kappa = 2 * pi / 0.9, edge = 1.7 + sin(1.7 * kappa) / kappa;
  *a = (x + sin(kappa * x) / kappa + edge) / (2 * edge);
  *b = (y + 1.7) / 3.4;
}

// Half width 0.4.
static void slab_cdf(double x, double y, double *a, double *b) {
  double v = y / 1.7;
  *a = (2 + 3 * v - v * v * v) / 4;
  *b = (x + 0.4) / 0.8;
}

static void check_beam(const char *text, const char *name, distribution *cdf) {
  struct scene scene = light_scene(text, &arena);
  struct stream stream = stream_begin(name);
  struct histogram histogram = {0};
  struct vec x, y;
  frame(beam_axis, vec(0.3, 0.9, 0.2), &x, &y);
  for (uint64_t j = 0; j < N; j++) {
    struct ray ray = emit(&scene, &stream, j).ray;
    assert_true(vec_length(vec_sub(ray.d, beam_axis)) < 1e-14);
    struct vec v = vec_sub(ray.o, beam_from);
    assert_true(fabs(vec_dot(v, beam_axis)) < 1e-14 * vec_length(beam_from));
    double a, b;
    cdf(vec_dot(v, x), vec_dot(v, y), &a, &b);
    histogram_add(&histogram, a, b);
  }
  assert_uniform(&histogram);
}

static void test_beams(void **state) {
  (void)state;
  check_beam(BEAM("\"float radius\" 1.7"), "light uniform beam", uniform_cdf);
  check_beam(BEAM("\"string profile\" \"quadratic\" \"float radius\" 1.7"), "light quadratic beam",
             quadratic_cdf);
  check_beam(BEAM("\"string profile\" \"gaussian\" \"float sigma\" 0.6"), "light gaussian beam",
             gaussian_cdf);
  check_beam(BEAM("\"string profile\" \"cosine\" \"float radius\" 1.7 \"float wavelength\" 0.9 "
                  "\"vector3 across\" [0.3 0.9 0.2]"),
             "light cosine beam", cosine_cdf);
  check_beam(BEAM("\"string profile\" \"slab\" \"float radius\" 1.7 \"float width\" 0.8 "
                  "\"vector3 across\" [0.3 0.9 0.2]"),
             "light slab beam", slab_cdf);
}

// The plane's bounding sphere: centre 0, R = 4 sqrt 2.
static void test_distant(void **state) {
  (void)state;
  struct scene scene = light_scene(
      "LightSource \"distant\" \"point3 to\" [0.36 -0.48 -0.8] \"rgb L\" [3 3 3]" LIGHT_PLANE,
      &arena);
  struct stream stream = stream_begin("light distant emission");
  struct histogram histogram = {0};
  struct vec x, y;
  frame(beam_axis, vec(1, 0, 0), &x, &y);
  for (uint64_t j = 0; j < N; j++) {
    struct emission photon = emit(&scene, &stream, j);
    assert_true(vec_length(vec_sub(photon.ray.d, beam_axis)) < 1e-14);
    struct vec o = photon.ray.o;
    assert_true(fabs(vec_dot(o, beam_axis) + sqrt(32)) < 1e-5); // bounds are rounded outward
    double a = vec_dot(o, x), b = vec_dot(o, y), square = (a * a + b * b) / 32;
    histogram_add(&histogram, square < 1 ? square : 1, turn(a, b));
  }
  assert_uniform(&histogram);
  assert_true(fabs(scene.light[0].power[0] / (3 * pi * 32) - 1) < 1e-5);
}

static void test_flux(void **state) {
  (void)state;
  static const char *const lights[] = {
      BEAM("\"float radius\" 1.7"),
      BEAM("\"string profile\" \"quadratic\" \"float radius\" 1.7"),
      BEAM("\"string profile\" \"gaussian\" \"float sigma\" 0.6"),
      BEAM("\"string profile\" \"cosine\" \"float radius\" 1.7 \"float wavelength\" 0.9"),
      BEAM("\"string profile\" \"slab\" \"float radius\" 1.7"),
      "LightSource \"point\" \"point3 from\" [1 2 3] \"rgb I\" [2 2 2]" LIGHT_PLANE,
      "LightSource \"point\" \"point3 from\" [1 2 3] \"point3 to\" [1.36 1.52 2.2] \"rgb I\" "
      "[2 2 2] \"string emission\" \"lambertian\"" LIGHT_PLANE,
      "LightSource \"distant\" \"point3 to\" [0.36 -0.48 -0.8] \"rgb L\" [3 3 3]" LIGHT_PLANE,
  };
  for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
    struct scene scene = light_scene(lights[i], &arena);
    bool distant = !strcmp(scene.light[0].type->name, "distant");
    struct vec centre = vec_along(distant ? vec(0, 0, 0) : beam_from, beam_axis, 1);
    struct patch receiver = patch(centre, vec(0, 0, 1), distant ? 3 : 1);
    check_flux(&scene, arena_format(&arena, "light flux %zu", i), &receiver, light_irradiance);
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"an isotropic point light is uniform on the sphere", test_isotropic, NULL, NULL, NULL},
      {"a Lambertian point light follows the cosine law about its axis", test_lambertian, NULL,
       NULL, NULL},
      {"beams have their profile in the plane of emission", test_beams, NULL, NULL, NULL},
      {"a distant light fills the disc of the bounding sphere", test_distant, NULL, NULL, NULL},
      {"the flux through a patch is the integral of the closed form", test_flux, NULL, NULL, NULL},
  };
  return cmocka_run_group_tests_name("light_emission", tests, NULL, NULL);
}
