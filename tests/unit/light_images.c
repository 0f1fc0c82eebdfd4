// Lights with images: the equal-area octahedral map, where texels are, what power means, what is
// refused.
#define _GNU_SOURCE // mkstemp
#include "scene/octahedral.h"
#include "scene/texels.h"
#include "tests/light_fixture.h"

#include <math.h>

static struct arena arena;

static void near(double got, double want, double tolerance, const char *what) {
  if (!(fabs(got - want) <= tolerance)) fail_msg("%s: %.17g, not %.17g", what, got, want);
}

static void near_vec(struct vec got, double x, double y, double z, const char *what) {
  near(got.x, x, 1e-15, what);
  near(got.y, y, 1e-15, what);
  near(got.z, z, 1e-15, what);
}

// ---- the map ----

static void test_axes(void **state) {
  (void)state;
  near_vec(octahedral_direction(0.5, 0.5), 0, 0, 1, "the centre is the pole");
  near_vec(octahedral_direction(1, 0.5), 1, 0, 0, "+x");
  near_vec(octahedral_direction(0, 0.5), -1, 0, 0, "-x");
  near_vec(octahedral_direction(0.5, 1), 0, 1, 0, "+y");
  near_vec(octahedral_direction(0.5, 0), 0, -1, 0, "-y");
  for (int k = 0; k < 4; k++) near_vec(octahedral_direction(k % 2, k / 2), 0, 0, -1, "corners");
  double h = sqrt(0.5);
  near_vec(octahedral_direction(0.75, 0.75), h, h, 0, "the diamond's edge is the equator");
  // A quarter of the way from the pole to +x: r = 1/4, z = 1 - r^2.
  near_vec(octahedral_direction(0.625, 0.5), 0.25 * sqrt(2 - 0.0625), 0, 1 - 0.0625, "r = 1/4");
}

static void test_round_trip(void **state) {
  (void)state;
  enum { SIDE = 61 };
  for (int i = 0; i < SIDE * SIDE; i++) {
    double u = (i % SIDE + 0.385) / SIDE, v = (i / SIDE + 0.615) / SIDE, a, b;
    struct vec d = octahedral_direction(u, v);
    near(vec_length(d), 1, 4e-16, "length");
    octahedral_square(d, &a, &b);
    // Near a pole r is sqrt(1 - |z|), which d's x and y give to an ulp.
    near(a, u, 2e-15, "u");
    near(b, v, 2e-15, "v");
  }
  static const struct vec special[] = {
      {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {-0.6, 0, -0.8}};
  for (int k = 0; k < 5; k++) {
    double u, v;
    octahedral_square(special[k], &u, &v);
    near_vec(octahedral_direction(u, v), special[k].x, special[k].y, special[k].z, "special");
  }
}

// The area of a small parallelogram on the sphere over that in the square: 4 pi.
static void test_equal_area(void **state) {
  (void)state;
  const double h = 1e-5; // central differences: error h^2
  for (int i = 0; i < 400; i++) {
    double u = (i % 20 + 0.3) / 20, v = (i / 20 + 0.65) / 20;
    struct vec du = vec_sub(octahedral_direction(u + h, v), octahedral_direction(u - h, v));
    struct vec dv = vec_sub(octahedral_direction(u, v + h), octahedral_direction(u, v - h));
    near(vec_length(vec_cross(du, dv)) / (4 * h * h), 4 * pi, 1e-6, "area");
  }
}

// ---- images ----

// n x m texels, gray value(x, y), rows from the top.
static void write_image(const char *name, int width, int height, float value(int x, int y)) {
  FILE *file = fopen(arena_format(&arena, "%s/%s", P_tmpdir, name), "wb");
  assert_non_null(file);
  fprintf(file, "PF\n%d %d\n-1\n", width, height);
  for (int y = height - 1; y >= 0; y--)
    for (int x = 0; x < width; x++) {
      float rgb[3] = {value(x, y), value(x, y), value(x, y)};
      fwrite(rgb, sizeof *rgb, 3, file);
    }
  fclose(file);
}

static float numbered(int x, int y) { return (float)(1 + x + 4 * y); }
static float two(int x, int y) { return (void)x, (void)y, 2; }
static float some_negative(int x, int y) { return x == y ? -3 : 2; }

#define NUMBERED "light-images-numbered.pfm"
#define TWO "light-images-two.pfm"
#define WIDE "light-images-wide.pfm"
#define NEGATIVE "light-images-negative.pfm"
#define ENVIRONMENT(rest) "LightSource \"infinite\" \"string filename\" \"" rest

static double arrives(const char *world, struct vec d) {
  struct scene scene = light_scene(arena_format(&arena, "%s%s", world, LIGHT_PLANE), &arena);
  double rgb[3];
  scene.light[0].type->background(&scene, &scene.light[0], vec_normalize(d), rgb);
  assert_true(rgb[0] == rgb[1] && rgb[1] == rgb[2]);
  return rgb[0];
}

// The first texel is the top left, u = v = 0: beneath (-x, -y).
static void test_texels_are_where_pbrt_has_them(void **state) {
  (void)state;
  const char *light = ENVIRONMENT(NUMBERED "\"");
  near(arrives(light, vec(-1, -1, -9)), 1, 0, "top left");
  near(arrives(light, vec(1, -1, -9)), 4, 0, "top right");
  near(arrives(light, vec(-1, 1, -9)), 13, 0, "bottom left");
  near(arrives(light, vec(1, 1, -9)), 16, 0, "bottom right");
  near(arrives(light, vec(-1, -1, 9)), 6, 0, "left and above the centre");
  near(arrives(light, vec(1, -1, 9)), 7, 0, "right and above the centre");
  const char *turned = "AttributeBegin\nScale 2 2 2\nRotate 90 0 0 1\n" ENVIRONMENT(
      NUMBERED "\" \"float scale\" 10\nAttributeEnd");
  near(arrives(turned, vec(1, -1, -9)), 10, 1e-14, "x turned to y"); // -x, -y turned to y, -x
  const char *mirrored = "AttributeBegin\nScale -1 1 1\n" ENVIRONMENT(NUMBERED "\"\nAttributeEnd");
  near(arrives(mirrored, vec(1, -1, -9)), 1, 0, "mirrored");
  near(arrives(ENVIRONMENT(NEGATIVE "\""), vec(-1, -1, -9)), 0, 0, "negative is black");
}

static double power(const char *world) {
  struct scene scene = light_scene(arena_format(&arena, "%s%s", world, LIGHT_PLANE), &arena);
  return scene.light[0].power[1];
}

// ---- points with images ----

// The intensity in direction d.
static double intensity(const char *world, struct vec d) {
  struct scene scene = light_scene(arena_format(&arena, "%s%s", world, LIGHT_PLANE), &arena);
  struct light_sample nee;
  const struct light *light = &scene.light[0];
  if (!light->type->sample(&scene, light, vec_scale(d, 3), NULL, &nee)) return 0;
  assert_true(nee.radiance_over_pdf[0] == nee.radiance_over_pdf[2] && nee.pdf_solid_angle == 0);
  return nee.radiance_over_pdf[0] * 9 * vec_dot(d, d);
}

// +y is the map's pole, z its y.
static void test_goniometric(void **state) {
  (void)state;
  const char *light = "LightSource \"goniometric\" \"string filename\" \"" NUMBERED "\"";
  near(intensity(light, vec(-1, -9, -1)), 1, 1e-14, "top left");
  near(intensity(light, vec(1, -9, -1)), 4, 1e-14, "top right");
  near(intensity(light, vec(-1, -9, 1)), 13, 1e-14, "bottom left");
  near(intensity(light, vec(1, 9, 1)), 11, 1e-14, "right and below the centre");
  const char *scaled = "LightSource \"goniometric\" \"string filename\" \"" NUMBERED
                       "\" \"float scale\" 3 \"rgb I\" [2 2 2]";
  near(intensity(scaled, vec(1, 9, 1)), 66, 1e-13, "scale");
  near(power(scaled), 4 * pi * 6 * 8.5, 1e-11, "power");
  const char *powered =
      "LightSource \"goniometric\" \"string filename\" \"" NUMBERED "\" \"float power\" 5";
  near(power(powered), 5, 1e-13, "power");
  near(intensity(powered, vec(1, 9, 1)), 11 * 5 / (4 * pi * 8.5), 1e-14, "power");
}

// Along +z, x to the right and y up; the shorter side spans fov.
static void test_projection(void **state) {
  (void)state;
#define PROJECTION "LightSource \"projection\" \"string filename\" \""
  const char *light = PROJECTION NUMBERED "\"";
  near(intensity(light, vec(-0.99, 0.99, 1)), 1, 1e-14, "top left");
  near(intensity(light, vec(0.99, 0.99, 1)), 4, 1e-14, "top right");
  near(intensity(light, vec(-0.99, -0.99, 1)), 13, 1e-14, "bottom left");
  near(intensity(light, vec(0.01, -0.49, 1)), 11, 1e-14, "right and below the centre");
  near(intensity(light, vec(1.01, 0, 1)), 0, 0, "outside");
  near(intensity(light, vec(0, 0, -1)), 0, 0, "behind");
  const char *wide = PROJECTION WIDE "\" \"float fov\" 60 \"float scale\" 3";
  double tangent = sqrt(1. / 3);
  near(intensity(wide, vec(0, 0.99 * tangent, 1)), 6, 1e-14, "wide");
  near(intensity(wide, vec(0, 1.01 * tangent, 1)), 0, 0, "wide");
  near(intensity(wide, vec(0.99 * tangent * 4 / 3, 0, 1)), 6, 1e-14, "wide");
  near(intensity(wide, vec(1.01 * tangent * 4 / 3, 0, 1)), 0, 0, "wide");
  // A whole side of a cube sees a sixth of the sphere.
  near(power(PROJECTION TWO "\""), 2 * 4 * pi / 6, 1e-13, "power");
  // pbrt-v4's sum: cos^3 at the centres of texels, at (1/4, 1/4), (1/4, 3/4) ... of A = 4.
  double sum = 0;
  for (int k = 0; k < 16; k++) {
    double x = (k % 4 - 1.5) / 2, y = (k / 4 - 1.5) / 2;
    sum += 4. / 16 * 2 * pow(1 + x * x + y * y, -1.5);
  }
  near(intensity(PROJECTION TWO "\" \"float power\" 5", vec(0, 0, 1)), 2 * 5 / sum, 1e-13, "power");
}

// ---- area lights with images ----

static double leaves(const struct scene *scene, double u, double v) {
  struct surface surface = {.ng = vec(0, 0, 1), .uv = {u, v}};
  double rgb[3];
  scene->light[0].type->radiance(scene, &scene->light[0], &surface, vec(0, 0.6, 0.8), rgb);
  return rgb[0];
}

// v upwards, bilinear between centres, constant beyond the outermost.
static void test_area(void **state) {
  (void)state;
#define AREA(rest)                                                                                 \
  "AreaLightSource \"diffuse\" \"string filename\" \"" NUMBERED "\" " rest                         \
  "\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 3 0 0 0 2 0 3 2 0]"
  struct scene scene = light_scene(AREA("\"float scale\" 3"), &arena);
  near(leaves(&scene, 0.125, 0.875), 3, 1e-14, "top left");
  near(leaves(&scene, 0.875, 0.125), 48, 1e-14, "bottom right");
  near(leaves(&scene, 0.25, 0.875), 4.5, 1e-14, "between");
  near(leaves(&scene, 0.5, 0.5), 25.5, 1e-14, "the centre");
  near(leaves(&scene, 0, 1), 3, 1e-14, "a corner");
  near(leaves(&scene, 1, 0), 48, 1e-14, "a corner");
  near(scene.light[0].power[1], pi * 6 * 3 * 8.5, 1e-11, "power");
  scene = light_scene(AREA("\"float power\" 5 \"bool twosided\" true"), &arena);
  near(scene.light[0].power[1], 5, 1e-13, "power");
  near(leaves(&scene, 0.125, 0.875), 5 / (2 * pi * 6 * 8.5), 1e-14, "power");
}

// Constant alpha: what leaves is less by it, unless it is 0, which nothing ever hits.
static void test_alpha(void **state) {
  (void)state;
  const struct {
    const char *text;
    double power, connected;
  } at[] = {{"\"float alpha\" 1", 1, 1},
            {"\"float alpha\" 0.25", 0.25, 0.25},
            {"\"float alpha\" 0", 1, 1},
            {"\"float alpha\" -1", 1, 1}};
  for (int k = 0; k < 4; k++) {
    struct scene scene = light_scene(
        arena_format(&arena, "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nShape \"disk\" %s",
                     at[k].text),
        &arena);
    const struct light *light = &scene.light[0];
    struct light_sample nee;
    struct emission photon;
    double u[LIGHT_U] = {0.3, 0.4, 0.5, 0.6};
    assert_true(light->type->sample(&scene, light, vec(0.1, 0.2, 2), u, &nee));
    light->type->emit(&scene, light, u, &photon);
    near(light->power[0], 3 * pi * pi * at[k].power, 1e-13, "power");
    near(photon.flux[0], 3 * pi * pi * at[k].power, 1e-13, "flux");
    struct surface hit = {.p = vec_along(vec(0.1, 0.2, 2), nee.wi, nee.distance),
                          .ng = vec(0, 0, 1)};
    double pdf = light->type->pdf(&scene, light, vec(0.1, 0.2, 2), &hit, nee.wi);
    assert_true((nee.pdf_solid_angle == 0) == (k >= 2) && (pdf == 0) == (k >= 2));
    if (k < 2) near(nee.radiance_over_pdf[0] * pdf, 3 * at[k].connected, 1e-13, "connected");
  }
}

static void test_interface_is_dark(void **state) {
  (void)state;
  struct scene scene = {0};
  struct problem problem;
  const char *world =
      "Material \"interface\"\nAreaLightSource \"diffuse\"\nShape \"disk\"" LIGHT_PLANE;
  assert_false(light_scene_try(world, &arena, &scene, &problem));
  assert_non_null(strstr(problem.text, "no light emits"));
}

// The bounding sphere's R^2 is 32: 4 pi L times the disc pi R^2.
static void test_power(void **state) {
  (void)state;
  double unit = 4 * pi * pi * 32;
  const struct {
    const char *light;
    double L;
  } at[] = {
      {"LightSource \"infinite\"", 1},
      {"LightSource \"infinite\" \"rgb L\" [1 2 3] \"float scale\" 3", 6},
      {"LightSource \"infinite\" \"rgb L\" [1 2 3] \"float illuminance\" 5", 10 / pi},
      {ENVIRONMENT(TWO "\""), 2},
      {ENVIRONMENT(TWO "\" \"float scale\" 3"), 6},
      {ENVIRONMENT(NUMBERED "\""), 8.5},
      {ENVIRONMENT(NEGATIVE "\""), 1.5},
  };
  for (size_t k = 0; k < sizeof at / sizeof *at; k++)
    near(power(at[k].light), unit * at[k].L, 1e-6 * unit * at[k].L, at[k].light); // float bounds
  // pbrt-v4 takes 2 pi for the sphere's 4 pi, and the cosines of the texels' centres.
  double z = 0;
  for (int k = 0; k < 16; k++)
    z += fmax(octahedral_direction((k % 4 + 0.5) / 4, (k / 4 + 0.5) / 4).z, 0);
  near(power(ENVIRONMENT(TWO "\" \"float illuminance\" 5")), unit * 5 / (z * 2 * pi / 16),
       1e-6 * unit * 5, "illuminance of an image");
}

static void test_refusals(void **state) {
  (void)state;
  static const struct {
    const char *light, *says;
  } refusals[] = {
      {"LightSource \"infinite\" \"rgb L\" [1 -1 1]", "negative"},
      {"LightSource \"infinite\" \"rgb L\" [1 1 1] \"float illuminance\" 0", "greater than zero"},
      {ENVIRONMENT(TWO "\" \"rgb L\" [1 1 1]"), "exclude each other"},
      {ENVIRONMENT(WIDE "\""), "4 x 3 pixels"},
      {ENVIRONMENT("no-such-file.pfm\""), "no-such-file.pfm"},
      {ENVIRONMENT(TWO "\" \"point3 portal\" [0 0 0 1 0 0 1 1 0 0 1 0]"), "portal"},
      {"LightSource \"goniometric\"", "needs \"string filename\""},
      {"LightSource \"goniometric\" \"string filename\" \"" WIDE "\"", "4 x 3 pixels"},
      {"Scale 1 2 1 LightSource \"goniometric\" \"string filename\" \"" TWO "\"", "stretches"},
      {"LightSource \"projection\"", "needs \"string filename\""},
      {PROJECTION TWO "\" \"float fov\" 180", "(0, 180)"},
      {PROJECTION TWO "\" \"float power\" 0", "greater than zero"},
      {"AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"string filename\" \"" TWO
       "\" Shape \"disk\"",
       "exclude each other"},
      {"Scale 1 2 1 " ENVIRONMENT(TWO "\""), "stretches"},
  };
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    struct scene scene = {0};
    struct problem problem;
    char *world = arena_format(&arena, "%s%s", refusals[k].light, LIGHT_PLANE);
    if (light_scene_try(world, &arena, &scene, &problem)) fail_msg("%s is read", refusals[k].light);
    if (!strstr(problem.text, refusals[k].says) || !strstr(problem.text, ":4:"))
      fail_msg("%s: \"%s\"", refusals[k].light, problem.text);
  }
}

static void test_constant_closed_form(void **state) {
  (void)state;
  struct scene scene =
      light_scene("LightSource \"infinite\" \"rgb L\" [2 2 2]" LIGHT_PLANE, &arena);
  struct light_closed_form form = light_form(&scene, vec(1, 2, 0), vec(0, 0.6, -0.8));
  near(form.irradiance[0], 2 * pi, 1e-15, "pi L");
  assert_true(form.clear_radius == INFINITY && form.photon_flux[0] == scene.light[0].power[0]);
}

// ---- the choice of texels ----

static void test_choice(void **state) {
  (void)state;
  struct texels texels = {
      .raster = {.width = 3, .height = 2, .n_channels = 1}, .width = 3, .height = 2};
  texels.raster.value = (const float[]){0, 5, 0, 2, -1, 1};
  texels_weigh(&texels, NULL, NULL, &arena);
  // Rows weigh 5 and 3 of 8.
  struct texel a = texels_choose(&texels, (double[]){0.25, 0.3125});
  assert_true(a.x == 1 && a.y == 0 && a.chance == 0.625);
  near(a.u, 1.25 / 3, 1e-15, "u");
  near(a.v, 0.25, 1e-15, "v");
  struct texel b = texels_choose(&texels, (double[]){0.75, 0.9375});
  assert_true(b.x == 2 && b.y == 1 && b.chance == 0.125);
  near(b.u, 2.25 / 3, 1e-15, "u");
  const double last = 1 - 0x1p-53;
  struct texel c = texels_choose(&texels, (double[]){last, last});
  assert_true(c.x == 2 && c.y == 1 && c.u < 1 && c.v < 1);
  struct texel d = texels_choose(&texels, (double[]){0, 0});
  assert_true(d.x == 1 && d.y == 0); // never one of no weight
  assert_true(texels_at(&texels, 1, 1).x == 2 && texels_at(&texels, 0.4, 0.1).chance == 0.625);
  texels.raster.value = (const float[]){0, 0, 0, 0, -1, 0};
  texels_weigh(&texels, NULL, NULL, &arena);
  near(texels_choose(&texels, (double[]){0.5, 0.75}).chance, 1. / 6, 1e-15, "all black");
}

int main(void) {
  arena = arena_reserve();
  write_image(NUMBERED, 4, 4, numbered);
  write_image(TWO, 4, 4, two);
  write_image(WIDE, 4, 3, two);
  write_image(NEGATIVE, 4, 4, some_negative);
  const struct CMUnitTest tests[] = {
      {"the map's axes, poles and edges are pbrt's", test_axes, NULL, NULL, NULL},
      {"direction and point of the square are inverse", test_round_trip, NULL, NULL, NULL},
      {"areas of the square are 4 pi times as large on the sphere", test_equal_area, NULL, NULL,
       NULL},
      {"texels are where pbrt has them, turned and mirrored with the light",
       test_texels_are_where_pbrt_has_them, NULL, NULL, NULL},
      {"a goniometric light's texels, scale and power are pbrt's", test_goniometric, NULL, NULL,
       NULL},
      {"a projection's texels, angle and power are pbrt's", test_projection, NULL, NULL, NULL},
      {"an area light's image is looked up as in pbrt", test_area, NULL, NULL, NULL},
      {"alpha dims, and zero hides without dimming", test_alpha, NULL, NULL, NULL},
      {"a shape of material interface emits nothing", test_interface_is_dark, NULL, NULL, NULL},
      {"power and illuminance are pbrt's", test_power, NULL, NULL, NULL},
      {"what is no environment is refused with its line", test_refusals, NULL, NULL, NULL},
      {"a constant lights a surface with pi L", test_constant_closed_form, NULL, NULL, NULL},
      {"texels are chosen in proportion to their weight", test_choice, NULL, NULL, NULL},
  };
  int failed = cmocka_run_group_tests_name("light_images", tests, NULL, NULL);
  static const char *const names[] = {NUMBERED, TWO, WIDE, NEGATIVE};
  for (int k = 0; k < 4; k++) unlink(arena_format(&arena, "%s/%s", P_tmpdir, names[k]));
  return failed;
}
