// Integrators against each other and against theory, on the same machinery as the box: pixels of a
// rendered picture, probes of an experiment, a plane in two triangles or in a thousand.
#include "estimate/reference_radius.h"
#include "log/results.h"
#include "moments/moments.h"
#include "numeric/rng.h"
#include "run/plan.h"
#include "run/render.h"
#include "scene/reader.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

static struct arena arena;

static const struct scene *scene_load(const char *path) {
  struct scene *scene = arena_new(&arena, struct scene, 1);
  struct problem problem = {0};
  if (!scene_read(path, &arena, scene, &problem)) fail_msg("%s", problem.text);
  return scene;
}

static struct estimator estimator_of(const char *kernel, double alpha, double r1) {
  return (struct estimator){
      .kernel = kernel_find(kernel), .law = law_find("knaus-zwicker"), .alpha = alpha, .r1 = r1};
}

static struct measurement measure(const struct scene *scene, const struct pixel *pixel, int n,
                                  const struct estimator *estimator, int n_estimators) {
  return (struct measurement){.scene = scene,
                              .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                              .features = scene_features(scene),
                              .pixel = pixel,
                              .n_points = n,
                              .n_replicas = 1,
                              .depth = 64,
                              .n_emitted = 250,
                              .seed = rng_hash_name("integrators"),
                              .estimator = estimator,
                              .n_estimators = n_estimators};
}

// Moments over iterations first .. first + count - 1 of every number of the frame.
static struct moments *moments_over(const char *name, const struct measurement *measure,
                                    uint64_t first, uint64_t count) {
  const struct integrator_type *integrator = integrator_find(name);
  long size = (long)measure->n_estimators * measure->n_points * measure->features.n_channels;
  double *frame = arena_new(&arena, double, size);
  struct moments *out = arena_new(&arena, struct moments, size);
  void *state = integrator->create(measure, &arena);
  integrator->begin(state, 1);
  for (uint64_t i = first; i < first + count; i++) {
    integrator->step(state, i, frame);
    for (long k = 0; k < size; k++) out[k] = moments_merge(out[k], moments_of(frame[k]));
  }
  return out;
}

static double z_of(struct moments a, struct moments b) {
  return (a.mean - b.mean) / sqrt(moments_se2(a) + moments_se2(b));
}

// The quadratic beam's scene turned as a whole, its plane split into 1,000 triangles, whose
// vertices are rounded to float and so are no longer quite coplanar.
static const struct scene *scene_turned(void) {
  char *text = arena_format(
      &arena,
      "LookAt 0 0 4.288307454867612  0 0 0  0 1 0\nRotate -37 1 2 3\n"
      "Camera \"perspective\" \"float fov\" [30]\nFilm \"rgb\" \"integer xresolution\" [65] "
      "\"integer yresolution\" [65]\nPixelFilter \"box\"\nWorldBegin\nRotate 37 1 2 3\n"
      "LightSource \"beam\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"string profile\" "
      "\"quadratic\" \"float radius\" [1] \"float power\" [1]\n"
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"trianglemesh\" \"point3 P\" "
      "[");
  for (int k = 0; k < 26 * 21; k++)
    text = arena_format(&arena, "%s %g %g 0", text, -4 + 0.32 * (k % 26), -4 + 0.42 * (k / 26));
  text = arena_format(&arena, "%s] \"integer indices\" [", text);
  for (int k = 0; k < 25 * 20; k++) {
    int a = k % 25 + 26 * (k / 25);
    text = arena_format(&arena, "%s %d %d %d %d %d %d", text, a, a + 1, a + 27, a, a + 27, a + 26);
  }
  text = arena_format(&arena, "%s]\n", text);
  struct scene *scene = arena_new(&arena, struct scene, 1);
  struct problem problem = {0};
  struct text file = {text, (ptrdiff_t)strlen(text)};
  struct arena lists = arena_reserve(), scratch = arena_reserve();
  if (!scene_read_text("turned.pbrt", NULL, file, &arena, lists, scratch, scene, &problem))
    fail_msg("%s", problem.text);
  arena_release(lists);
  arena_release(scratch);
  return scene;
}

// Level 1e-5 each (|z| < 4.4). 20000 iterations of 250 photons: the mean's standard error is 0.1 %
// of the mean, the variance's 1 %, so 0.6 % and 6 % are found with probability 0.95.
static void a_tilted_plane_of_a_thousand_triangles_has_the_same_statistics(void **state) {
  (void)state;
  struct pixel centre = {32, 32};
  struct estimator estimator = estimator_of("box", 1, 0.5);
  const struct scene *flat = scene_load("scenes/plane-quadratic-beam.pbrt");
  const struct scene *tilted = scene_turned();
  assert_int_equal(tilted->n_triangles, 1000);
  struct measurement on_flat = measure(flat, &centre, 1, &estimator, 1);
  struct measurement on_tilted = measure(tilted, &centre, 1, &estimator, 1);
  on_tilted.seed++; // independent of the other
  struct moments a = moments_over("probabilistic", &on_flat, 1, 20000)[0];
  struct moments b = moments_over("probabilistic", &on_tilted, 1, 20000)[0];
  assert_true(fabs(z_of(a, b)) < 4.4);
  double va = moments_variance(a), vb = moments_variance(b);
  // Var(S^2) / sigma^4 = (2 + excess kurtosis) / n.
  double relative2 = (a.m4 / a.n / (va * va) - 1) / a.n + (b.m4 / b.n / (vb * vb) - 1) / b.n;
  assert_true(fabs(va / vb - 1) / sqrt(relative2) < 4.4);
}

// The quadratic beam with a box of radius r: mean E (1 - r^2 / 2) rho / pi, exactly.
static void the_mean_of_an_iteration_is_theorys(void **state) {
  (void)state;
  struct pixel centre = {32, 32};
  struct estimator estimator[2] = {estimator_of("box", 1, 0.5),
                                   estimator_of("epanechnikov", 1, 0.5)};
  const struct scene *scene = scene_load("scenes/plane-quadratic-beam.pbrt");
  struct measurement on = measure(scene, &centre, 1, estimator, 2);
  struct moments *m = moments_over("probabilistic", &on, 1, 20000);
  const double pi = 3.14159265358979323846, mu2[2] = {1.0 / 4, 1.0 / 6};
  for (int e = 0; e < 2; e++) {
    double truth = 0.5 / pi * (2 / pi - 8 / pi * mu2[e] * 0.25 / 2);
    assert_true(fabs((m[e].mean - truth) / sqrt(moments_se2(m[e]))) < 4.4);
  }
}

// Three radii on the same photons, m0 + m1 r + m2 r^2 through them: m0 is unbiased where the disc
// meets nothing. 9 pixels, level 1e-5 over all of them; standard errors about 1 %, so 5 % is found.
static void photons_extrapolated_to_radius_zero_agree_with_path_tracing(void **state) {
  (void)state;
  const struct scene *scene = scene_load("scenes/cornell-box.pbrt");
  const struct pixel pixel[] = {{20, 60}, {8, 58},  {32, 20}, {20, 16}, {44, 18},
                                {4, 30},  {60, 30}, {30, 14}, {16, 3}};
  enum { N = sizeof pixel / sizeof *pixel };
  double r = 0.16;
  struct estimator estimator[3] = {estimator_of("epanechnikov", 1, r),
                                   estimator_of("epanechnikov", 1, r / 2),
                                   estimator_of("epanechnikov", 1, r / 4)};
  struct measurement photons = measure(scene, pixel, N, estimator, 3);
  photons.n_emitted = 20000;
  struct measurement paths = measure(scene, pixel, N, estimator, 1);
  struct moments *truth = moments_over("path", &paths, 1, 30000);
  for (int nee = 0; nee < 2; nee++) {
    photons.nee = nee;
    struct moments m0[N] = {{0}};
    const struct integrator_type *integrator = integrator_find("probabilistic");
    void *run = integrator->create(&photons, &arena);
    integrator->begin(run, 2);
    for (uint64_t i = 1; i <= 150; i++) {
      double frame[3][N];
      integrator->step(run, i, frame[0]);
      // Lagrange weights at 0 of r, r/2, r/4: 1/3, -2, 8/3.
      for (int p = 0; p < N; p++)
        m0[p] = moments_merge(m0[p],
                              moments_of(frame[0][p] / 3 - 2 * frame[1][p] + 8 * frame[2][p] / 3));
    }
    for (int p = 0; p < N; p++)
      if (fabs(z_of(m0[p], truth[p])) > 4.9)
        fail_msg("pixel %d,%d: photons %g, paths %g, z %g", pixel[p].x, pixel[p].y, m0[p].mean,
                 truth[p].mean, z_of(m0[p], truth[p]));
  }
}

// A closed room whose walls all emit L and reflect rho: L / (1 - rho) everywhere.
static void a_white_furnace_is_uniform(void **state) {
  (void)state;
  const struct scene *scene = scene_load("scenes/white-furnace.pbrt");
  const struct pixel pixel[] = {{3, 5}, {30, 31}};
  struct estimator estimator = estimator_of("box", 1, 0.2);
  struct measurement on = measure(scene, pixel, 2, &estimator, 1);
  struct moments *path = moments_over("path", &on, 1, 20000);
  for (int p = 0; p < 2; p++)
    assert_true(fabs(path[p].mean - 1) < 4.4 * sqrt(moments_se2(path[p])) + 1e-12);
}

// The same pixel: a probe of a few points, and the picture of the whole film; with every reference
// radius, which may differ from point to point.
static void a_probe_is_the_pixel_that_render_gives(void **state) {
  (void)state;
  const struct scene *scene = scene_load("scenes/cornell-box.pbrt");
  int n = scene->camera.width * scene->camera.height;
  struct pixel *film = arena_new(&arena, struct pixel, n);
  for (int j = 0; j < n; j++)
    film[j] = (struct pixel){j % scene->camera.width, j / scene->camera.width};
  const struct pixel probe[2] = {{20, 60}, {32, 20}};
  const char *const names[] = {"path", "photonmap", "probabilistic"};
  for (int k = 0; k < 2 + n_reference_radii; k++) {
    const char *name = names[k < 2 ? k : 2];
    struct estimator estimator = estimator_of("cone", 0.5, 0.2);
    if (k >= 2) estimator.reference = &reference_radii[k - 2];
    if (k >= 2 && !estimator.reference->global) estimator.r1 = 1;
    if (k == 1 || (k >= 2 && estimator.reference->nearest)) estimator.k = 7;
    struct measurement of_film = measure(scene, film, n, &estimator, 1);
    struct measurement of_probes = measure(scene, probe, 2, &estimator, 1);
    of_film.n_emitted = of_probes.n_emitted = 2000;
    struct image image;
    struct run_options options = {.threads = 2, .quiet = true};
    assert_true(render_image(integrator_find(name), &of_film, 1, options, &arena, &image));
    struct moments *values = moments_over(name, &of_probes, 1, 1);
    for (int p = 0; p < 2; p++) {
      assert_true(values[p].mean > 0);
      assert_true(image.plane[0][probe[p].y * image.width + probe[p].x] == (float)values[p].mean);
    }
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_tilted_plane_of_a_thousand_triangles_has_the_same_statistics),
      cmocka_unit_test(the_mean_of_an_iteration_is_theorys),
      cmocka_unit_test(photons_extrapolated_to_radius_zero_agree_with_path_tracing),
      cmocka_unit_test(a_white_furnace_is_uniform),
      cmocka_unit_test(a_probe_is_the_pixel_that_render_gives),
  };
  return cmocka_run_group_tests_name("integrators", tests, NULL, NULL);
}
