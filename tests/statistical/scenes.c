// Every scene of scenes/ by every integrator that takes it, on a film of 8 pixels across: photon
// rows against each other at one radius, which has the same bias for all; photons extrapolated to
// radius zero against path tracing; light tracing against path tracing where nothing mirrors.
// Light that is seen directly is left out: it would drown the rest. The film and its quadrants,
// Welch's t, level 1e-6 over all tests; and the p-values of the films, which are nearly
// independent, are uniform. SCENES_VERBOSE=1 says how well each is known: an error of 9 standard
// errors is found with probability 0.95. That is 11 % between photon rows, 5 % of light tracing and
// 27 % of paths against radius zero in the median film; the test of conformance does better with
// more time.
#include "estimate/reference_radius.h"
#include "experiment/experiment.h"
#include "moments/moments.h"
#include "run/plan.h"
#include "tests/p_values.h"
#include "walk/light_path.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <glob.h>
#include <gsl/gsl_cdf.h>
#include <stdlib.h>
#include <string.h>

enum { ACROSS = 8, REGIONS = 5, RADII = 3, ROWS = 16, RUNS = 40, PER_RUN = 2, TESTS = 1500 };
static const double level = 1e-6 / TESTS;
static struct p_values p_values;

// A scene, its film made coarse.
struct subject {
  const char *name;
  struct scene scene;
  struct measurement measure;
  struct estimator estimator[RADII];
  double radius;
};

static void make_coarse(struct camera *camera) {
  int height = (camera->full_height * ACROSS + camera->full_width / 2) / camera->full_width;
  camera->full_width = camera->width = ACROSS;
  camera->full_height = camera->height = height > 2 ? height : 2;
  camera->crop_x = camera->crop_y = 0;
}

// Of what the film shows, twice the distance between the points that are seen at 1/4 and 3/4 of it;
// of fog without end, of those at a distance of 1.
static double picture_width(const struct scene *scene, const struct bvh *bvh) {
  struct vec p[2];
  for (int k = 0; k < 2; k++) {
    double x = scene->camera.width * (0.25 + 0.5 * k), y = 0.6 * scene->camera.height;
    struct ray ray = camera_ray(&scene->camera, x, y, (double[]){0, 0});
    struct hit hit;
    bvh_closest(bvh, &ray, &hit, 1);
    bool met = hit.primitive != PRIMITIVE_NONE;
    assert_true(met || scene->camera_medium != MEDIUM_NONE);
    p[k] = vec_along(ray.o, ray.d, met ? hit.t : 1);
  }
  return 2 * vec_length(vec_sub(p[1], p[0]));
}

static void subject_load(const char *path, struct arena *arena, struct subject *out) {
  struct problem problem = {0};
  *out = (struct subject){.name = strrchr(path, '/') + 1};
  if (!scene_read(path, arena, &out->scene, &problem)) fail_msg("%s", problem.text);
  make_coarse(&out->scene.camera);
  out->measure = (struct measurement){.scene = &out->scene,
                                      .bvh = bvh_build(&out->scene, (struct bvh_options){0}, arena),
                                      .features = scene_features(&out->scene),
                                      .n_replicas = 1,
                                      .footprint = true,
                                      .depth = 12,
                                      .left_out = LIGHT_PATH_EMITTED, // it would drown the rest
                                      .n_emitted = 500,
                                      .estimator = out->estimator,
                                      .n_estimators = 1};
  out->measure.pixel = plan_film(&out->scene, &out->measure.n_points, arena, &problem);
  out->radius = picture_width(&out->scene, out->measure.bvh) / 12;
}

// False: the integrator refuses the scene.
static bool takes(struct subject *subject, const struct integrator_type *type) {
  const char *law = !type->independent ? "hachisuka" : type->fixed ? "fixed" : "knaus-zwicker";
  struct cell cell = {.integrator = type, .kernel = kernel_find("epanechnikov"), .alpha = 1};
  struct problem problem = {0};
  cell.reference_radius = &reference_radii[0];
  cell.law = law_find(law), cell.radius = subject->radius, cell.iterations = PER_RUN;
  cell.photons = subject->measure.n_emitted, cell.footprint = true;
  for (int e = 0; e < RADII; e++) {
    if (!plan_estimator(&cell, &subject->scene, &subject->estimator[e], &problem)) return false;
    cell.radius /= 2;
  }
  return true;
}

// ---- means of regions ----

struct estimate {
  double mean, se2, freedom;
};

struct means {
  struct moments at[REGIONS];
};

static struct estimate estimate_of(struct moments m) {
  return (struct estimate){m.mean, moments_se2(m), m.n - 1};
}

// Sums over the film and its quadrants, all channels.
static void add_frame(const struct subject *subject, const double *frame, double weight,
                      double sum[REGIONS]) {
  const struct camera *camera = &subject->scene.camera;
  int n_channels = subject->measure.features.n_channels;
  for (int j = 0; j < subject->measure.n_points; j++) {
    int x = j % camera->width, y = j / camera->width;
    int quadrant = 1 + 2 * (2 * y >= camera->height) + (2 * x >= camera->width);
    for (int c = 0; c < n_channels; c++) {
      sum[0] += weight * frame[j * n_channels + c];
      sum[quadrant] += weight * frame[j * n_channels + c];
    }
  }
}

// Over runs of a few iterations: each radius, and the three extrapolated to zero (weights of
// Lagrange at r, r / 2, r / 4).
static void measure(const struct subject *subject, const struct integrator_type *type, int n_radii,
                    int runs, int per_run, struct means out[RADII + 1], struct arena scratch) {
  static const double weight[RADII] = {1.0 / 3, -2, 8.0 / 3};
  struct measurement on = subject->measure;
  long size = (long)on.n_points * on.features.n_channels;
  double *frame = arena_new(&scratch, double, n_radii *size);
  on.n_estimators = n_radii;
  on.seed = rng_hash_name(arena_format(&scratch, "scenes %s %s", subject->name, type->name));
  memset(out, 0, (RADII + 1) * sizeof *out);
  void *state = type->create(&on, &scratch);
  for (int run = 1; run <= runs; run++) {
    double sum[RADII + 1][REGIONS] = {{0}};
    type->begin(state, (uint64_t)run);
    for (int i = 1; i <= per_run; i++) {
      type->step(state, (uint64_t)i, frame);
      for (int e = 0; e < n_radii; e++) {
        add_frame(subject, frame + e * size, 1.0 / per_run, sum[e]);
        add_frame(subject, frame + e * size, weight[e] / per_run, sum[RADII]);
      }
    }
    for (int e = 0; e <= RADII; e++)
      for (int r = 0; r < REGIONS; r++)
        out[e].at[r] = moments_merge(out[e].at[r], moments_of(sum[e][r]));
  }
}

// Of equally many measurements each; Satterthwaite's degrees of freedom.
static struct estimate mean_of(const struct estimate *estimate, int n) {
  struct estimate out = {0};
  double fourth = 0;
  for (int k = 0; k < n; k++) {
    out.mean += estimate[k].mean / n;
    out.se2 += estimate[k].se2 / n / n;
    fourth += pow(estimate[k].se2 / n / n, 2) / estimate[k].freedom;
  }
  out.freedom = fourth > 0 ? out.se2 * out.se2 / fourth : 1;
  return out;
}

static void compare(const struct subject *subject, const char *what, const char *row, int region,
                    struct estimate a, struct estimate b) {
  double se2 = a.se2 + b.se2;
  if (a.mean == 0 && b.mean == 0) return;                   // dark
  if (se2 == 0 || fabs(a.mean - b.mean) <= 1e-9 * b.mean) { // both exact: closed rooms, beams
    assert_true(fabs(a.mean - b.mean) <= 1e-9 * b.mean);
    return;
  }
  double freedom = se2 * se2 / (a.se2 * a.se2 / a.freedom + b.se2 * b.se2 / b.freedom);
  double t = (a.mean - b.mean) / sqrt(se2), p = 2 * gsl_cdf_tdist_Q(fabs(t), freedom);
  if (getenv("SCENES_VERBOSE"))
    print_message("%-28s %-8s %-14s %d: %8.4f +- %.4f, t %6.2f\n", subject->name, what, row, region,
                  a.mean / b.mean, sqrt(se2) / b.mean, t);
  if (region == 0) p_values_add(&p_values, p);
  if (!(p >= level))
    fail_msg("%s, %s: %s is %.4f +- %.4f of the others in region %d, t = %.1f", subject->name, what,
             row, a.mean / b.mean, sqrt(se2) / b.mean, region, t);
}

// ---- photons ----

struct rows {
  int n;
  const char *name[ROWS];
  struct means of[ROWS][RADII + 1];
};

static void measure_photons(struct subject *subject, struct rows *rows, struct arena scratch) {
  for (int k = 0; integrator_types[k]; k++) {
    if (!integrator_types[k]->photons || !takes(subject, integrator_types[k])) continue;
    assert_true(rows->n < ROWS);
    rows->name[rows->n] = integrator_types[k]->name;
    measure(subject, integrator_types[k], RADII, RUNS, PER_RUN, rows->of[rows->n++], scratch);
  }
}

// Each row against the mean of all others, at the largest radius.
static void compare_photons(const struct subject *subject, const struct rows *rows) {
  for (int k = 0; k < rows->n; k++)
    for (int r = 0; r < REGIONS; r++) {
      struct estimate others[ROWS];
      int n = 0;
      for (int o = 0; o < rows->n; o++)
        if (o != k) others[n++] = estimate_of(rows->of[o][0].at[r]);
      compare(subject, "photons", rows->name[k], r, estimate_of(rows->of[k][0].at[r]),
              mean_of(others, n));
    }
}

static struct estimate extrapolated(const struct rows *rows, int region) {
  struct estimate of[ROWS];
  for (int k = 0; k < rows->n; k++) of[k] = estimate_of(rows->of[k][RADII].at[region]);
  return mean_of(of, rows->n);
}

// ---- paths ----

// Light that next-event estimation never finds and that a path meets once in thousands: no number
// of samples that a test can afford has a variance.
static bool is_beyond_paths(const char *name) {
  return strstr(name, "torus-in-glass") == name || strstr(name, "mirror-sds") == name;
}

static bool is_diffuse(const struct scene *scene) {
  for (uint32_t s = 0; s < scene->n_shapes; s++)
    if (strcmp(scene->material[scene->shape[s].material].type->name, "diffuse")) return false;
  return true;
}

static void compare_paths(struct subject *subject, const struct rows *rows, struct arena scratch) {
  const struct integrator_type *path = integrator_find("path"), *light = integrator_find("light");
  struct means paths[RADII + 1], lights[RADII + 1];
  measure(subject, path, 1, RUNS, 24, paths, scratch);
  for (int r = 0; r < REGIONS; r++)
    compare(subject, "zero", "path", r, estimate_of(paths[0].at[r]), extrapolated(rows, r));
  if (!is_diffuse(&subject->scene) || !takes(subject, light)) return;
  measure(subject, light, 1, RUNS, 4, lights, scratch);
  for (int r = 0; r < REGIONS; r++)
    compare(subject, "paths", "light", r, estimate_of(lights[0].at[r]),
            estimate_of(paths[0].at[r]));
}

static void all_integrators_agree_on_all_scenes(void **state) {
  (void)state;
  glob_t found;
  assert_int_equal(glob("scenes/*.pbrt", 0, NULL, &found), 0);
  for (size_t k = 0; k < found.gl_pathc; k++) {
    struct arena arena = arena_reserve(), kept = arena;
    struct subject *subject = arena_new(&arena, struct subject, 1);
    struct rows *rows = arena_new(&arena, struct rows, 1);
    subject_load(found.gl_pathv[k], &arena, subject);
    measure_photons(subject, rows, arena);
    compare_photons(subject, rows);
    if (!is_beyond_paths(subject->name)) compare_paths(subject, rows, arena);
    arena_release(kept);
  }
  globfree(&found);
}

static void p_values_are_uniform(void **state) {
  (void)state;
  assert_p_uniform(&p_values, 120);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_integrators_agree_on_all_scenes),
      cmocka_unit_test(p_values_are_uniform),
  };
  return cmocka_run_group_tests_name("scenes", tests, NULL, NULL);
}
