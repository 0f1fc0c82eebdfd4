// Exact mean, variance and kurtosis of one iteration against the closed forms of theory 5, and
// where there is no closed form to be had.
#define _GNU_SOURCE // mkstemp
#include "analysis/bias_family.h"
#include "analysis/curve.h"
#include "analysis/prediction.h"
#include "tests/light_fixture.h"
#include "tests/unit/predict_fixture.h"
#include "walk/light_path.h"

#include <math.h>

static struct arena arena;

static void assert_relative(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance * fabs(expected)))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

static struct profile profile_at(const struct scene *scene, const char *kernel, double x,
                                 double radius) {
  struct cell cell = cell_of(kernel, radius);
  struct probe probe = probe_at(x, 0);
  struct ring_mean ring;
  assert_true(ring_mean_find(scene, &cell, &probe, radius, arena, &ring));
  return profile_new(&ring, cell.kernel, radius);
}

static bool has_closed_form(const char *world, struct cell cell, struct probe probe) {
  struct scene scene = light_scene(world, &arena);
  struct ring_mean ring;
  return ring_mean_find(&scene, &cell, &probe, cell.radius, arena, &ring);
}

#define DOWN "\"point3 from\" [0 0 1] \"point3 to\" [0 0 0] "
#define UNIFORM                                                                                    \
  "LightSource \"beam\" " DOWN "\"float radius\" 1.7 \"float power\" 2.385" LIGHT_PLANE
#define QUADRATIC                                                                                  \
  "LightSource \"beam\" " DOWN                                                                     \
  "\"string profile\" \"quadratic\" \"float radius\" 1.7 \"float power\" 2.385" LIGHT_PLANE
#define GAUSSIAN                                                                                   \
  "LightSource \"beam\" " DOWN                                                                     \
  "\"string profile\" \"gaussian\" \"float sigma\" 0.7 \"float power\" 2.385" LIGHT_PLANE
static const double power = 2.385, beam_radius = 1.7;

// Var = (E^2 / N_e)(A R / r^2 - 1) and no bias, for every kernel; counts of the box are binomial.
static void test_uniform(void **state) {
  (void)state;
  struct scene scene = light_scene(UNIFORM, &arena);
  double area = pi * beam_radius * beam_radius, e = power / area;
  for (int k = 0; k < n_kernels; k++) {
    struct profile profile = profile_at(&scene, kernels[k].name, 0.3, 0.5);
    double roughness = kernels[k].constants(2).roughness;
    for (double r = 0.01; r < 0.5; r *= 2) {
      double mean = profile_moment(&profile, 1, r);
      assert_relative(mean, e, 1e-13);
      assert_relative(profile_moment(&profile, 2, r) - mean * mean,
                      e * e * (area * roughness / (r * r) - 1), 1e-11);
    }
    assert_relative(profile_roughness(&profile), e * e * area * roughness, 1e-11);
  }
}

static void test_kurtosis_is_binomial(void **state) {
  (void)state;
  struct scene scene = light_scene(UNIFORM, &arena);
  struct cell cell = cell_of("box", 1.3);
  struct probe probe = probe_at(0, 0);
  struct family_table table = family_table_new(cell.law, 50, &arena);
  struct family family = family_new(&table, cell.alpha, &arena);
  struct prediction theory = prediction_new(&scene, &cell, &probe, &family, &arena);
  assert_true(theory.closed_form);
  assert_true(theory.unbiased);
  for (int j = 0; j < 50; j++) {
    double p = 1.69 * family.rho[j] / (beam_radius * beam_radius), n = 1000, e = theory.truth;
    double variance = e * e * (1 - p) / (p * n);
    assert_relative(theory.divergent[j] + theory.rest[j], variance, 1e-12);
    // The binomial's zero, at p (1 - p) = 1/6, leaves only rounding to compare with.
    double kurtosis = (1 - 6 * p * (1 - p)) / (n * p * (1 - p));
    assert_true(fabs(theory.kurtosis[j] - kurtosis) <= 1e-12 * (1 + fabs(kurtosis)));
  }
}

// Bias is (mu_2 / 2) r^2 times the Laplacian -8 power / (pi a^4), exactly, for every kernel.
static void test_quadratic_beam(void **state) {
  (void)state;
  struct scene scene = light_scene(QUADRATIC, &arena);
  double laplacian = -8 * power / (pi * pow(beam_radius, 4));
  for (int k = 0; k < n_kernels; k++) {
    double mu2 = kernels[k].constants(2).mu2;
    struct profile profile = profile_at(&scene, kernels[k].name, 0.4, 1.1);
    for (double r = 0.01; r < 1.1; r *= 3)
      assert_relative(profile_bias(&profile, r), mu2 / 2 * r * r * laplacian, 1e-9);
  }
}

// The variance expands as R q / r^2 + R_2 / 4 times the Laplacian of q - mu^2 (theory 1.3), exactly
// but for mu^2 where q is quadratic.
static void test_variance_of_quadratic_beam(void **state) {
  (void)state;
  struct scene scene = light_scene(QUADRATIC, &arena);
  double a2 = beam_radius * beam_radius, centre = 2 * power / (pi * a2);
  double laplacian = -8 * power / (pi * a2 * a2);
  for (int k = 0; k < n_kernels; k++) {
    struct kernel_constants c = kernels[k].constants(2);
    struct profile profile = profile_at(&scene, kernels[k].name, 0, 0.9);
    for (double r = 0.05; r < 0.9; r *= 2) {
      double second = power * (c.roughness * centre / (r * r) + c.roughness2 / 4 * laplacian);
      assert_relative(profile_moment(&profile, 2, r), second, 1e-11);
    }
  }
}

static void test_gaussian_beam(void **state) {
  (void)state;
  struct scene scene = light_scene(GAUSSIAN, &arena);
  struct profile profile = profile_at(&scene, "box", 0, 1.4);
  for (double r = 0.1; r < 1.4; r += 0.2)
    assert_relative(profile_moment(&profile, 1, r),
                    power * -expm1(-r * r / (2 * 0.49)) / (pi * r * r), 1e-12);
}

#define POINT(text) "LightSource \"point\" " text "\"point3 from\" [0 0 1.3] " LIGHT_PLANE

// Isotropic: at the foot the box's mean is 2 h^2 (1 - h / sqrt(h^2 + r^2)) / r^2 of the irradiance.
static void test_isotropic_foot(void **state) {
  (void)state;
  struct scene scene = light_scene(POINT(""), &arena);
  struct profile profile = profile_at(&scene, "box", 0, 0.8);
  double h = 1.3;
  for (double r = 0.1; r < 0.8; r += 0.1) {
    double ratio = 2 * h * h * (1 - h / sqrt(h * h + r * r)) / (r * r);
    assert_relative(profile_moment(&profile, 1, r) / profile.exact, ratio, 1e-12);
  }
}

#define LAMBERTIAN POINT("\"string emission\" \"lambertian\" \"point3 to\" [0 0 0] ")

// A Lambertian point light at height h: the share of its power in a disc of radius r at distance
// rho from the foot (theory 5 ii).
static double lambertian_share(double h, double rho, double r) {
  double sum = rho * rho + h * h + r * r;
  return (1 - (sum - 2 * r * r) / sqrt(sum * sum - 4 * rho * rho * r * r)) / 2;
}

static void test_lambertian(void **state) {
  (void)state;
  struct scene scene = light_scene(LAMBERTIAN, &arena);
  double h = 1.3;
  for (double rho = 0; rho < 1.6; rho += 0.37) {
    struct profile profile = profile_at(&scene, "box", rho, 0.9);
    double share_density = h * h / (pi * pow(h * h + rho * rho, 2));
    for (double r = 0.2; r < 0.9; r += 0.1) {
      double mean = lambertian_share(h, rho, r) / (pi * r * r);
      assert_relative(profile_moment(&profile, 1, r) / profile.exact, mean / share_density, 1e-12);
      // A box's counts are binomial: every photon inside carries the same.
      assert_relative(profile_moment(&profile, 2, r),
                      profile_moment(&profile, 1, r) * profile.flux / (pi * r * r), 1e-12);
    }
  }
}

// At the foot the bias is -r^2 / (h^2 + r^2) of the irradiance, at the ring rho = h / sqrt(2) of
// order r^4.
static void test_lambertian_bias(void **state) {
  (void)state;
  struct scene scene = light_scene(LAMBERTIAN, &arena);
  struct profile foot = profile_at(&scene, "box", 0, 0.9);
  for (double r = 0.01; r < 0.9; r *= 2)
    assert_relative(profile_bias(&foot, r) / foot.exact, -r * r / (1.69 + r * r), 1e-9);
  struct profile ring = profile_at(&scene, "box", 1.3 / sqrt(2), 0.9);
  double wide = profile_bias(&ring, 0.08), narrow = profile_bias(&ring, 0.04);
  assert_relative(wide / narrow, 16, 0.05); // the next term is (r / h)^2 of it
}

// ---- averages ----

// The box's bias at the foot is -r^2 / (h^2 + r^2) of the light; at the ring it begins with r^4.
static void test_bias_terms(void **state) {
  (void)state;
  double second, fourth;
  struct scene scene = light_scene(LAMBERTIAN, &arena);
  struct profile foot = profile_at(&scene, "box", 0, 0.9);
  assert_true(profile_bias_terms(&foot, &second, &fourth));
  assert_relative(second / foot.exact, -1 / 1.69, 1e-9);
  assert_relative(fourth / foot.exact, 1 / (1.69 * 1.69), 1e-6);
  struct profile ring = profile_at(&scene, "box", 1.3 / sqrt(2), 0.9);
  assert_true(profile_bias_terms(&ring, &second, &fourth));
  assert_true(second == 0);
  assert_relative(fourth * pow(0.01, 4), profile_bias(&ring, 0.01), 1e-3); // (r / h)^2
  scene = light_scene(UNIFORM, &arena);
  struct profile uniform = profile_at(&scene, "box", 0.3, 0.5);
  assert_true(profile_bias_terms(&uniform, &second, &fourth));
  assert_true(second == 0 && fourth == 0);
}

// Theory 5 (ii) and 1.2: Laplacian -8/h^2, of it 192/h^4 at the foot, from the bias of any kernel.
static void test_light_of_bias(void **state) {
  (void)state;
  struct scene scene = light_scene(LAMBERTIAN, &arena);
  for (int k = 0; k < n_kernels; k++) {
    struct profile foot = profile_at(&scene, kernels[k].name, 0, 0.9);
    struct local_light light = {.mu = foot.exact};
    double second, fourth, r2 = 0.81;
    assert_true(profile_bias_terms(&foot, &second, &fourth));
    local_light_set_bias(&light, &kernels[k], 2, second * r2, fourth * r2 * r2);
    assert_relative(light.curvature, -8 / 1.69 * r2, 1e-9);
    assert_relative(light.bicurvature, 192 / (1.69 * 1.69) * r2 * r2, 1e-6);
  }
}

// A quadratic beam is its expansion: the curve of the model, from theory's density and Laplacian,
// is the one that is summed iteration by iteration. lambda = photons p pi r^2 with p = 2 (1 -
// rho^2/a^2) / (pi a^2); Laplacian / p = -4 / (a^2 - rho^2).
static void test_curve_is_that_of_the_model(void **state) {
  (void)state;
  const double r1 = 1.1, x = 0.4;
  struct scene scene = light_scene(QUADRATIC, &arena);
  struct probe probe = probe_at(x, 0);
  for (int k = 0; k < n_kernels; k++) {
    struct cell cell = cell_of(kernels[k].name, r1);
    struct family_table table = {.law = cell.law, .n = 300};
    struct family family = family_new(&table, cell.alpha, &arena);
    struct prediction theory = prediction_new(&scene, &cell, &probe, &family, &arena);
    double inside = beam_radius * beam_radius - x * x, a4 = pow(beam_radius, 4);
    struct local_light light = {.mu = theory.truth,
                                .photons = 1000,
                                .lambda = 1000 * 2 * inside / a4 * r1 * r1,
                                .curvature = -4 / inside * r1 * r1};
    assert_relative(theory.truth, power * 2 * inside / (pi * a4), 1e-12);
    struct model model = model_new(cell.law, cell.kernel, cell.alpha, 2, light);
    struct curve scenes = curve_of_prediction(&theory, &cell, &arena);
    struct curve models = curve_of_model(&model, r1, 300, &arena);
    assert_int_equal(scenes.n, models.n);
    for (int j = 0; j < models.n; j++) {
      const struct curve_point *s = &scenes.point[j], *m = &models.point[j];
      assert_true(s->n == m->n);
      assert_relative(s->rho, m->rho, 1e-15);
      assert_relative(s->radius, m->radius, 1e-14);
      assert_relative(s->plus, m->plus, 1e-13);
      assert_relative(s->minus, m->minus, 1e-13);
      assert_relative(s->variance_one, m->variance_one, 1e-10);
      assert_relative(s->bias_one, m->bias_one, 1e-10);
      assert_relative(s->variance, m->variance, 1e-10);
      assert_relative(s->bias, m->bias, 1e-10);
      assert_relative(s->rmse, m->rmse, 1e-10);
    }
  }
}

static double rate_at(const struct scene *scene, double x, double alpha) {
  struct cell cell = cell_of("epanechnikov", 0.6);
  struct probe probe = probe_at(x, 0);
  struct family_table table = family_table_new(cell.law, 300, &arena);
  struct family family = family_new(&table, alpha, &arena);
  struct prediction theory = prediction_new(scene, &cell, &probe, &family, &arena);
  return bias_theory_rate(&theory);
}

// As r^2 falls the bias of an iteration, as i^-(1 - alpha); where there is only r^4, twice as fast.
// A pixel beside the ring the former is still larger than a percent.
static void test_rate_on_the_ring(void **state) {
  (void)state;
  struct scene scene = light_scene(LAMBERTIAN, &arena);
  assert_relative(rate_at(&scene, 0, 0.7), 0.3, 1e-12);
  assert_relative(rate_at(&scene, 1.3 / sqrt(2), 0.7), 0.6, 1e-12);
  assert_relative(rate_at(&scene, 1.3 / sqrt(2) + 0.01, 0.7), 0.3, 1e-12);
}

// ---- where there is none ----

static void test_refusals(void **state) {
  (void)state;
  struct cell cell = cell_of("box", 0.5);
  struct probe probe = probe_at(0, 0);
  assert_true(has_closed_form(UNIFORM, cell, probe));
  assert_false(has_closed_form(UNIFORM, cell, probe_at(1.3, 0))); // the beam's rim in the disc
  assert_true(has_closed_form(GAUSSIAN, cell, probe_at(3.4, 3.4)));
  assert_false(has_closed_form(GAUSSIAN, cell, probe_at(3.6, 0))); // the plane's edge
  assert_false(has_closed_form(UNIFORM UNIFORM, cell, probe));     // two lights
  struct cell other = cell;
  other.direct = DIRECT_NEE;
  assert_false(has_closed_form(UNIFORM, other, probe));
  other = cell, other.left_out = LIGHT_PATH_EMITTED;
  assert_false(has_closed_form(UNIFORM, other, probe));
  other = cell, other.footprint = true;
  assert_false(has_closed_form(UNIFORM, other, probe));
  probe.hit = false;
  assert_false(has_closed_form(UNIFORM, cell, probe));
}

static void test_other_surfaces(void **state) {
  (void)state;
  struct cell cell = cell_of("box", 0.5);
  struct probe probe = probe_at(0, 0);
#define WALL                                                                                       \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [3 -1 0 3 1 0 3 0 2]\n"
  assert_false(has_closed_form(UNIFORM WALL, cell, probe));
#define BESIDE                                                                                     \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [5 -1 0 6 1 0 7 0 0]\n"
  assert_true(has_closed_form(UNIFORM BESIDE, cell, probe));
}

// The diagonal that a plane of two triangles shares is no edge of it.
static void test_probe_on_the_diagonal(void **state) {
  (void)state;
  struct probe probe = probe_at(0.2, 0.2);
  assert_true(has_closed_form(UNIFORM, cell_of("box", 0.5), probe));
}

// ---- without closed form ----

static uint64_t first_of(const char *world, double x, double radius, uint64_t n) {
  struct scene scene = light_scene(world, &arena);
  struct cell cell = cell_of("box", radius);
  struct probe probe = probe_at(x, 0);
  probe.reference = 1, probe.reference_se = 0.01;
  struct family_table table = family_table_new(cell.law, n, &arena);
  struct family family = family_new(&table, cell.alpha, &arena);
  struct prediction theory = prediction_new(&scene, &cell, &probe, &family, &arena);
  assert_false(theory.closed_form);
  if (theory.first > 0) assert_true(family.rho[theory.first - 1] * radius * radius >= 0.25);
  if (theory.first < n) assert_true(family.rho[theory.first] * radius * radius < 0.25);
  return theory.first;
}

// A wall at x = 3 and the plane's edge at x = 4: half a unit from either probe.
static void test_first_clear_iteration(void **state) {
  (void)state;
  assert_int_equal(first_of(UNIFORM WALL, 2.5, 0.49, 1000), 0);
  assert_in_range(first_of(UNIFORM WALL, 2.5, 1, 1000), 50, 150); // rho < 1/4
  assert_int_equal(first_of(UNIFORM WALL, 2.5, 1, 50), 50);       // none of them
  assert_in_range(first_of(UNIFORM, 3.5, 1, 1000), 50, 150);
#define BALL "Translate 2 0 1\nShape \"sphere\" \"float radius\" 0.5\n"
  // A sphere's box begins sqrt(0.7^2 + 0.5^2) and more away.
  assert_int_equal(first_of(UNIFORM BALL, 0.8, 0.49, 1000), 0);
}

// The constants are fitted, the truth is known all the same: the power over the beam's area.
static void test_unknown_radius(void **state) {
  (void)state;
  struct scene scene = light_scene(UNIFORM, &arena);
  struct probe probe = probe_at(0.3, 0.2);
  probe.emitted = 0.25;
  struct cell cell[] = {cell_of("cone", 12), cell_of("box", 0), cell_of("box", 12)};
  cell[0].reference_radius = &reference_radii[1];
  cell[1].k = 20;
  cell[2].reference_radius = &reference_radii[1], cell[2].direct = DIRECT_NEE;
  struct family_table table = family_table_new(cell[0].law, 50, &arena);
  struct family family = family_new(&table, cell[0].alpha, &arena);
  for (int k = 0; k < 3; k++) {
    struct prediction theory = prediction_new(&scene, &cell[k], &probe, &family, &arena);
    assert_false(theory.closed_form);
    assert_int_equal(theory.first, 0);
    double truth = 0.25 + 2.385 / (acos(-1.0) * 1.7 * 1.7);
    // a beam's radius and power are floats in the file
    if (k < 2) assert_relative(theory.truth, truth, 1e-6);
    if (k == 2) assert_true(isnan(theory.truth));
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"a uniform beam gives no bias and the variance of theory 5(i), for every kernel",
       test_uniform, 0, 0, 0},
      {"the box's kurtosis and variance are the binomial's", test_kurtosis_is_binomial, 0, 0, 0},
      {"a quadratic beam's bias is mu_2/2 r^2 Laplacian, for every kernel", test_quadratic_beam, 0,
       0, 0},
      {"a quadratic beam's second moment has two terms, for every kernel",
       test_variance_of_quadratic_beam, 0, 0, 0},
      {"the box on a Gaussian beam's axis has its closed form", test_gaussian_beam, 0, 0, 0},
      {"the box at an isotropic light's foot has its closed form", test_isotropic_foot, 0, 0, 0},
      {"the box under a Lambertian light has its closed form, anywhere", test_lambertian, 0, 0, 0},
      {"under a Lambertian light the bias is r^2 at the foot and r^4 at the ring",
       test_lambertian_bias, 0, 0, 0},
      {"and so are its rates", test_rate_on_the_ring, 0, 0, 0},
      {"the first terms of a bias are theory's", test_bias_terms, 0, 0, 0},
      {"they tell the Laplacians of the light, for every kernel", test_light_of_bias, 0, 0, 0},
      {"the curve of a quadratic beam is that of its expansion, for every kernel",
       test_curve_is_that_of_the_model, 0, 0, 0},
      {"there is no closed form across an edge, with two lights, footprints or direct sampling",
       test_refusals, 0, 0, 0},
      {"a wall takes the closed form away, a patch in the plane does not", test_other_surfaces, 0,
       0, 0},
      {"a probe on a shared diagonal is inside", test_probe_on_the_diagonal, 0, 0, 0},
      {"without closed form the fit begins where the disc is clear", test_first_clear_iteration, 0,
       0, 0},
      {"where the radius is not known the truth is", test_unknown_radius, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("predict", tests, NULL, NULL);
}
