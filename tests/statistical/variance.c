// Random numbers used twice leave every mean right. The variance shows them: of an average over
// iterations, over runs, over pixels against that of its terms; and of one iteration against that
// of independent photons. Every integrator, through the runner and through render, on two threads.
//
// A ratio of variances is 1 within its standard error, sqrt(2 / degrees of freedom) and what
// kurtosis adds; numbers shared by two make it 2 (or 1 + the share of the variance they make), by
// all threads, runs or pixels much more. Level 1e-6 over all tests.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run/render.h"
#include "tests/unit/run_fixture.h"
#include "walk/walk.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

enum { TESTS = 50 }; // at most
static const double level = 1e-6 / TESTS, pi = 3.14159265358979323846;

static void say(const char *name, const char *what, double value, double se) {
  if (getenv("VARIANCE_VERBOSE")) print_message("%-14s %s: %.3f +- %.3f\n", name, what, value, se);
}

static void check_z(const char *what, const char *name, double value, double se) {
  say(name, what, value, se);
  if (!(fabs(value - 1) < se * gsl_cdf_ugaussian_Qinv(level / 2)))
    fail_msg("%s, %s: %g +- %g of what it should be", name, what, value, se);
}

// ---- runs, iterations, blocks of runs ----

// A plane under a disc light, in nine pixels.
#define FILM(side)                                                                                 \
  "LookAt 0 0 0.9167151165750396  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [90]\n"       \
  "Film \"rgb\" \"integer xresolution\" " side " \"integer yresolution\" " side                    \
  " PixelFilter \"box\"\nWorldBegin\n"                                                             \
  "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"trianglemesh\" \"integer "      \
  "indices\" [0 1 2 0 2 3] \"point3 P\" [-4 -4.1 0  4 -4.1 0  4 3.9 0  -4 3.9 0]\n"
#define LAMP                                                                                       \
  "AreaLightSource \"diffuse\" \"float power\" [1]\nMaterial \"diffuse\" \"rgb reflectance\" [0 "  \
  "0 0]\nTranslate 0 0 1\nRotate 180 1 0 0\nShape \"disk\" \"float radius\" [0.5]\n"
#define WIDE_BEAM                                                                                  \
  "LightSource \"beam\" \"point3 from\" [0 0 0.5] \"point3 to\" [0 0 0] \"string profile\" "       \
  "\"uniform\" \"float radius\" [2] \"float power\" [1]\n"

// Two blocks of 16 runs. With alpha 1 radii stay, so that iterations are independent and alike.
enum { RUNS = 32, ITERATIONS = 32, PROBES = 9 };

static struct results measured(const struct integrator_type *type) {
  write_text(path_in("lamp.pbrt"), FILM("3") LAMP);
  struct experiment experiment = experiment_of(
      type->name,
      arena_format(&arena,
                   "scene: %s\nintegrator: %s\n%sphotons: 200\npixel: %s\ndepth: 2\nreference: "
                   "none\nquantity: none\nseed: variance-%s\niterations: %d\nruns: %d\n",
                   path_in("lamp.pbrt"), type->name,
                   type->photons ? type->fixed ? "radius: 0.2\n" : "radius: 0.2\nalpha: 1\n" : "",
                   type->one_eye_pass ? "centre" : "footprint", type->name, ITERATIONS, RUNS));
  struct problem problem = {0};
  struct run_options options = {.threads = 2, .quiet = true};
  if (run_experiment(&experiment, path_in(type->name), options, &arena, &problem) != RUN_DONE)
    fail_msg("%s", problem.text);
  return results_of(path_in(type->name));
}

// Var(S^2) / sigma^4.
static double relative2(struct moments m) {
  double variance = moments_variance(m);
  return (m.m4 / m.n / (variance * variance) - 1) / m.n;
}

struct ratio {
  double sum, se2; // over probes
};

static void ratio_add(struct ratio *ratio, double value, double se2) {
  ratio->sum += value / PROBES;
  ratio->se2 += se2 / (PROBES * PROBES);
}

// The variance between averages of runs, and between averages of iterations, by that of single
// values.
static void add_probe(const struct series *series, struct ratio *of_runs,
                      struct ratio *of_iterations) {
  double single = 0, single_se2 = 0;
  struct moments means = {0}, average = series->average[series->n_checkpoints - 1];
  for (int j = 0; j < ITERATIONS; j++) {
    struct moments m = series->iteration[j];
    assert_true(m.n == RUNS && m.m2 > 0);
    single += moments_variance(m) / ITERATIONS;
    single_se2 += relative2(m) / (ITERATIONS * ITERATIONS);
    means = moments_merge(means, moments_of(m.mean));
  }
  ratio_add(of_runs, ITERATIONS * moments_variance(average) / single,
            2.0 / (RUNS - 1) + single_se2);
  ratio_add(of_iterations, RUNS * moments_variance(means) / single,
            2.0 / (ITERATIONS - 1) + single_se2);
}

// 31 degrees of freedom at each of 9 probes: standard error 0.085, and what is shared by two is
// found with probability 0.999. Shared by iterations it is in the runs' averages, by runs (also of
// different blocks, which are different threads') in the iterations'.
static void runs_and_iterations_are_independent(void **state) {
  (void)state;
  for (int k = 0; integrator_types[k]; k++) {
    const char *name = integrator_types[k]->name;
    struct results results = measured(integrator_types[k]);
    struct ratio of_runs = {0}, of_iterations = {0};
    assert_int_equal(results.n_series, PROBES);
    for (int p = 0; p < PROBES; p++) add_probe(&results.series[p], &of_runs, &of_iterations);
    check_z("averages of runs", name, of_runs.sum, sqrt(of_runs.se2));
    check_z("averages of iterations", name, of_iterations.sum, sqrt(of_iterations.se2));
  }
}

// ---- pixels, and the variance that render writes ----

static const struct scene *scene_of(const char *name, const char *text) {
  struct scene *scene = arena_new(&arena, struct scene, 1);
  struct problem problem = {0};
  write_text(path_in(name), text);
  if (!scene_read(path_in(name), &arena, scene, &problem)) fail_msg("%s", problem.text);
  return scene;
}

static struct measurement measure_film(const struct scene *scene,
                                       const struct estimator *estimator) {
  struct problem problem = {0};
  struct measurement measure = {.scene = scene,
                                .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                                .features = scene_features(scene),
                                .n_replicas = 1,
                                .depth = 1,
                                .estimator = estimator,
                                .n_estimators = 1};
  measure.pixel = plan_film(scene, &measure.n_points, &arena, &problem);
  assert_int_equal(measure.features.n_channels, 1);
  return measure;
}

static struct estimator estimator_for(const struct integrator_type *type, double r) {
  const char *law = !type->independent ? "hachisuka" : "fixed";
  return (struct estimator){
      .kernel = kernel_find("box"), .law = law_find(law), .alpha = 1, .r1 = r};
}

// A picture of `iterations` iterations by two threads: pixel j at plane[0][j], its variance at
// plane[3][j].
static struct image render(const struct integrator_type *type, struct measurement measure,
                           int number, uint64_t iterations, struct arena *scratch) {
  struct image image;
  struct run_options options = {.threads = 2, .quiet = true};
  measure.seed = rng_hash_name(arena_format(scratch, "variance %s %d", type->name, number));
  assert_true(render_image(type, &measure, iterations, options, scratch, &image));
  return image;
}

enum { PICTURES = 240, SIDE = 8, PIXELS = SIDE * SIDE };

// Over pictures: each pixel, the sum of all, and the sum of the variances that were written.
struct pictures {
  struct moments pixel[PIXELS], film;
  double written;
};

static void add_picture(struct pictures *pictures, const struct image *image) {
  double sum = 0;
  for (int j = 0; j < PIXELS; j++) {
    double value = (double)image->plane[0][j];
    sum += value;
    pictures->written += (double)image->plane[3][j] / PICTURES;
    pictures->pixel[j] = moments_merge(pictures->pixel[j], moments_of(value));
  }
  pictures->film = moments_merge(pictures->film, moments_of(sum));
}

static void check_pictures(const char *name, const struct pictures *pictures) {
  double among = 0, se2 = 0;
  for (int j = 0; j < PIXELS; j++) {
    double variance = moments_variance(pictures->pixel[j]);
    among += variance;
    se2 += variance * variance * relative2(pictures->pixel[j]);
  }
  // What is written comes from no more iterations than what is found among pictures.
  check_z("variance written", name, among / pictures->written, sqrt(2 * se2) / pictures->written);
  double ratio = moments_variance(pictures->film) / among;
  say(name, "sum of pixels", ratio, sqrt(2.0 / (PICTURES - 1)));
  if (!(gsl_cdf_chisq_Q((PICTURES - 1) * ratio, PICTURES - 1) > level))
    fail_msg("%s: the sum of all pixels has %g of the variance of its terms", name, ratio);
}

// Direct light by next-event estimation: every pixel has numbers of its own. (Those of light
// tracing share light paths, which hit one or the other: less than independent.) Standard errors
// are 0.09 and 0.02; that two threads compute the same iteration makes the second 2 or more.
static void pixels_are_independent(void **state) {
  (void)state;
  const struct scene *scene = scene_of("film.pbrt", FILM("8") LAMP);
  for (int k = 0; integrator_types[k]; k++) {
    const struct integrator_type *type = integrator_types[k];
    struct estimator estimator = estimator_for(type, 0.05);
    struct measurement measure = measure_film(scene, &estimator);
    struct pictures pictures = {0};
    measure.nee = true;
    measure.footprint = !type->one_eye_pass;
    measure.n_emitted = type->photons ? 1 : 100;
    for (int number = 0; number < PICTURES; number++) {
      struct arena scratch = arena;
      struct image image = render(type, measure, number, 4, &scratch);
      add_picture(&pictures, &image);
    }
    check_pictures(type->name, &pictures);
  }
}

// ---- photons ----

// A uniform beam of radius 2: the photons in a disc, or of light tracing in a pixel's square, are a
// binomial number of mean M p. Two batches of photons, by two threads where iterations are not
// shared out.
enum { BEAMS = 40, BEAM_PIXELS = 9, BEAM_ITERATIONS = 2, EMITTED = 2 * WALK_BATCH };
static const double beam_r = 0.15, beam_side = 2 * 0.9167151165750396 / 3;

static void check_beam(const struct integrator_type *type, const struct measurement *measure) {
  double beam = 4 * pi, truth = 0.5 / pi / beam;
  double p = (type->photons ? pi * beam_r * beam_r : beam_side * beam_side) / beam;
  double predicted = truth * truth * (1 - p) / (EMITTED * p) / BEAM_ITERATIONS;
  double variance = 0, mean = 0;
  struct moments pixel[BEAM_PIXELS] = {{0}};
  for (int number = 0; number < BEAMS; number++) {
    struct arena scratch = arena;
    struct image image = render(type, *measure, number, BEAM_ITERATIONS, &scratch);
    for (int j = 0; j < BEAM_PIXELS; j++)
      pixel[j] = moments_merge(pixel[j], moments_of((double)image.plane[0][j]));
  }
  for (int j = 0; j < BEAM_PIXELS; j++) {
    variance += moments_variance(pixel[j]) / predicted / BEAM_PIXELS;
    mean += pixel[j].mean / truth / BEAM_PIXELS;
  }
  check_z("variance by theory's", type->name, variance, sqrt(2.0 / (BEAMS - 1) / BEAM_PIXELS));
  check_z("mean by theory's", type->name, mean, sqrt(predicted / BEAM_PIXELS / BEAMS) / truth);
}

// Standard errors 0.075 and below 0.005.
static void photons_are_independent(void **state) {
  (void)state;
  const struct scene *scene = scene_of("beam.pbrt", FILM("3") WIDE_BEAM);
  for (int k = 0; integrator_types[k]; k++) {
    if (!strcmp(integrator_types[k]->name, "path")) continue; // knows the beam exactly
    struct estimator estimator = estimator_for(integrator_types[k], beam_r);
    struct measurement measure = measure_film(scene, &estimator);
    measure.footprint = true;
    measure.n_emitted = EMITTED;
    check_beam(integrator_types[k], &measure);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(runs_and_iterations_are_independent),
      cmocka_unit_test(pixels_are_independent),
      cmocka_unit_test(photons_are_independent),
  };
  return cmocka_run_group_tests_name("variance", tests, make_folder, remove_folder);
}
