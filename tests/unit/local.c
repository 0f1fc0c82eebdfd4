// Local statistics: ppm and sppm against the papers' own bookkeeping, over all photons of all
// passes one by one; whose photons count; and that a point depends on nothing but itself.
#include "estimate/local.h"
#include "estimate/reference_radius.h"
#include "integrator/integrator.h"
#include "run/plan.h"
#include "run/render.h"
#include "scene_text.h"

#include <float.h>
#include <stdlib.h>

static struct arena arena;
static const double pi = 3.14159265358979323846;

// A room of three unequal lights, two of them below the floor that is looked at: the floor receives
// photons on both sides, as does what hangs above it.
static const char two_sides[] =
    "LookAt 0 -0.1 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
    "LightSource \"point\" \"point3 from\" [0.3 0.2 2] \"rgb I\" [3 2 1]\n"
    "LightSource \"point\" \"point3 from\" [-0.3 0.4 -1] \"rgb I\" [1 4 2]\n"
    "LightSource \"point\" \"point3 from\" [1.3 0.4 -2] \"rgb I\" [2 2 5]\n"
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.7 0.3]\n"
    "Shape \"disk\" \"float radius\" 3\n"
    "Translate 0.4 0 0.7\nRotate 30 0 1 0\nShape \"disk\" \"float radius\" 0.4\n";

// Light from below alone.
static const char below[] =
    "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\n"
    "WorldBegin\n"
    "LightSource \"point\" \"point3 from\" [0 0 -1]\n"
    "Material \"diffuse\" \"rgb reflectance\" [0.5 0.7 0.3]\nShape \"disk\" \"float radius\" 3\n";

static const struct pixel some[] = {{1, 2}, {3, 3}, {4, 6}, {5, 4}, {6, 1}, {7, 7}};
enum { N_SOME = sizeof some / sizeof *some };

static struct measurement measure_of(const struct scene *scene, const struct estimator *estimator,
                                     int n_estimators) {
  return (struct measurement){.scene = scene,
                              .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                              .features = scene_features(scene),
                              .pixel = some,
                              .n_points = N_SOME,
                              .n_replicas = 1,
                              .depth = 4,
                              .n_emitted = 3000,
                              .seed = rng_hash_name("local"),
                              .estimator = estimator,
                              .n_estimators = n_estimators};
}

static struct estimator estimator_of(const char *kernel, const char *law, double alpha, double r1) {
  return (struct estimator){
      .kernel = kernel_find(kernel), .law = law_find(law), .alpha = alpha, .r1 = r1};
}

static void near(double got, double want, double relative) {
  if (!(fabs(got - want) <= relative * fabs(want)))
    fail_msg("%.17g, not %.17g: %.2g relative", got, want, (got - want) / want);
}

// Iterations 1..n of a run, averaged.
static double *average_of(const char *name, const struct measurement *measure, uint64_t n) {
  const struct integrator_type *integrator = integrator_find(name);
  long size = photon_map_frame(measure);
  double *sum = arena_new(&arena, double, size);
  struct arena scratch = arena;
  double *frame = arena_new(&scratch, double, size);
  void *state = integrator->create(measure, &scratch);
  integrator->begin(state, 1);
  for (uint64_t i = 1; i <= n; i++) {
    integrator->step(state, i, frame);
    for (long k = 0; k < size; k++) sum[k] += frame[k] / (double)n;
  }
  return sum;
}

// ---- the papers' bookkeeping: N, r2 and tau of one point and estimator ----

struct statistics {
  double n, r2, tau[3];
};

// One pass: Hachisuka, Ogaki, Jensen 2008, equations 3 to 8. `start`: how often the first photons
// found are counted before the rule is applied (1: their initial radius' photons; pbrt: 0).
static void correct(struct statistics *s, double alpha, int start, int64_t m, const double flux[3],
                    int n_channels) {
  if (m == 0) return;
  if (s->n == 0) s->n = start * (double)m;
  double kept = s->n + alpha * (double)m, ratio = kept / (s->n + (double)m);
  s->n = kept;
  s->r2 *= ratio;
  for (int c = 0; c < n_channels; c++) s->tau[c] = (s->tau[c] + flux[c]) * ratio;
}

// Photons of the eye's side in the disc: how many, and their flux times the BSDF.
static int64_t find(const struct eye_point *point, const struct photons *photons, double r2,
                    double flux[3]) {
  int64_t m = 0;
  for (int64_t k = 0; k < photons->count; k++) {
    struct vec d = vec_sub(photons->position[k], point->p);
    if (!(vec_dot(d, d) < r2) || !(vec_dot(photons->wi[k], eye_normal(point)) > 0)) continue;
    double f[3];
    bsdf_value(&point->bsdf, point->wo, photons->wi[k], TRANSPORT_RADIANCE, f);
    for (int c = 0; c < photons->n_channels; c++) flux[c] += f[c] * photons->flux[c][k];
    m++;
  }
  return m;
}

static void bookkeeping(const struct measurement *measure, uint64_t n_passes,
                        struct statistics *statistics, struct photon_map *map) {
  int n = measure->n_estimators;
  map->run = 1;
  for (long k = 0; k < (long)n * measure->n_points; k++)
    statistics[k] =
        (struct statistics){.r2 = measure->estimator[k % n].r1 * measure->estimator[k % n].r1};
  photon_map_see(map, 0);
  for (uint64_t i = 1; i <= n_passes; i++) {
    photon_map_emit(map, i, (double[POINT_KINDS]){1});
    for (long k = 0; k < (long)n * measure->n_points; k++) {
      double flux[3] = {0};
      const struct estimator *estimator = &measure->estimator[k % n];
      int64_t m = find(&map->point[k / n], &map->field[ON_SURFACE].photons, statistics[k].r2, flux);
      int start = strcmp(estimator->law->name, "hachisuka") == 0;
      correct(&statistics[k], estimator->alpha, start, m, flux,
              map->field[ON_SURFACE].photons.n_channels);
    }
  }
}

// tau / (pi r2 n_emitted) after all passes is the average of what the passes estimate (theory 2.4),
// with photons on both sides. 1e-12: 150 passes of a few hundred roundings.
static void the_flux_rule_is_the_average_of_the_passes(void **state) {
  (void)state;
  enum { PASSES = 150 };
  struct scene scene = scene_of(two_sides);
  const struct estimator estimator[] = {estimator_of("box", "hachisuka", 2.0 / 3, 0.2),
                                        estimator_of("box", "pbrt", 2.0 / 3, 0.1),
                                        estimator_of("box", "hachisuka", 0.3, 0.05)};
  struct measurement measure = measure_of(&scene, estimator, 3);
  struct photon_map *map = photon_map_new(&measure, &arena);
  struct statistics statistics[3 * N_SOME];
  bookkeeping(&measure, PASSES, statistics, map);
  double *average = average_of("ppm", &measure, PASSES);
  int n_channels = measure.features.n_channels;
  for (int e = 0; e < 3; e++)
    for (int p = 0; p < N_SOME; p++)
      for (int c = 0; c < n_channels; c++) {
        const struct statistics *s = &statistics[p * 3 + e];
        double radiance =
            map->point[p].weight[c] * s->tau[c] / (pi * s->r2 * (double)measure.n_emitted * PASSES);
        assert_true(s->n > 0 && radiance > 0);
        near(average[(e * N_SOME + p) * n_channels + c], radiance, 1e-12);
      }
}

// Radii and counts are those of the book, not only what they make of the flux.
static void radii_and_counts_are_those_of_the_book(void **state) {
  (void)state;
  enum { PASSES = 40 };
  struct scene scene = scene_of(two_sides);
  const struct estimator estimator[] = {estimator_of("gaussian", "hachisuka", 0.7, 0.15),
                                        estimator_of("cone", "pbrt", 0.5, 0.1)};
  struct measurement measure = measure_of(&scene, estimator, 2);
  struct statistics statistics[2 * N_SOME];
  bookkeeping(&measure, PASSES, statistics, photon_map_new(&measure, &arena));
  struct local *local = local_new(&measure, &arena);
  double *frame = arena_new(&arena, double, photon_map_frame(&measure));
  local_begin(local, 1);
  local_see(local, 0);
  for (uint64_t i = 1; i <= PASSES; i++) local_pass(local, i, frame);
  for (int k = 0; k < 2 * N_SOME; k++) {
    assert_true(statistics[k].n > 0);
    near(local->field[ON_SURFACE].rd[k], statistics[k].r2, 1e-13);
    near(local->field[ON_SURFACE].n[k], statistics[k].n, 1e-13);
  }
}

// ---- whose photons count ----

static void light_from_the_other_side_neither_contributes_nor_shrinks_the_radius(void **state) {
  (void)state;
  struct scene scene = scene_of(below);
  const struct estimator estimator[] = {estimator_of("box", "hachisuka", 2.0 / 3, 0.2),
                                        estimator_of("epanechnikov", "pbrt", 0.5, 0.1)};
  struct measurement measure = measure_of(&scene, estimator, 2);
  struct local *local = local_new(&measure, &arena);
  double *frame = arena_new(&arena, double, photon_map_frame(&measure));
  local_begin(local, 1);
  for (uint64_t i = 1; i <= 1000; i++) {
    local_see(local, i);
    local_pass(local, i, frame);
    assert_true(local->map->field[ON_SURFACE].photons.count > 100);
    for (long k = 0; k < photon_map_frame(&measure); k++) assert_true(frame[k] == 0);
  }
  for (int k = 0; k < 2 * N_SOME; k++) {
    assert_true(local->field[ON_SURFACE].n[k] == 0);
    assert_true(local->field[ON_SURFACE].rd[k] == estimator[k % 2].r1 * estimator[k % 2].r1);
  }
}

// Eyes that look past everything: no radius, no photon is asked for.
static void points_that_see_nothing_stay_dark(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Scale -1 1 1\nLookAt 0 0 4  0 0 8  0 1 0\nCamera \"perspective\"\n"
               "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
               "LightSource \"point\" \"point3 from\" [0 0 1]\nShape \"disk\"\n");
  const struct estimator estimator = estimator_of("box", "hachisuka", 0.5, 0.2);
  static const char *const names[] = {"ppm", "sppm"};
  for (int k = 0; k < 2; k++) {
    struct measurement measure = measure_of(&scene, &estimator, 1);
    double *average = average_of(names[k], &measure, 3);
    for (long j = 0; j < photon_map_frame(&measure); j++) assert_true(average[j] == 0);
  }
}

// ---- a point depends on itself alone ----

static void any_number_of_threads_gives_the_same_bits(void **state) {
  (void)state;
  struct scene scene = scene_of(two_sides);
  const struct estimator estimator[] = {estimator_of("box", "hachisuka", 2.0 / 3, 0.2),
                                        estimator_of("cone", "pbrt", 0.8, 0.6)};
  static const char *const names[] = {"ppm", "sppm"};
  for (int k = 0; k < 2; k++)
    for (int nee = 0; nee < 2; nee++) {
      struct measurement measure = measure_of(&scene, estimator, 2);
      measure.n_emitted = 5 * WALK_BATCH + 1234;
      measure.footprint = true, measure.nee = nee, measure.hit_points = 3;
      double *one = average_of(names[k], &measure, 4);
      static const int threads[] = {2, 3, 7};
      for (int t = 0; t < 3; t++) {
        measure.threads = threads[t];
        double *many = average_of(names[k], &measure, 4);
        assert_memory_equal(many, one, (size_t)photon_map_frame(&measure) * sizeof *one);
      }
    }
}

// Six pixels, and the 64 of the film: the others' radii change no bit.
static void a_probe_is_the_pixel_of_the_film(void **state) {
  (void)state;
  struct scene scene = scene_of(two_sides);
  struct estimator estimator = estimator_of("quintic", "hachisuka", 0.4, 0.3);
  struct pixel film[64];
  for (int j = 0; j < 64; j++) film[j] = (struct pixel){j % 8, j / 8};
  static const char *const names[] = {"ppm", "sppm"};
  for (int k = 0; k < 2; k++) {
    struct measurement measure = measure_of(&scene, &estimator, 1);
    int n_channels = measure.features.n_channels;
    measure.footprint = true, measure.hit_points = 2;
    double *probes = average_of(names[k], &measure, 30);
    measure.pixel = film, measure.n_points = 64;
    double *all = average_of(names[k], &measure, 30);
    for (int p = 0; p < N_SOME; p++)
      for (int c = 0; c < n_channels; c++)
        assert_true(probes[p * n_channels + c] ==
                    all[(some[p].y * 8 + some[p].x) * n_channels + c]);
  }
}

// The picture is the mean of one run's iterations in order, by any number of threads.
static void render_takes_iterations_that_depend_on_each_other(void **state) {
  (void)state;
  struct scene scene = scene_of(two_sides);
  struct estimator estimator = estimator_of("box", "hachisuka", 0.4, 0.3);
  struct pixel film[64];
  for (int j = 0; j < 64; j++) film[j] = (struct pixel){j % 8, j / 8};
  struct measurement measure = measure_of(&scene, &estimator, 1);
  measure.pixel = film, measure.n_points = 64;
  double *mean = average_of("ppm", &measure, 10);
  struct image one, three;
  struct run_options options = {.threads = 1, .quiet = true};
  assert_true(render_image(integrator_find("ppm"), &measure, 10, options, &arena, &one));
  options.threads = 3;
  assert_true(render_image(integrator_find("ppm"), &measure, 10, options, &arena, &three));
  for (int c = 0; c < 3; c++) {
    assert_memory_equal(one.plane[c], three.plane[c], 64 * sizeof *one.plane[c]);
    for (int j = 0; j < 64; j++) near(one.plane[c][j], mean[3 * j + c], FLT_EPSILON);
  }
}

// With a law that follows i alone nothing is left of the local statistics. The grids differ, and
// with them the order of the sums: 1e-13.
static void with_a_global_law_they_are_probabilistic(void **state) {
  (void)state;
  struct scene scene = scene_of(two_sides);
  const struct estimator estimator[] = {estimator_of("box", "knaus-zwicker", 0.5, 0.2),
                                        estimator_of("gaussian", "smallvcm", 0.75, 0.4)};
  struct measurement measure = measure_of(&scene, estimator, 2);
  measure.nee = true;
  double *want = average_of("probabilistic", &measure, 20);
  static const char *const names[] = {"ppm", "sppm"};
  for (int k = 0; k < 2; k++) {
    double *got = average_of(names[k], &measure, 20);
    for (long j = 0; j < photon_map_frame(&measure); j++) near(got[j], want[j], 1e-13);
  }
}

// ---- hit points ----

static void hit_points_are_spread_over_the_pixel(void **state) {
  (void)state;
  struct scene scene = scene_of(below);
  struct estimator estimator = estimator_of("box", "hachisuka", 0.5, 0.2);
  struct measurement measure = measure_of(&scene, &estimator, 1);
  struct pixel pixel[4] = {{4, 4}, {4, 4}, {4, 4}, {4, 4}};
  measure.footprint = true, measure.pixel = pixel, measure.n_points = 4;
  struct local *local = local_new(&measure, &arena);
  local->map->sets = 4;
  local_begin(local, 1);
  local_see(local, 0);
  // The pixel is 4 tan 15 degrees / 4 wide, with its lower left corner on the axis.
  double width = tan(pi / 12);
  for (int k = 0; k < 4; k++) {
    struct vec p = local->map->point[k].p;
    assert_true(fabs(p.x) < width && fabs(p.y) < width);
    for (int l = 0; l < k; l++) {
      struct vec d = vec_sub(p, local->map->point[l].p);
      assert_true(vec_dot(d, d) > 1e-6);
    }
  }
}

// Where nothing is random, the hit points of a pixel are the same point and have the same
// statistics.
static void the_mean_of_equal_hit_points_is_one_of_them(void **state) {
  (void)state;
  struct scene scene = scene_of(two_sides);
  const struct estimator estimator[] = {estimator_of("box", "hachisuka", 0.5, 0.2),
                                        estimator_of("cone", "pbrt", 0.5, 0.3)};
  struct measurement measure = measure_of(&scene, estimator, 2);
  double *one = average_of("ppm", &measure, 10);
  measure.hit_points = 4;
  double *four = average_of("ppm", &measure, 10);
  for (long j = 0; j < photon_map_frame(&measure); j++) assert_true(one[j] == four[j]);
}

// ---- what is refused ----

static struct cell cell_of(const char *integrator, const char *law, double alpha) {
  return (struct cell){.integrator = integrator_find(integrator),
                       .law = law_find(law),
                       .kernel = kernel_find("box"),
                       .alpha = alpha,
                       .radius = 0.1,
                       .reference_radius = &reference_radii[0],
                       .footprint = true,
                       .photons = 100,
                       .iterations = 10,
                       .hit_points = 1};
}

static void assert_planned(const struct scene *scene, struct cell cell, const char *expected) {
  struct problem problem = {0};
  struct estimator estimator;
  bool planned = plan_estimator(&cell, scene, &estimator, &problem);
  if (expected ? planned || !strstr(problem.text, expected) : !planned)
    fail_msg("%s, %s: %s", cell.integrator->name, cell.law->name, problem.text);
}

static void combinations_that_make_no_sense_are_refused(void **state) {
  (void)state;
  struct scene scene = scene_of(below);
  for (int t = 0; integrator_types[t]; t++)
    for (int l = 0; l < n_laws; l++) {
      const struct integrator_type *type = integrator_types[t];
      bool apart = type->photons && type->independent && laws[l].count;
      assert_planned(&scene, cell_of(type->name, laws[l].name, 0.5),
                     apart ? "follows the photons found by the iterations before" : NULL);
    }
  assert_planned(&scene, cell_of("ppm", "pbrt", 0), "law pbrt at alpha = 0: the second radius is");
  assert_planned(&scene, cell_of("sppm", "hachisuka", 0), NULL);
  struct cell many = cell_of("ppm", "hachisuka", 0.5);
  many.hit_points = UINT64_C(1) << 40;
  assert_planned(&scene, many, "hit-points: 1099511627776 in each of 8 x 8 pixels are too many");
}

static void ppm_is_refused_where_something_moves(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"
      "ActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\nShape \"sphere\"\n");
  assert_true(scene_features(&scene).motion);
  assert_planned(&scene, cell_of("ppm", "hachisuka", 0.5), "something moves");
  assert_planned(&scene, cell_of("sppm", "hachisuka", 0.5), NULL);
}

static void what_knows_no_media_is_refused_where_there_are_some(void **state) {
  (void)state;
  struct scene scene = scene_of(
      "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
      "MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"\n");
  struct cell nearest = cell_of("photonmap", "fixed", 1),
              local = cell_of("probabilistic", "fixed", 1);
  assert_planned(&scene, nearest, NULL);
  assert_planned(&scene, local, NULL);
  nearest.k = 10;
  assert_planned(&scene, nearest, "participating media, and `k` (the nearest photons) finds radii");
  for (int k = 1; k < n_reference_radii; k++) {
    local.reference_radius = &reference_radii[k];
    assert_planned(&scene, local, "finds radii on surfaces only");
  }
  assert_planned(&scene, cell_of("light", "fixed", 1), "light connects surfaces only");
  assert_planned(&scene, cell_of("ppm", "hachisuka", 0.5), "take sppm or probabilistic");
  assert_planned(&scene, cell_of("path", "fixed", 1), NULL);
}

// Each test takes the memory from its start again.
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, NULL)
static struct arena whole;
static int begin(void **state) {
  (void)state;
  arena = whole;
  return 0;
}

int main(void) {
  whole = arena_reserve();
  const struct CMUnitTest tests[] = {
      TEST(the_flux_rule_is_the_average_of_the_passes),
      TEST(radii_and_counts_are_those_of_the_book),
      TEST(light_from_the_other_side_neither_contributes_nor_shrinks_the_radius),
      TEST(points_that_see_nothing_stay_dark),
      TEST(any_number_of_threads_gives_the_same_bits),
      TEST(a_probe_is_the_pixel_of_the_film),
      TEST(render_takes_iterations_that_depend_on_each_other),
      TEST(with_a_global_law_they_are_probabilistic),
      TEST(hit_points_are_spread_over_the_pixel),
      TEST(the_mean_of_equal_hit_points_is_one_of_them),
      TEST(combinations_that_make_no_sense_are_refused),
      TEST(ppm_is_refused_where_something_moves),
      TEST(what_knows_no_media_is_refused_where_there_are_some),
  };
  return cmocka_run_group_tests_name("local", tests, NULL, NULL);
}
