// What the lights' parameters mean (pbrt-format.md's measurements of pbrt-v4) and what is refused.
#define _GNU_SOURCE // mkstemp
#include "tests/light_fixture.h"

#include <math.h>

static struct arena arena;

static void assert_close(double measured, double expected) {
  if (!(fabs(measured - expected) <= 4e-15 * fabs(expected)))
    fail_msg("%.17g, not %.17g", measured, expected);
}

struct meaning {
  const char *light;
  double power[3];
};

// A triangle of area 2 and one of area 8.
#define TRIANGLES                                                                                  \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 3 4] \"point3 P\" "                         \
  "[0 0 0 2 0 0 0 2 0 -4 0 0 0 -4 0]"

static void test_power(void **state) {
  (void)state;
  static const struct meaning meanings[] = {
      {"LightSource \"point\"" LIGHT_PLANE, {4 * 1, 4, 4}},
      {"LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 0.5" LIGHT_PLANE, {2, 4, 6}},
      {"LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 0.5 \"float power\" 7" LIGHT_PLANE,
       {3.5 / 0x1.921fb54442d18p+1, 7 / 0x1.921fb54442d18p+1, 10.5 / 0x1.921fb54442d18p+1}},
      {"LightSource \"point\" \"string emission\" \"lambertian\" \"rgb I\" [3 3 3]" LIGHT_PLANE,
       {3, 3, 3}},
      // 2 ((1 - cos 25) + (cos 25 - cos 30) / 2), and 4 for a whole sphere
      {"LightSource \"spot\" \"rgb I\" [1 2 3]" LIGHT_PLANE,
       {0.22766680917891136, 0.45533361835782272, 0.68300042753673408}},
      {"LightSource \"spot\" \"rgb I\" [1 2 3] \"float power\" 7" LIGHT_PLANE,
       {7 / 0x1.921fb54442d18p+1, 14 / 0x1.921fb54442d18p+1, 21 / 0x1.921fb54442d18p+1}},
      {"LightSource \"spot\" \"float coneangle\" 180 \"float conedeltaangle\" 0" LIGHT_PLANE,
       {4, 4, 4}},
      // R = 4 sqrt 2
      {"LightSource \"distant\" \"rgb L\" [1 2 3]" LIGHT_PLANE, {32, 64, 96}},
      {"LightSource \"distant\" \"rgb L\" [1 2 3] \"float illuminance\" 10" LIGHT_PLANE,
       {320, 640, 960}},
      {"AreaLightSource \"diffuse\" \"rgb L\" [1 2 3]\n" TRIANGLES, {10, 20, 30}},
      {"AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"bool twosided\" true\n" TRIANGLES,
       {20, 40, 60}},
  };
  for (size_t i = 0; i < sizeof meanings / sizeof *meanings; i++) {
    struct scene scene = light_scene(meanings[i].light, &arena);
    for (int c = 0; c < 3; c++) {
      double expected = pi * meanings[i].power[c], measured = scene.light[0].power[c];
      if (!(fabs(measured / expected - 1) < 1e-6)) // the bounds are floats, rounded outward
        fail_msg("%s: %.17g, not %.17g", meanings[i].light, measured, expected);
    }
  }
}

// pbrt's shape is our primitive: with a power P each triangle has L = P / (pi A).
static void test_area_power(void **state) {
  (void)state;
  struct scene one = light_scene(
      "AreaLightSource \"diffuse\" \"rgb L\" [1 2 1] \"float power\" 5\n" TRIANGLES, &arena);
  struct scene two = light_scene(
      "AreaLightSource \"diffuse\" \"bool twosided\" true \"float power\" 5\n" TRIANGLES, &arena);
  double rgb[3];
  struct surface surface = {.ng = vec(0, 0, 1)};
  struct vec front = vec(0, 0.6, 0.8), back = vec(0, 0.6, -0.8), edge = vec(1, 0, 0);
  const struct light_type *type = one.light[0].type;
  assert_close(one.light[0].power[0], 10);
  assert_close(one.light[0].power[1], 20);
  assert_close(two.light[0].power[0], 10);
  type->radiance(&one, &one.light[0], &surface, front, rgb);
  assert_close(rgb[0], 5 / (pi * 2));
  assert_close(rgb[1], 10 / (pi * 2));
  type->radiance(&one, &one.light[0], &surface, back, rgb);
  assert_true(rgb[0] == 0);
  type->radiance(&one, &one.light[0], &surface, edge, rgb); // n.w >= 0
  assert_close(rgb[0], 5 / (pi * 2));
  surface.primitive = 1;
  type->radiance(&two, &two.light[0], &surface, back, rgb);
  assert_close(rgb[0], 5 / (2 * pi * 8));
}

// An L of 15 reads exactly 15, and zero is a light that gives nothing.
static void test_radiance_exact(void **state) {
  (void)state;
  struct scene scene = light_scene("AreaLightSource \"diffuse\" \"rgb L\" [15 0 15]\n"
                                   "Shape \"sphere\" \"float radius\" 0.3",
                                   &arena);
  double rgb[3];
  struct surface surface = {.p = vec(0, 0, 0.3), .ng = vec(0, 0, 1)};
  scene.light[0].type->radiance(&scene, &scene.light[0], &surface, vec(0, 0, 1), rgb);
  assert_true(rgb[0] == 15 && rgb[1] == 0 && rgb[2] == 15);
  assert_true(scene.light[0].power[1] == 0);
}

// Emission that is not rgb has luminance 1, times scale, whatever the units of its samples.
static void test_spectra(void **state) {
  (void)state;
  static const struct {
    const char *spectrum;
    double rgb[3];
  } cases_of[] = {
      {"\"blackbody I\" 6500", {1.043, 0.984, 1.035}}, // pbrt-v4's image
      {"\"spectrum I\" \"stdillum-D65\"", {1, 1, 1}},
      {"\"spectrum I\" \"stdillum-F2\"", {1.3400, 0.9430, 0.5628}},
      // Equal energy: XYZ = 1 1 1 through IEC 61966-2-1
      {"\"spectrum I\" [300 7 900 7]", {1.2048, 0.9484, 0.9089}},
  };
  for (size_t i = 0; i < sizeof cases_of / sizeof *cases_of; i++) {
    struct scene scene =
        light_scene(arena_format(&arena, "LightSource \"point\" \"float scale\" 2 %s%s",
                                 cases_of[i].spectrum, LIGHT_PLANE),
                    &arena);
    for (int c = 0; c < 3; c++) {
      double measured = scene.light[0].power[c] / (8 * pi);
      if (!(fabs(measured - cases_of[i].rgb[c]) <= 7e-4))
        fail_msg("%s: channel %d is %.6g", cases_of[i].spectrum, c, measured);
    }
  }
}

static struct vec emitted(const struct scene *scene, struct vec *d) {
  double u[LIGHT_U] = {0};
  struct emission photon;
  scene->light[0].type->emit(scene, &scene->light[0], u, &photon);
  *d = photon.ray.d;
  return photon.ray.o;
}

// Quarter turns are exact: `from`, `to` and `across` follow the transformation, lengths do not.
static void test_transform(void **state) {
  (void)state;
  struct vec o, d;
#define MOVED(light)                                                                               \
  "AttributeBegin\nTranslate 1 2 3\nRotate 90 0 0 1\n" light "\nAttributeEnd\n" LIGHT_PLANE
  struct scene scene = light_scene(MOVED("LightSource \"point\" \"point3 from\" [5 0 0]"), &arena);
  o = emitted(&scene, &d);
  assert_true(o.x == 1 && o.y == 7 && o.z == 3);
  scene = light_scene(MOVED("LightSource \"beam\" \"point3 from\" [5 0 0] \"point3 to\" [6 0 0]"),
                      &arena);
  o = emitted(&scene, &d); // u = 0: on the axis
  assert_true(o.x == 1 && o.y == 7 && o.z == 3 && d.x == 0 && d.y == 1 && d.z == 0);
  scene = light_scene(MOVED("Scale 2 2 2\nLightSource \"beam\" \"string profile\" \"cosine\" "
                            "\"float radius\" 0.5 \"float wavelength\" 0.4"),
                      &arena);
  o = emitted(&scene, &d); // u = 0: the corner (-x, -y) of the square, x turned to (0, 1, 0)
  assert_close(o.y, 1.5);
  assert_close(fabs(o.x - 1), 0.5);
}

static void test_gray(void **state) {
  (void)state;
  static const char *const gray[] = {
      "LightSource \"point\" \"rgb I\" [0.1 0.1 0.1] \"float power\" 3" LIGHT_PLANE,
      "LightSource \"beam\" \"float power\" 3" LIGHT_PLANE,
      "LightSource \"beam\" \"rgb power\" [3 3 3]" LIGHT_PLANE,
      "AreaLightSource \"diffuse\" \"rgb L\" [0.1 0.1 0.1] \"float power\" 3\n" TRIANGLES,
  };
  static const char *const coloured[] = {
      "LightSource \"point\" \"rgb I\" [0.1 0.1 0.2]" LIGHT_PLANE,
      "LightSource \"distant\" \"rgb L\" [0.1 0.2 0.1]" LIGHT_PLANE,
      "LightSource \"beam\" \"rgb power\" [3 4 4]" LIGHT_PLANE,
      "AreaLightSource \"diffuse\" \"rgb L\" [0.1 0.1 0.2]\n" TRIANGLES,
  };
  for (size_t i = 0; i < sizeof gray / sizeof *gray; i++) {
    struct scene scene = light_scene(gray[i], &arena);
    assert_true(scene.light[0].type->is_gray(&scene.light[0]));
  }
  for (size_t i = 0; i < sizeof coloured / sizeof *coloured; i++) {
    struct scene scene = light_scene(coloured[i], &arena);
    assert_false(scene.light[0].type->is_gray(&scene.light[0]));
  }
}

// The first and last random numbers there are stay in the range of every light.
static void test_extreme_numbers(void **state) {
  (void)state;
  static const char *const lights[] = {
      "LightSource \"point\"" LIGHT_PLANE,
      "LightSource \"point\" \"string emission\" \"lambertian\"" LIGHT_PLANE,
      "LightSource \"distant\"" LIGHT_PLANE,
      "LightSource \"spot\"" LIGHT_PLANE,
      "LightSource \"spot\" \"float coneangle\" 90 \"float conedeltaangle\" 90" LIGHT_PLANE,
      "LightSource \"beam\"" LIGHT_PLANE,
      "LightSource \"beam\" \"string profile\" \"quadratic\"" LIGHT_PLANE,
      "LightSource \"beam\" \"string profile\" \"gaussian\"" LIGHT_PLANE,
      "LightSource \"beam\" \"string profile\" \"slab\"" LIGHT_PLANE,
      "LightSource \"beam\" \"string profile\" \"cosine\" \"float wavelength\" 1" LIGHT_PLANE,
      "LightSource \"beam\" \"string profile\" \"cosine\" \"float wavelength\" 0.4" LIGHT_PLANE,
      "LightSource \"beam\" \"string profile\" \"cosine\" \"float wavelength\" 1e-5" LIGHT_PLANE,
      "AreaLightSource \"diffuse\" \"bool twosided\" true\n" TRIANGLES,
      "AreaLightSource \"diffuse\" \"float power\" 3\n" TRIANGLES,
      "AreaLightSource \"diffuse\"\nShape \"sphere\"",
  };
  static const double value[] = {0, 0x1p-53, 0.25, 0.5 - 0x1p-53, 0.5, 0.75, 1 - 0x1p-53};
  enum { N_VALUES = sizeof value / sizeof *value };
  for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
    struct scene scene = light_scene(lights[i], &arena);
    bool gaussian = strstr(lights[i], "gaussian");
    for (int j = 0; j < N_VALUES * N_VALUES; j++) {
      double u[LIGHT_U] = {value[j % N_VALUES], value[j / N_VALUES], value[j % N_VALUES],
                           value[j / N_VALUES]};
      struct emission photon;
      scene.light[0].type->emit(&scene, &scene.light[0], u, &photon);
      if (!(fabs(vec_length(photon.ray.d) - 1) < 1e-14 &&
            vec_length(photon.ray.o) < (gaussian ? 8.6 : 8.01)))
        fail_msg("%s with u = %g, %g", lights[i], u[0], u[1]);
    }
  }
}

// A primitive without area is never chosen, wherever it stands.
static void test_degenerate_triangle(void **state) {
  (void)state;
  struct scene scene = light_scene(
      "AreaLightSource \"diffuse\" \"float power\" 3\nShape \"trianglemesh\" \"integer indices\" "
      "[0 1 1 0 1 2 2 2 2 0 3 4 4 4 0] \"point3 P\" [0 0 0 2 0 0 0 2 0 -4 0 0 0 -4 0]",
      &arena);
  assert_close(scene.light[0].power[0], 6);
  int count[5] = {0};
  for (int j = 0; j < 1000; j++) {
    double u[LIGHT_U] = {j / 1000., 0.3, 0.4, 0.5};
    struct emission photon;
    scene.light[0].type->emit(&scene, &scene.light[0], u, &photon);
    count[photon.ray.leaving]++;
  }
  assert_true(count[0] == 0 && count[1] == 500 && count[2] == 0 && count[3] == 500 &&
              count[4] == 0);
}

struct refusal {
  const char *light, *says;
};

static void test_refusals(void **state) {
  (void)state;
  static const struct refusal refusals[] = {
      {"LightSource \"point\" \"rgb I\" [1 -1 1]", "\"I\" must not be negative"},
      {"LightSource \"point\" \"float scale\" -1", "\"scale\" must not be negative"},
      {"LightSource \"point\" \"float power\" 0", "\"power\" must be greater than zero"},
      {"LightSource \"point\" \"rgb power\" [1 1 1]", "must be of type float"},
      {"LightSource \"point\" \"rgb I\" [1e300 1 1] \"float scale\" 1e300", "not finite"},
      {"LightSource \"point\" \"string emission\" \"lambert\"", "not \"lambert\""},
      {"LightSource \"point\" \"string emission\" \"lambertian\" \"point3 to\" [0 0 0]",
       "give no direction"},
      {"LightSource \"point\" \"point3 to\" [0 0 1]", "to"},
      {"LightSource \"point\" \"blackbody I\" [0]", "greater than zero"},
      {"LightSource \"point\" \"blackbody I\" [3000 1]", "one temperature"},
      {"LightSource \"point\" \"float I\" 3", "rgb, spectrum or blackbody"},
      {"LightSource \"point\" \"spectrum I\" \"stdillum-D56\"", "\"stdillum-D50\"?"},
      {"LightSource \"point\" \"spectrum I\" \"metal-Au-eta\"", "an index of refraction"},
      {"LightSource \"point\" \"spectrum I\" \"no-such.spd\"", "no-such.spd"},
      {"LightSource \"point\" \"spectrum I\" [400 1 500]", "odd"},
      {"LightSource \"point\" \"spectrum I\" [400 1 300 1]", "ascend"},
      {"LightSource \"point\" \"spectrum I\" [200 1 300 1]", "no light between"},
      {"LightSource \"spot\" \"float coneangle\" 0", "(0, 180]"},
      {"LightSource \"spot\" \"float coneangle\" 20 \"float conedeltaangle\" 21", "[0, coneangle]"},
      {"LightSource \"spot\" \"point3 to\" [0 0 0]", "no direction"},
      {"LightSource \"distant\" \"point3 from\" [1 2 3] \"point3 to\" [1 2 3]", "no direction"},
      {"LightSource \"distant\" \"rgb L\" [1 1 -1]", "\"L\" must not be negative"},
      {"LightSource \"distant\" \"float illuminance\" -1", "greater than zero"},
      {"LightSource \"beam\" \"float power\" -1", "\"power\" must not be negative"},
      {"LightSource \"beam\" \"rgb power\" [-1 1 1]", "\"power\" must not be negative"},
      {"LightSource \"beam\" \"float radius\" 0", "\"radius\" must be greater than zero"},
      {"LightSource \"beam\" \"float sigma\" 1", "sigma"},
      {"LightSource \"beam\" \"string profile\" \"gauss\"",
       "uniform, quadratic, gaussian, cosine, slab"},
      {"LightSource \"beam\" \"string profile\" \"gaussian\" \"float sigma\" -1", "\"sigma\" must"},
      {"LightSource \"beam\" \"string profile\" \"slab\" \"float width\" 0", "\"width\" must"},
      {"LightSource \"beam\" \"string profile\" \"cosine\"", "\"wavelength\" must"},
      {"LightSource \"beam\" \"string profile\" \"cosine\" \"float wavelength\" 1e-6", "too short"},
      {"LightSource \"beam\" \"string profile\" \"cosine\" \"float wavelength\" 1 "
       "\"float contrast\" 1.1",
       "between 0 and 1"},
      {"LightSource \"beam\" \"string profile\" \"cosine\" \"float wavelength\" 1 "
       "\"vector3 across\" [0 0 2]",
       "parallel to the beam"},
      {"LightSource \"beam\" \"point3 to\" [0 0 0]", "no direction"},
      {"AreaLightSource \"diffuse\" \"rgb L\" [-1 1 1]\nShape \"sphere\"", "negative"},
      {"AreaLightSource \"diffuse\" \"float power\" -1\nShape \"sphere\"", "greater than zero"},
      {"AreaLightSource \"diffuse\" \"float power\" 1e400\nShape \"sphere\"", "1e400"},
      {"AreaLightSource \"diffuse\"\nShape \"trianglemesh\" \"integer indices\" [0 0 1] "
       "\"point3 P\" [0 0 0 1 0 0]",
       "no area"},
  };
  for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
    struct scene scene = {0};
    struct problem problem;
    char *world = arena_format(&arena, "%s%s", refusals[i].light, LIGHT_PLANE);
    if (light_scene_try(world, &arena, &scene, &problem)) fail_msg("%s is read", refusals[i].light);
    if (!strstr(problem.text, refusals[i].says) || !strstr(problem.text, ":4:"))
      fail_msg("%s: \"%s\" and not \"%s\" in line 4", refusals[i].light, problem.text,
               refusals[i].says);
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"power is what intensity, irradiance or radiance times their measure give", test_power, NULL,
       NULL, NULL},
      {"emission that is not rgb is normalised to luminance 1", test_spectra, NULL, NULL, NULL},
      {"an area light's power is that of each triangle", test_area_power, NULL, NULL, NULL},
      {"a radiance of 15 reads exactly 15", test_radiance_exact, NULL, NULL, NULL},
      {"lights follow the current transformation", test_transform, NULL, NULL, NULL},
      {"a light of equal channels is gray", test_gray, NULL, NULL, NULL},
      {"the first and the last random numbers are as good as any", test_extreme_numbers, NULL, NULL,
       NULL},
      {"triangles without area emit nothing", test_degenerate_triangle, NULL, NULL, NULL},
      {"what makes no light is refused with its line", test_refusals, NULL, NULL, NULL},
  };
  return cmocka_run_group_tests_name("light_read", tests, NULL, NULL);
}
