// Photon points in media against closed forms and against path tracing: every channel of a coloured
// fog, in which each iteration's mean over the pixels is one sample.
#include "../unit/scene_text.h"

#include "integrator/integrator.h"
#include "moments/moments.h"

static struct arena arena;
static const double pi = 3.14159265358979323846;

enum { PIXELS = 64, RADII = 3 };

// Means over the pixels, of each channel: at the radii given, and extrapolated to zero from three
// of them, 4 h, 2 h and h: what is linear or quadratic in r vanishes.
struct measured {
  struct moments at[RADII][3], limit[3];
};

static struct measured measure(const struct scene *scene, const char *name, int width, int depth,
                               uint64_t n_emitted, const double *radius, int n_radii,
                               uint64_t iterations) {
  static const double weight[RADII] = {1.0 / 3, -2, 8.0 / 3};
  struct pixel pixel[PIXELS];
  struct estimator estimator[RADII] = {{0}};
  for (int p = 0; p < PIXELS; p++) pixel[p] = (struct pixel){p % width, p / width};
  for (int e = 0; e < n_radii; e++)
    estimator[e] = (struct estimator){
        .kernel = kernel_find("box"), .law = law_find("fixed"), .alpha = 1, .r1 = radius[e]};
  struct measurement measurement = {.scene = scene,
                                    .bvh = bvh_build(scene, (struct bvh_options){0}, &arena),
                                    .features = scene_features(scene),
                                    .pixel = pixel,
                                    .n_points = PIXELS,
                                    .n_replicas = 1,
                                    .depth = depth,
                                    .n_emitted = n_emitted,
                                    .seed = rng_hash_name("volume points"),
                                    .estimator = estimator,
                                    .n_estimators = n_radii};
  const struct integrator_type *integrator = integrator_find(name);
  void *state = integrator->create(&measurement, &arena);
  double *frame = arena_new(&arena, double, RADII *PIXELS * 3);
  struct measured out = {0};
  integrator->begin(state, integrator->photons ? 1 : 2); // eyes of their own
  for (uint64_t i = 1; i <= iterations; i++) {
    double limit[3] = {0};
    integrator->step(state, i, frame);
    for (int e = 0; e < n_radii; e++)
      for (int c = 0; c < 3; c++) {
        double mean = 0;
        for (int p = 0; p < PIXELS; p++) mean += frame[(e * PIXELS + p) * 3 + c] / PIXELS;
        out.at[e][c] = moments_merge(out.at[e][c], moments_of(mean));
        limit[c] += weight[e] * mean;
      }
    for (int c = 0; c < 3; c++) out.limit[c] = moments_merge(out.limit[c], moments_of(limit[c]));
  }
  return out;
}

static void assert_mean(const char *what, int c, struct moments m, double truth, double truth_se2,
                        double share) {
  double se = sqrt(moments_se2(m) + truth_se2), z = (m.mean - truth) / se;
  assert_true(se < share * truth);
  if (!(fabs(z) < Z_LIMIT))
    fail_msg("%s, channel %d: %g, expected %g, se %g, z %.1f", what, c, m.mean, truth, se, z);
}

// ---- single scattering ----

static const double sigma_a[3] = {0.1, 0.4, 0.2}, sigma_s[3] = {0.6, 0.3, 0.7}, g = 0.4;
static const double beam = 0.5, away = 2, above = 2; // radius, and where eye and light are

// A beam of 1 W along -z through fog without end, and 64 eyes in a row above each other that look
// across it.
static const char beam_in_fog[] =
    "LookAt -2 0 0  0 0 0  0 1 0\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" 0.4\n"
    "\"rgb sigma_a\" [0.1 0.4 0.2] \"rgb sigma_s\" [0.6 0.3 0.7]\n"
    "MediumInterface \"\" \"fog\"\n"
    "Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\n"
    "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 1\nWorldBegin\n"
    "MediumInterface \"fog\" \"fog\"\n"
    "LightSource \"beam\" \"point3 from\" [0 0 2] \"point3 to\" [0 0 0]\n"
    "\"string profile\" \"uniform\" \"float radius\" 0.5 \"float power\" 1\n"
    "Translate 0 0 -90\nShape \"disk\"\n";

// Of the eye at height z, with the fluence averaged over a ball of radius r around every point of
// the ray, whose own extinction and scattering stay. In the beam the fluence is E0 e^(-sigma_t s)
// after s; a ray that passes its axis at distance y is within for 2 sqrt(a^2 - y^2). By midpoints
// in the ball (32 a side: 0.1 %).
static double single_scattering(int c, double z, double r) {
  enum { N = 32 };
  double sigma_t = sigma_a[c] + sigma_s[c], sum = 0;
  double phase = (1 - g * g) / (4 * pi * (1 + g * g) * sqrt(1 + g * g)); // at right angles
  int inside = 0;
  for (int k = 0; k < N * N * N; k++) {
    double dx = (2 * (k % N) + 1.0) / N - 1, dy = (2 * (k / N % N) + 1.0) / N - 1,
           dz = (2 * (k / N / N) + 1.0) / N - 1;
    if (dx * dx + dy * dy + dz * dz >= 1) continue;
    double half = sqrt(beam * beam - r * r * dy * dy), middle = away - r * dx;
    double along = exp(-sigma_t * (middle - half)) - exp(-sigma_t * (middle + half));
    sum += along / sigma_t * exp(-sigma_t * (above - z - r * dz));
    inside++;
  }
  return sigma_s[c] * phase / (pi * beam * beam) * sum / inside;
}

static double mean_single_scattering(int c, double r) {
  double sum = 0;
  for (int p = 0; p < PIXELS; p++) sum += single_scattering(c, (p + 0.5) / 32 - 1, r) / PIXELS;
  return sum;
}

// Photons at finite radii against the ball's exact mean, paths against the limit. Level 6e-7 each;
// one iteration's mean has a standard deviation of about 0.35, so 1500 know it to 1 % and 7 % is
// found: sigma_s for sigma_t at the photon's place is 17 to 133 % off, the constant of discs 33 %,
// r^2 for r^3 more than half.
static void a_beam_in_fog_scatters_its_closed_form(void **state) {
  (void)state;
  static const double radius[] = {0.4, 0.2};
  struct scene scene = scene_of(beam_in_fog);
  struct measured photons = measure(&scene, "probabilistic", 64, 1, 1000, radius, 2, 1500);
  struct measured paths = measure(&scene, "path", 64, 1, 1, radius, 1, 1500);
  for (int c = 0; c < 3; c++) {
    for (int e = 0; e < 2; e++)
      assert_mean("photons", c, photons.at[e][c], mean_single_scattering(c, radius[e]), 0, 0.015);
    assert_mean("paths", c, paths.at[0][c], mean_single_scattering(c, 0), 0, 0.015);
  }
}

// ---- all of the light ----

static const char box_of_fog[] =
    "LookAt 0 1 -0.9  0 0.9 0  0 1 0\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float g\" 0.5\n"
    "\"rgb sigma_a\" [0.05 0.1 0.2] \"rgb sigma_s\" [0.5 0.4 0.7]\n"
    "MediumInterface \"\" \"fog\"\n"
    "Camera \"perspective\" \"float fov\" 60\n"
    "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
    "MediumInterface \"fog\" \"fog\"\n"
    "Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
    " \"point3 P\" [-1 0 -1 1 0 -1 1 0 1 -1 0 1]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
    " \"point3 P\" [-1 0 1 1 0 1 1 2 1 -1 2 1]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
    " \"point3 P\" [-1 0 -1 -1 0 1 -1 2 1 -1 2 -1]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [8 6 7]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]"
    " \"point3 P\" [-0.5 1.9 -0.5 0.5 1.9 -0.5 0.5 1.9 0.5 -0.5 1.9 0.5]\n"
    "AttributeEnd\n";

// Points on the walls and in the fog add up to what paths measure, of up to three scatterings. Near
// the walls balls lack the photons behind them, so the bias is of order r, and three radii take it
// away up to r^3. Level 6e-7 each; 1600 iterations, of a standard deviation of 0.4 to 0.7, leave
// errors below 1.8 %, so 11 % is found in any channel: balls and discs bring about half each.
static void surfaces_and_fog_add_up_to_what_paths_measure(void **state) {
  (void)state;
  static const double radius[RADII] = {0.48, 0.24, 0.12};
  struct scene scene = scene_of(box_of_fog);
  struct measured photons = measure(&scene, "probabilistic", 8, 3, 2000, radius, RADII, 1600);
  struct measured paths = measure(&scene, "path", 8, 3, 1, radius, 1, 3000);
  for (int c = 0; c < 3; c++)
    assert_mean("both kinds", c, photons.limit[c], paths.at[0][c].mean, moments_se2(paths.at[0][c]),
                0.018);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_beam_in_fog_scatters_its_closed_form),
      cmocka_unit_test(surfaces_and_fog_add_up_to_what_paths_measure),
  };
  return cmocka_run_group_tests_name("volume points", tests, NULL, NULL);
}
