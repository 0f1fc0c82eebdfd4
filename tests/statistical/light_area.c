// The area light: photons, next-event estimation and the densities both report.
// Levels and what is found: tests/light_statistics.h.
#define _GNU_SOURCE // mkstemp
#include "tests/light_statistics.h"

static struct arena arena;

#define DISC                                                                                       \
  "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [2.385 2.385 2.385]\nTranslate 0 0 1.3\n" \
  "Rotate 180 1 0 0\nShape \"disk\" \"float radius\" 0.8\nAttributeEnd\n" LIGHT_PLANE

static void test_disc_flux(void **state) {
  (void)state;
  struct scene scene = light_scene(DISC, &arena);
  struct patch receiver = patch(vec(0.4, 0, 0), vec(0, 0, 1), 0.9);
  check_flux(&scene, "light disc flux", &receiver, light_irradiance);
}

#define BALL                                                                                       \
  "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [2.385 2.385 2.385] \"bool twosided\" "   \
  "%s\nTranslate 0 0 1.3\nShape \"sphere\" \"float radius\" 0.5\nAttributeEnd\n" LIGHT_PLANE

// A ball of radiance L at distance d, wholly above the receiver: pi L (R / d)^2 cos.
static double ball_irradiance(const struct scene *scene, struct vec p, struct vec n) {
  (void)scene;
  struct vec v = vec_sub(vec(0, 0, 1.3), p);
  double d2 = vec_dot(v, v);
  return pi * 2.385 * 0.25 / d2 * vec_dot(v, n) / sqrt(d2);
}

static struct scene ball(const char *two_sided) {
  return light_scene(arena_format(&arena, BALL, two_sided), &arena);
}

static void test_ball_flux(void **state) {
  (void)state;
  struct scene scene = ball("false");
  struct patch receiver = patch(vec(0.4, 0, 0), vec(0, 0, 1), 1.5);
  check_flux(&scene, "light ball flux", &receiver, ball_irradiance);
}

// ---- emission from surfaces ----

// A rectangle [0, 3] x [0, 2] in four triangles of unequal area that meet in (0.6, 1.4).
#define FAN(parameters)                                                                            \
  "AreaLightSource \"diffuse\" " parameters "\nShape \"trianglemesh\" \"integer indices\" "        \
  "[0 1 4 1 2 4 2 3 4 3 0 4] \"point3 P\" [0 0 0 3 0 0 3 2 0 0 2 0 0.6 1.4 0]\n"

// The same rectangle in two trapezoids.
#define TRAPEZOIDS                                                                                 \
  "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\nShape \"bilinearmesh\" \"integer indices\" "     \
  "[0 1 3 4 1 2 4 5] \"point3 P\" [0 0 0 0.5 0 0 3 0 0 0 2 0 2.2 2 0 3 2 0]\n"

#define EGG                                                                                        \
  "AttributeBegin\nAreaLightSource \"diffuse\" \"float power\" 2\nTranslate 0 0 1.3\nRotate 70 1 " \
  "0 "                                                                                             \
  "0\nScale 0.5 0.3 0.8\nShape \"sphere\"\nAttributeEnd\n" LIGHT_PLANE

#define TUBE                                                                                       \
  "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\nTranslate 0 0 1.3\nRotate 70 1 " \
  "0 0\nScale 0.5 0.5 2\nShape \"cylinder\" \"float phimax\" 300\nAttributeEnd\n" LIGHT_PLANE

// Each side is a half of the histogram: none of its directions may depend on the side.
static void check_fan(const char *text, const char *name, bool both) {
  struct scene scene = light_scene(text, &arena);
  struct stream stream = stream_begin(name);
  struct histogram position = {0}, direction = {0}, joint = {0};
  for (uint64_t j = 0; j < N; j++) {
    struct ray ray = emit(&scene, &stream, j).ray;
    assert_true(ray.leaving < 4 && fabs(ray.o.z) < 1e-15);
    assert_true(both || ray.d.z >= 0);
    double square = ray.d.z * ray.d.z, x = fmin(fmax(ray.o.x / 3, 0), 1); // rounding
    histogram_add(&position, x, fmin(fmax(ray.o.y / 2, 0), 1));
    histogram_add(&joint, x, square);
    histogram_add(&direction, both ? (square + (ray.d.z > 0)) / 2 : square, turn(ray.d.x, ray.d.y));
  }
  assert_uniform(&position);
  assert_uniform(&direction);
  assert_uniform(&joint);
}

static void test_rectangle(void **state) {
  (void)state;
  check_fan(FAN("\"rgb L\" [2 2 2]"), "light fan", false);
  check_fan(FAN("\"rgb L\" [2 2 2] \"bool twosided\" true"), "light fan both sides", true);
}

// pbrt's shape is the triangle: with `power` each emits the same, whatever its area.
static void test_power_by_triangle(void **state) {
  (void)state;
  struct scene scene = light_scene(FAN("\"float power\" 2.5"), &arena);
  struct stream stream = stream_begin("light fan power");
  assert_true(fabs(scene.light[0].power[1] - 10) < 1e-14);
  double count[4] = {0};
  for (uint64_t j = 0; j < N; j++) count[emit(&scene, &stream, j).ray.leaving] += 1;
  for (int k = 0; k < 4; k++) assert_z(count[k] / N, 0.25, sqrt(0.25 * 0.75 / N));
}

static void test_sphere(void **state) {
  (void)state;
  struct scene scene = ball("false");
  struct stream stream = stream_begin("light ball");
  struct histogram position = {0}, direction = {0};
  for (uint64_t j = 0; j < N; j++) {
    struct ray ray = emit(&scene, &stream, j).ray;
    struct vec n = vec_scale(vec_sub(ray.o, vec(0, 0, 1.3)), 2);
    assert_true(fabs(vec_length(n) - 1) < 1e-12);
    histogram_add(&position, fmin(fmax((1 + n.z) / 2, 0), 1), turn(n.x, n.y));
    add_cosine_law(&direction, vec_normalize(n), ray.d);
  }
  assert_uniform(&position);
  assert_uniform(&direction);
}

// ---- next-event estimation of area lights ----

struct mean {
  double sum, squares;
};

static void mean_add(struct mean *mean, double x) {
  mean->sum += x;
  mean->squares += x * x;
}

static void assert_mean(const struct mean *mean, double expected) {
  double average = mean->sum / N, variance = mean->squares / N - average * average;
  assert_z(average, expected, sqrt(variance / N));
}

// The irradiance at p, and the solid angle the light's lit side fills: the mean of 1 / pdf.
static void check_nee(const struct scene *scene, const char *name, struct vec p, struct vec n,
                      double irradiance, double solid_angle) {
  const struct light *light = &scene->light[0];
  struct stream stream = stream_begin(name);
  struct mean e = {0}, omega = {0};
  for (uint64_t j = 0; j < N; j++) {
    double u[LIGHT_U];
    struct light_sample nee;
    stream_read(&stream, j, u);
    bool lit = light->type->sample(scene, light, p, u, &nee);
    mean_add(&e, lit ? nee.radiance_over_pdf[0] * fmax(vec_dot(nee.wi, n), 0) : 0);
    mean_add(&omega, lit ? 1 / nee.pdf_solid_angle : 0);
  }
  assert_mean(&e, irradiance);
  assert_mean(&omega, solid_angle);
}

static void test_nee(void **state) {
  (void)state;
  struct vec p = vec(0.7, -0.2, 0), up = vec(0, 0, 1);
  double d2 = 0.49 + 0.04 + 1.69, cap = 2 * pi * (1 - sqrt(1 - 0.25 / d2));
  struct scene one = ball("false"), two = ball("true"), disc = light_scene(DISC, &arena);
  double e = ball_irradiance(&one, p, up);
  check_nee(&one, "light ball nee", p, up, e, cap);
  // Its inside faces the receiver too, but hides behind the outside: counted twice.
  check_nee(&two, "light ball nee both sides", p, up, 2 * e, 2 * cap);
  // On the axis of the disc: 2 pi (1 - h / sqrt(h^2 + R^2)).
  double axis = 2 * pi * (1 - 1.3 / sqrt(1.69 + 0.64));
  check_nee(&disc, "light disc nee", vec(0, 0, 0), up, light_irradiance(&disc, vec(0, 0, 0), up),
            axis);
}

// The unequal triangles of the fan: the mean over the samples is the theorem of the polygon
// (Lambert): E = (L / 2) sum of edge angles times the edges' cosines.
static double lambert(const struct vec *corner, int n, struct vec p, struct vec normal) {
  double sum = 0;
  for (int k = 0; k < n; k++) {
    struct vec a = vec_normalize(vec_sub(corner[k], p));
    struct vec b = vec_normalize(vec_sub(corner[(k + 1) % n], p)), c = vec_cross(a, b);
    sum += acos(vec_dot(a, b)) * vec_dot(vec_normalize(c), normal);
  }
  return fabs(sum) / 2;
}

static void test_nee_triangles(void **state) {
  (void)state;
  static const struct vec corner[] = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}},
                          apex = {0.6, 1.4, 0};
  static const double area[] = {2.1, 2.4, 0.9, 0.6};
  struct vec p = vec(0.5, 0.4, 1.1), down = vec(0, 0, -1);
  double by_radiance = 2 * lambert(corner, 4, p, down), by_power = 0, solid_angle = 0;
  for (int k = 0; k < 4; k++) {
    struct vec triangle[] = {corner[k], corner[(k + 1) % 4], apex};
    by_power += 2.5 / (pi * area[k]) * lambert(triangle, 3, p, down);
    struct vec a = vec_sub(triangle[0], p), b = vec_sub(triangle[1], p), c = vec_sub(apex, p);
    double la = vec_length(a), lb = vec_length(b), lc = vec_length(c); // Van Oosterom, Strackee
    solid_angle +=
        2 * atan2(fabs(vec_dot(a, vec_cross(b, c))),
                  la * lb * lc + vec_dot(a, b) * lc + vec_dot(a, c) * lb + vec_dot(b, c) * la);
  }
  struct scene radiance = light_scene(FAN("\"rgb L\" [2 2 2]"), &arena);
  struct scene power = light_scene(FAN("\"float power\" 2.5"), &arena);
  struct scene patches = light_scene(TRAPEZOIDS, &arena);
  check_nee(&radiance, "light fan nee", p, down, by_radiance, solid_angle);
  check_nee(&patches, "light trapezoids nee", p, down, by_radiance, solid_angle);
  check_nee(&power, "light fan power nee", p, down, by_power, solid_angle);
}

// What multiple importance sampling relies on: the density `sample` reports is the one `pdf` gives.
static void test_pdf_consistent(void **state) {
  (void)state;
  const char *const texts[] = {FAN("\"rgb L\" [2 2 2]"),
                               FAN("\"float power\" 2.5"),
                               FAN("\"bool twosided\" true"),
                               TRAPEZOIDS,
                               arena_format(&arena, BALL, "false"),
                               DISC,
                               TUBE,
                               EGG};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    struct scene scene = light_scene(texts[i], &arena);
    const struct light *light = &scene.light[0];
    struct stream stream = stream_begin("light pdf");
    int lit = 0;
    for (uint64_t j = 0; j < BATCH; j++) {
      double u[LIGHT_U], rgb[3];
      struct light_sample nee;
      struct vec p = vec(0.3, 0.2, i < 4 ? 2 : -2);
      stream_read(&stream, j, u);
      if (!light->type->sample(&scene, light, p, u, &nee)) continue;
      struct ray ray = {p, nee.wi, INFINITY, PRIMITIVE_NONE};
      struct surface surface;
      scene_surface(&scene, &ray, (struct hit){nee.distance, nee.primitive}, &surface);
      double pdf = light->type->pdf(&scene, light, p, &surface, nee.wi);
      assert_true(fabs(pdf / nee.pdf_solid_angle - 1) < 1e-9); // grazing cosines on the sphere
      light->type->radiance(&scene, light, &surface, vec_scale(nee.wi, -1), rgb);
      assert_true(fabs(rgb[0] / pdf / nee.radiance_over_pdf[0] - 1) < 1e-9);
      lit++;
    }
    assert_true(lit >= BATCH / 8);
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"a disc light's flux through a patch is the integral of the closed form", test_disc_flux,
       NULL, NULL, NULL},
      {"a ball's flux through a patch is pi L (R / d)^2 cos", test_ball_flux, NULL, NULL, NULL},
      {"a rectangle of unequal triangles emits uniformly, by the cosine law, both independent",
       test_rectangle, NULL, NULL, NULL},
      {"with `power` every triangle emits the same", test_power_by_triangle, NULL, NULL, NULL},
      {"a sphere emits uniformly and by the cosine law", test_sphere, NULL, NULL, NULL},
      {"next-event estimation gives irradiance and solid angle of ball and disc", test_nee, NULL,
       NULL, NULL},
      {"next-event estimation gives Lambert's theorem for triangles and patches",
       test_nee_triangles, NULL, NULL, NULL},
      {"the pdf that is sampled is the pdf that is asked", test_pdf_consistent, NULL, NULL, NULL},
  };
  return cmocka_run_group_tests_name("light_area", tests, NULL, NULL);
}
