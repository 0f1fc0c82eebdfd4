// Views: the classes of light paths add up to all of them, for every integrator on the same random
// numbers; and each class is the same by photons and by path tracing.
#include "integrator/integrator.h"
#include "moments/moments.h"
#include "numeric/rng.h"
#include "run/plan.h"
#include "scene/reader.h"
#include "walk/light_path.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

static struct arena arena;

static const struct scene *scene_of(const char *text) {
  struct scene *scene = arena_new(&arena, struct scene, 1);
  struct problem problem = {0};
  struct text file = {arena_string(&arena, text, (ptrdiff_t)strlen(text)), (ptrdiff_t)strlen(text)};
  struct arena lists = arena_reserve(), scratch = arena_reserve();
  if (!scene_read_text("views.pbrt", NULL, file, &arena, lists, scratch, scene, &problem))
    fail_msg("%s", problem.text);
  arena_release(lists);
  arena_release(scratch);
  return scene;
}

// A room with a lamp on the ceiling, seen whole; a glass ball, a mirror and a sheet whose material
// is half a mirror's: all kinds of light paths, at most of the pixels.
#define WALL(reflectance, points)                                                                  \
  "Material \"diffuse\" \"rgb reflectance\" " reflectance " Shape \"trianglemesh\" "               \
  "\"integer indices\" [0 1 2 0 2 3] \"point3 P\" " points "\n"
static const char room[] =
    "LookAt 0 1 -3.4  0 1 0  0 1 0\nCamera \"perspective\" \"float fov\" 38\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
    "PixelFilter \"box\"\nWorldBegin\n"
    // clang-format off
    WALL("[.6 .6 .6]", "[-1 0 -1 1 0 -1 1 0 1 -1 0 1]")
    WALL("[.6 .6 .6]", "[-1 2 -1 -1 2 1 1 2 1 1 2 -1]")
    WALL("[.5 .5 .5]", "[-1 0 1 1 0 1 1 2 1 -1 2 1]")
    WALL("[.7 .7 .7]", "[-1 0 -1 -1 0 1 -1 2 1 -1 2 -1]")
    WALL("[.3 .3 .3]", "[1 0 -1 1 2 -1 1 2 1 1 0 1]")
    // clang-format on
    "AttributeBegin Translate -.4 .4 0 Material \"dielectric\" Shape \"sphere\" \"float radius\" "
    ".35 AttributeEnd\n"
    "AttributeBegin Translate .5 .3 .3 Material \"conductor\" \"rgb reflectance\" [.8 .8 .8] "
    "Shape \"sphere\" \"float radius\" .3 AttributeEnd\n"
    "Material \"coateddiffuse\" \"rgb reflectance\" [.5 .5 .5] \"float roughness\" 0\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
    "[-.9 1.1 .9 .2 1.1 .9 .2 1.8 .9 -.9 1.8 .9]\n"
    "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] \"bool twosided\" true\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
    "[-.4 1.8 -.4 .4 1.8 -.4 .4 1.8 .4 -.4 1.8 .4]\n";

static struct pixel *film(const struct scene *scene, int *n) {
  struct problem problem = {0};
  return plan_film(scene, n, &arena, &problem);
}

static struct measurement measure(const struct scene *scene, const struct estimator *estimator,
                                  int n_estimators) {
  struct measurement measure = {.scene = scene,
                                .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                                .features = scene_features(scene),
                                .n_replicas = 1,
                                .footprint = true,
                                .depth = 12,
                                .n_emitted = 3000,
                                .seed = rng_hash_name("views"),
                                .estimator = estimator,
                                .n_estimators = n_estimators};
  measure.pixel = film(scene, &measure.n_points);
  return measure;
}

enum { ITERATIONS = 4 };

// The frames of a few iterations, one after the other.
static double *frames_of(const struct integrator_type *type, const struct measurement *measure) {
  long size = (long)measure->n_estimators * measure->n_points * measure->features.n_channels;
  double *frame = arena_new(&arena, double, ITERATIONS *size);
  void *state = type->create(measure, &arena);
  type->begin(state, 1);
  for (uint64_t i = 1; i <= ITERATIONS; i++) type->step(state, i, frame + (long)(i - 1) * size);
  return frame;
}

static double *seeing(const struct integrator_type *type, struct measurement measure,
                      unsigned kinds) {
  measure.left_out = LIGHT_PATH_ALL & ~kinds;
  return frames_of(type, &measure);
}

// Rounding: sums of up to some ten thousand terms, each class in an order of its own.
static void classes_add_up_to_all_for_every_integrator(void **state) {
  (void)state;
  struct estimator estimator[2] = {
      {.kernel = kernel_find("box"), .law = law_find("knaus-zwicker"), .alpha = 0.6, .r1 = 0.3},
      {.kernel = kernel_find("gaussian"), .alpha = 0.6, .r1 = 0.2}};
  const struct scene *scene = scene_of(room);
  for (int k = 0; integrator_types[k]; k++)
    for (int nee = 0; nee < 2; nee++) {
      const struct integrator_type *type = integrator_types[k];
      struct measurement on = measure(scene, estimator, 2);
      estimator[1].law = law_find(type->independent ? "power" : "hachisuka");
      estimator[1].k = type->takes_k ? 20 : 0;
      on.nee = nee;
      long n = (long)on.n_estimators * on.n_points * on.features.n_channels * ITERATIONS;
      double *all = frames_of(type, &on), *one[LIGHT_PATHS], total[LIGHT_PATHS] = {0};
      double *two = seeing(type, on, LIGHT_PATH_DIRECT | LIGHT_PATH_CAUSTICS);
      for (int c = 0; c < LIGHT_PATHS; c++) one[c] = seeing(type, on, light_paths[c].bit);
      for (long j = 0; j < n; j++) {
        double sum = 0;
        for (int c = 0; c < LIGHT_PATHS; c++) sum += one[c][j], total[c] += one[c][j];
        if (!(fabs(sum - all[j]) <= 1e-12 * all[j]))
          fail_msg("%s: %.17g, classes %.17g", type->name, all[j], sum);
        assert_true(fabs(one[1][j] + one[2][j] - two[j]) <= 1e-12 * all[j]);
      }
      for (int c = 0; c < LIGHT_PATHS; c++) // the room has all of them
        if (!(total[c] > 0)) fail_msg("%s sees nothing %s", type->name, light_paths[c].name);
    }
}

static double mean_of(const double *value, int n) {
  double sum = 0;
  for (int k = 0; k < n; k++) sum += value[k];
  return sum / n;
}

// The film's mean over iterations first .. first + count - 1. Three estimators are extrapolated to
// radius zero: m0 of m0 + m1 r + m2 r^2 from r, r / 2 and r / 4 on the same photons.
static struct moments film_mean(const struct integrator_type *type,
                                const struct measurement *measure, uint64_t count) {
  int n = measure->n_points * measure->features.n_channels;
  double *frame = arena_new(&arena, double, (long)measure->n_estimators *n);
  struct moments moments = {0};
  void *state = type->create(measure, &arena);
  type->begin(state, 1);
  for (uint64_t i = 1; i <= count; i++) {
    type->step(state, i, frame);
    double value = mean_of(frame, n);
    if (measure->n_estimators == 3)
      value = value / 3 - 2 * mean_of(frame + n, n) + 8 * mean_of(frame + 2 * n, n) / 3;
    moments = moments_merge(moments, moments_of(value));
  }
  return moments;
}

// Level 1e-6 over the 5 tests: |z| < 5.3. Standard errors are 3 % of a class, 15 % of caustics:
// found with probability 0.95 are errors of 20 % and of 100 %, a class lost or counted twice.
static void photons_and_paths_agree_class_by_class(void **state) {
  (void)state;
  struct estimator estimator[3];
  for (int e = 0; e < 3; e++)
    estimator[e] = (struct estimator){.kernel = kernel_find("epanechnikov"),
                                      .law = law_find("knaus-zwicker"),
                                      .alpha = 1,
                                      .r1 = 0.12 / (1 << e)};
  const struct scene *scene = scene_of(room);
  for (int c = 0; c < LIGHT_PATHS; c++) {
    struct measurement by_path = measure(scene, estimator, 1);
    by_path.left_out = LIGHT_PATH_ALL & ~(unsigned)light_paths[c].bit;
    struct moments paths = film_mean(integrator_find("path"), &by_path, 2000);
    bool direct = light_paths[c].bit == LIGHT_PATH_DIRECT; // else nee changes nothing
    for (int nee = 0; nee < (direct ? 2 : 1); nee++) {
      struct measurement by_photons = measure(scene, estimator, 3);
      by_photons.left_out = by_path.left_out;
      by_photons.nee = nee;
      by_photons.n_emitted = 4000;
      by_photons.seed++;
      struct moments photons = film_mean(integrator_find("probabilistic"), &by_photons, 200);
      double se = sqrt(moments_se2(photons) + moments_se2(paths));
      double z = (photons.mean - paths.mean) / se;
      if (!(fabs(z) < 5.3))
        fail_msg("%s: %g and %g, z %g", light_paths[c].name, photons.mean, paths.mean, z);
    }
  }
}

// ---- direct light ----

enum { REGIONS = 5, RUNS = 60, PER_RUN = 2 };

// The film and its quadrants, of a frame of 8 x 8 pixels.
static void region_means(const double *frame, double mean[REGIONS]) {
  memset(mean, 0, REGIONS * sizeof *mean);
  for (int j = 0; j < 64; j++) {
    int quadrant = 1 + j / 32 * 2 + j % 8 / 4;
    mean[0] += frame[j] / 64, mean[quadrant] += frame[j] / 16;
  }
}

// Extrapolated to radius zero, as film_mean, over the iterations of one run.
static void run_means(const struct integrator_type *type, void *state, uint64_t run,
                      double out[REGIONS]) {
  static const double weight[3] = {1.0 / 3, -2, 8.0 / 3};
  double frame[3][64], mean[REGIONS];
  memset(out, 0, REGIONS * sizeof *out);
  type->begin(state, run);
  for (uint64_t i = 1; i <= PER_RUN; i++) {
    type->step(state, i, frame[0]);
    for (int e = 0; e < 3; e++) {
      region_means(frame[e], mean);
      for (int r = 0; r < REGIONS; r++) out[r] += weight[e] * mean[r] / PER_RUN;
    }
  }
}

// Direct light by photons minus that by next-event estimation, from the same eye points and the
// same photons otherwise. Level 1e-6 over the 20 tests: |z| < 5.5. The film's
// standard error is 5 % of the direct light: found with probability 0.95 is a difference of 35 %.
static void direct_light_by_photons_and_by_nee_is_the_same_image(void **state) {
  (void)state;
  const struct scene *scene = scene_of(room);
  for (int k = 0; integrator_types[k]; k++) {
    const struct integrator_type *type = integrator_types[k];
    if (!type->photons) continue;
    struct estimator estimator[3];
    for (int e = 0; e < 3; e++)
      estimator[e] =
          (struct estimator){.kernel = kernel_find("epanechnikov"),
                             .law = law_find(type->independent ? "knaus-zwicker" : "hachisuka"),
                             .alpha = 1, // keeps the radius
                             .r1 = 0.16 / (1 << e)};
    struct measurement by_photons = measure(scene, estimator, 3);
    by_photons.depth = 3; // caustics of the ball among them
    struct measurement by_nee = by_photons;
    by_nee.nee = true;
    assert_int_equal(by_nee.n_points * by_nee.features.n_channels, 64);
    void *one = type->create(&by_photons, &arena), *other = type->create(&by_nee, &arena);
    struct moments difference[REGIONS] = {{0}};
    double direct = 0;
    for (uint64_t run = 1; run <= RUNS; run++) {
      double a[REGIONS], b[REGIONS];
      run_means(type, one, run, a), run_means(type, other, run, b);
      direct += b[0] / RUNS;
      for (int r = 0; r < REGIONS; r++)
        difference[r] = moments_merge(difference[r], moments_of(a[r] - b[r]));
    }
    for (int r = 0; r < REGIONS; r++) {
      double se = sqrt(moments_se2(difference[r])), z = difference[r].mean / se;
      if (getenv("VIEWS_VERBOSE"))
        print_message("%-14s %d: %g of %g, se %g, z %.2f\n", type->name, r, difference[r].mean,
                      direct, se, z);
      if (!(fabs(z) < 5.5))
        fail_msg("%s, region %d: by photons %g more of %g, z %g", type->name, r, difference[r].mean,
                 direct, z);
    }
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(classes_add_up_to_all_for_every_integrator),
      cmocka_unit_test(photons_and_paths_agree_class_by_class),
      cmocka_unit_test(direct_light_by_photons_and_by_nee_is_the_same_image),
  };
  return cmocka_run_group_tests_name("views", tests, NULL, NULL);
}
