// A length has no natural unit, and light none either: a scene scaled by a power of two has the
// same bits, whatever meets its rays. An absolute epsilon or offset would show.
#include "estimate/photon_map.h"
#include "integrator/integrator.h"
#include "scene/read.h"

#include "tests/unit/scene_text.h"

static struct arena arena;

// A camera, and a world of every kind of surface and light; lengths times `size`, light times
// `light`.
static char *text_of(double size, double light) {
  return arena_format(
      &arena,
      "LookAt 0 1.2 -4  0 0.8 0  0 1 0\nScale %.17g %.17g %.17g\n"
      "Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.02 \"float focaldistance\" "
      "4\n"
      "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\nWorldBegin\n"
      "Scale %.17g %.17g %.17g\n"
      "LightSource \"infinite\" \"rgb L\" [0.2 0.25 0.3] \"float scale\" %.17g\n"
      "LightSource \"point\" \"rgb I\" [3 4 3] \"point3 from\" [1.2 2 -1.5] \"float scale\" %.17g\n"
      "LightSource \"spot\" \"rgb I\" [8 8 9] \"point3 from\" [-1 2.5 -1] \"point3 to\" [0 0 0]\n"
      "  \"float scale\" %.17g\n"
      "Texture \"check\" \"spectrum\" \"checkerboard\" \"integer dimension\" 3\n"
      "Material \"diffuse\" \"texture reflectance\" \"check\"\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
      "  \"point3 P\" [-3 0.1 -3 3 0 -3 3 0.1 3 -3 0.2 3]\n"
      "Material \"coateddiffuse\" \"rgb reflectance\" [0.4 0.5 0.6] \"float roughness\" 0.1\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-3 0 2  3 0 2  -3 3 2.3  3 3 1.7]\n"
      "AttributeBegin\n"
      "AreaLightSource \"diffuse\" \"rgb L\" [3 3 2.5] \"bool twosided\" true \"float scale\" %.17g\n"
      "Translate 0 2.6 0\nScale 0.5 0.2 0.3\nShape \"sphere\"\nAttributeEnd\n"
      "AttributeBegin\nMaterial \"dielectric\"\nTranslate -0.4 0.6 -0.5\n"
      "Shape \"sphere\" \"float radius\" 0.4\nAttributeEnd\n"
      "AttributeBegin\nMaterial \"dielectric\" \"float roughness\" 0.1\nTranslate 0.7 0.7 -0.6\n"
      "Rotate 40 0 1 0\nShape \"loopsubdiv\" \"integer levels\" 2\n"
      "  \"integer indices\" [0 2 1 0 3 2 0 1 3 1 2 3]\n"
      "  \"point3 P\" [0 0.6 0  -0.5 -0.3 -0.4  0.5 -0.3 -0.4  0 -0.3 0.6]\nAttributeEnd\n"
      "Material \"conductor\" \"float roughness\" 0.2\nTranslate 0.1 0 0.9\nRotate -90 1 0 0\n"
      "Shape \"cylinder\" \"float radius\" 0.25 \"float zmax\" 0.7\n"
      "Shape \"disk\" \"float radius\" 0.25 \"float height\" 0.7\n",
      1 / size, 1 / size, 1 / size, size, size, size, light, light * size * size,
      light * size * size, light);
}

enum { N_ITERATIONS = 2, DEPTH = 6 };

// The frames of an integrator, one after the other.
static double *frames_of(const struct integrator_type *integrator, double size, double light,
                         long *count) {
  struct scene scene = scene_of(text_of(size, light));
  struct estimator estimator = {.kernel = kernel_find("epanechnikov"),
                                .law =
                                    law_find(integrator->law ? integrator->law : "knaus-zwicker"),
                                .alpha = 0.7,
                                .r1 = 0.35 * size};
  struct pixel pixel[48];
  for (int j = 0; j < 48; j++) pixel[j] = (struct pixel){j % 8, j / 8};
  struct measurement measure = {.scene = &scene,
                                .bvh = bvh_build(&scene, (struct bvh_options){0}, &arena),
                                .features = scene_features(&scene),
                                .pixel = pixel,
                                .n_points = 48,
                                .n_replicas = 1,
                                .footprint = true,
                                .depth = DEPTH,
                                .n_emitted = 2000,
                                .seed = rng_hash_name("scaled"),
                                .estimator = &estimator,
                                .n_estimators = 1};
  long one = photon_map_frame(&measure);
  double *frames = arena_new(&arena, double, N_ITERATIONS *one);
  void *state = integrator->create(&measure, &arena);
  integrator->begin(state, 1);
  for (uint64_t i = 1; i <= N_ITERATIONS; i++)
    integrator->step(state, i, frames + (long)(i - 1) * one);
  *count = N_ITERATIONS * one;
  return frames;
}

// Every integrator at this size and light, against 1 and 1.
static void check(double size, double light) {
  struct arena whole = arena;
  for (const struct integrator_type *const *type = integrator_types; *type; type++, arena = whole) {
    long n = 0, m = 0;
    int lit = 0;
    double *want = frames_of(*type, 1, 1, &n), *got = frames_of(*type, size, light, &m);
    assert_int_equal(n, m);
    for (long k = 0; k < n; k++) {
      if (got[k] != light * want[k])
        fail_msg("%s, size %g, light %g: value %ld is %.17g, not %.17g", (*type)->name, size, light,
                 k, got[k], light * want[k]);
      lit += want[k] > 0;
    }
    assert_true(lit > n / 3);
  }
}

static void a_scene_scaled_by_powers_of_two_has_the_same_bits(void **state) {
  (void)state;
  check(0x1p20, 1);
  check(0x1p-20, 1);
}

static void light_scaled_by_powers_of_two_has_the_same_bits(void **state) {
  (void)state;
  check(1, 0x1p40);
  check(1, 0x1p-40);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_scene_scaled_by_powers_of_two_has_the_same_bits),
      cmocka_unit_test(light_scaled_by_powers_of_two_has_the_same_bits),
  };
  return cmocka_run_group_tests_name("scaled", tests, NULL, NULL);
}
