// The closed forms at a shadow's edge against integrations of their own, theory's constants (1.5, 5
// iv), and what the fit is told of them.
#define _GNU_SOURCE // mkstemp
#include "analysis/bias_family.h"
#include "tests/light_fixture.h"
#include "tests/unit/predict_fixture.h"

#include <math.h>

static struct arena arena;

static void assert_near(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

// ---- kernels ----

// The share of the unit disc beyond a line, theory's m_0 subtracted from one.
static double box_beyond(double t) { return (acos(t) - t * sqrt(1 - t * t)) / pi; }

static void test_box(void **state) {
  (void)state;
  const double distances[] = {1e-9, 1e-5, 0.003, 0.1, 0.237, 0.5, 0.9, 0.999};
  for (int power = 1; power <= 4; power++)
    for (int k = 0; k < 8; k++)
      assert_near(shadow_beyond(kernel_find("box"), power, distances[k]) * pow(pi, power - 1),
                  box_beyond(distances[k]), 1e-11);
}

// Midpoint rule in stripes parallel to the line, each of them in steps: errs as the square of a
// step, and near the rim of the box as its 3/2.
static double beyond_by_stripes(const struct kernel *kernel, int power, double t) {
  enum { STEPS = 250 };
  double sum = 0, dx = (1 - t) / STEPS;
  for (int i = 0; i < STEPS; i++) {
    double x = t + (i + 0.5) * dx, top = sqrt(1 - x * x), dy = top / STEPS;
    for (int j = 0; j < STEPS; j++) {
      double y = (j + 0.5) * dy;
      sum += 2 * pow(kernel_value(kernel, 2, x * x + y * y), power) * dx * dy;
    }
  }
  return sum;
}

static void test_all_kernels(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++)
    for (int power = 1; power <= 4; power += 3)
      for (double t = 0.05; t < 1; t += 0.31) {
        double expected = beyond_by_stripes(&kernels[k], power, t);
        assert_near(shadow_beyond(&kernels[k], power, t), expected, 1e-3 * expected);
      }
}

// At the edge every symmetric kernel loses half of what it has; past the disc nothing.
static void test_at_the_edge(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++) {
    assert_near(shadow_beyond(&kernels[k], 1, 0), 0.5, 1e-12);
    double roughness = kernels[k].constants(2).roughness;
    assert_near(shadow_beyond(&kernels[k], 2, 0), roughness / 2, 1e-10 * roughness);
    assert_true(shadow_beyond(&kernels[k], 1, 1) == 0);
  }
}

// Across the edge |bias| integrates to E_0 r E|u_1|, bias^2 to E_0^2 r times theory's constants.
static void test_across(void **state) {
  (void)state;
  static const struct {
    const char *kernel;
    double first, second;
  } theory[] = {{"box", .42441318, .13621},
                {"epanechnikov", .33953055, .10531},
                {"biweight", .29102618, .08886},
                {"triweight", .25868994, .07828}};
  enum { STEPS = 2000 };
  for (int k = 0; k < 4; k++) {
    double first = 0, second = 0;
    for (int j = 0; j < STEPS; j++) {
      double bias = shadow_beyond(kernel_find(theory[k].kernel), 1, (j + 0.5) / STEPS);
      first += 2 * bias / STEPS, second += 2 * bias * bias / STEPS;
    }
    assert_near(first, theory[k].first, 1e-6);
    assert_near(second, theory[k].second, 6e-6);
  }
}

// ---- scenes ----

#define BEAM                                                                                       \
  "LightSource \"beam\" \"point3 from\" [0 0 2] \"point3 to\" [0 0 0] \"float radius\" 1.7 "       \
  "\"float power\" 2.385 Material \"diffuse\" " LIGHT_PLANE
#define BLACK "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
// In two triangles, for x > 0.25.
#define SHEET                                                                                      \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "                                      \
  "\"point3 P\" [0.25 -4 1.5 4 -4 1.5 4 4 1.5 0.25 4 1.5]\n"
static const double irradiance = 2.385 / (3.141592653589793 * 1.7 * 1.7);

static bool find(const char *world, struct cell cell, double x, struct profile *profile) {
  struct scene scene = light_scene(world, &arena);
  struct probe probe = probe_at(x, 0.1);
  return profile_find(&scene, &cell, &probe, cell.radius, arena, profile);
}

// On either side, from the edge to beyond the disc; a box's second moment is its first times what a
// photon adds.
static void test_profile(void **state) {
  (void)state;
  for (int k = -8; k <= 8; k++) {
    double a = k * 0.0625 + 0.015625, size = fabs(a); // > 0: lit
    struct profile profile;
    assert_true(find(BEAM BLACK SHEET, cell_of("box", 0.4), 0.25 - a, &profile));
    assert_near(profile.exact, a > 0 ? irradiance : 0, 1e-7);
    for (double r = 0.05; r < 0.4; r += 0.05) {
      double beyond = size < r ? box_beyond(size / r) : 0, bias = profile_bias(&profile, r);
      assert_near(bias, (a > 0 ? -beyond : beyond) * irradiance, 1e-7);
      if (size >= r) assert_near(bias, 0, 1e-15);
      assert_near(profile_moment(&profile, 2, r),
                  profile_moment(&profile, 1, r) * profile.flux / (pi * r * r), 1e-10 / (r * r));
    }
  }
}

static void test_refusals(void **state) {
  (void)state;
  struct cell cell = cell_of("box", 0.4);
  struct profile profile;
#define SQUARE(x0, y0, x1, y1)                                                                     \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" x0 " " y0 " 1.5 " x1   \
  " " y0 " 1.5 " x1 " " y1 " 1.5 " x0 " " y1 " 1.5]\n"
  assert_true(find(BEAM BLACK SQUARE("0.2", "-4", "4", "4"), cell, 0, &profile));
  // A corner, a strip and a hole in the disc.
  assert_false(find(BEAM BLACK SQUARE("0.2", "0", "4", "4"), cell, 0, &profile));
  assert_false(find(BEAM BLACK SQUARE("0.2", "-4", "0.3", "4"), cell, 0, &profile));
  assert_false(find(BEAM BLACK SQUARE("0.05", "0.05", "0.15", "0.15"), cell, 0, &profile));
  // Light could come back from a white sheet, but not if it is not followed.
  assert_false(find(BEAM SHEET, cell, 0, &profile));
  struct cell direct = cell;
  direct.depth = 1;
  assert_true(find(BEAM SHEET, direct, 0, &profile));
  assert_false(find(BEAM "Material \"interface\"\n" SHEET, direct, 0, &profile));
  // Its shadow is elsewhere.
  assert_true(find(BEAM BLACK SHEET, cell, -1.2, &profile));
  assert_int_equal(profile.shadow.shade, SHADE_NONE);
  // What is not uniform has a closed form, but not behind an edge.
#define GAUSSIAN                                                                                   \
  "LightSource \"beam\" \"point3 from\" [0 0 2] \"point3 to\" [0 0 0] \"string profile\" "         \
  "\"gaussian\" Material \"diffuse\" " LIGHT_PLANE
  assert_true(find(GAUSSIAN, cell, 0, &profile));
  assert_false(find(GAUSSIAN BLACK SHEET, cell, 0, &profile));
}

// ---- what the fit is told ----

static struct prediction predict(double a, double radius, uint64_t n) {
  struct scene scene = light_scene(BEAM BLACK SHEET, &arena);
  struct cell cell = cell_of("box", radius);
  struct probe probe = probe_at(0.25 - a, 0);
  struct family_table *table = arena_new(&arena, struct family_table, 1);
  *table = family_table_new(cell.law, n, &arena);
  struct family family = family_new(table, cell.alpha, &arena);
  return prediction_new(&scene, &cell, &probe, &family, &arena);
}

// Theory's examples: at a = 0.1 discs of 0.3 are clear at iteration 991, of 0.15 at 16 or so.
static void test_rates(void **state) {
  (void)state;
  struct prediction p = predict(0.1, 0.3, 1000);
  assert_int_equal(p.bias_kind, BIAS_ENDS);
  assert_in_range(p.bias_end, 989, 991); // iterations before
  assert_true(bias_theory_rate(&p) == 1);
  p = predict(0.1, 0.15, 1000);
  assert_in_range(p.bias_end, 14, 16);
  p = predict(0.1, 0.3, 500);
  assert_int_equal(p.bias_kind, BIAS_STAYS);
  assert_true(isnan(bias_theory_rate(&p)));
  p = predict(1e-6, 0.3, 1000);
  assert_int_equal(p.bias_kind, BIAS_EDGE);
  assert_true(bias_theory_rate(&p) == 0);
  assert_near(p.bias[0], -irradiance / 2, 1e-5);
  assert_near(p.bias[999], -irradiance / 2, 1e-5);
  p = predict(0.31, 0.3, 1000);
  assert_int_equal(p.bias_kind, BIAS_SMOOTH);
  assert_true(p.unbiased);
  p = predict(-0.1, 0.15, 1000);
  assert_non_null(p.why_not);
  assert_true(p.truth == 0);
}

// ---- pixels ----

static struct prediction predict_pixel(const char *kernel, struct probe probe, double radius,
                                       uint64_t n) {
  struct scene *scene = arena_new(&arena, struct scene, 1);
  struct problem problem = {0};
  if (!scene_read("scenes/plane-shadow-edge-pixel.pbrt", &arena, scene, &problem))
    fail_msg("%s", problem.text);
  struct cell cell = cell_of(kernel, radius);
  cell.footprint = true;
  struct family_table *table = arena_new(&arena, struct family_table, 1);
  *table = family_table_new(cell.law, n, &arena);
  struct family family = family_new(table, cell.alpha, &arena);
  return prediction_new(scene, &cell, &probe, &family, &arena);
}

static struct probe pixel_at(int x) {
  struct probe probe = probe_at(0.375 * (1.5 - x), 0);
  probe.x = x, probe.y = 1;
  return probe;
}

// All lit with its side on the edge: the bias is -E_0 r E|u_1| / (2 w).
static void test_side(void **state) {
  (void)state;
  const struct {
    const char *kernel;
    double first;
  } theory[] = {{"box", 4 / (3 * 3.141592653589793)}, {"epanechnikov", .33953055}};
  for (int k = 0; k < 2; k++) {
    struct prediction p = predict_pixel(theory[k].kernel, pixel_at(2), 0.3, 500);
    assert_true(p.closed_form);
    assert_int_equal(p.bias_kind, BIAS_SIDE);
    assert_near(bias_theory_rate(&p), 1.0 / 6, 1e-12);
    assert_near(p.truth, 1 / pi, 1e-7);
    for (int j = 0; j < 500; j += 71) {
      double r = 0.3 * sqrt(p.family.rho[j]);
      assert_near(p.bias[j], -theory[k].first * r / (2 * 0.375) / pi, 2e-6); // the edge's 2^-20
    }
  }
  // The dark one has what this one lacks; the next has no bias at all.
  struct prediction dark = predict_pixel("box", pixel_at(1), 0.3, 10);
  assert_near(dark.bias[0], 4 / (3 * pi) * 0.3 / (2 * 0.375) / pi, 2e-6);
}

// Mean, variance and kurtosis of an iteration, as sums over places in steps: given the place, a
// box's counts are binomial.
static void test_pixel_moments(void **state) {
  (void)state;
  enum { STEPS = 100000 };
  const double r = 0.3, n = 1000, share = r * r; // of the beam's photons that a lit disc has
  struct prediction p = predict_pixel("box", pixel_at(2), r, 3);
  double one = 0, central[5] = {0};
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < STEPS; k++) {
      double a = 0.375 * (k + 0.5) / STEPS, q = share * (a < r ? 1 - box_beyond(a / r) : 1);
      double mean = n * q, second = n * q * (1 - q), third = second * (1 - 2 * q);
      double fourth = second * (1 + 3 * (n - 2) * q * (1 - q)), off = mean - one;
      if (pass == 0)
        one += mean / STEPS;
      else {
        central[2] += (second + off * off) / STEPS;
        central[4] += (fourth + 4 * third * off + 6 * second * off * off + pow(off, 4)) / STEPS;
      }
    }
  double unit = 1 / (n * pi * r * r); // irradiance a photon of the disc stands for
  assert_near(p.truth + p.bias[0], one * unit, 1e-6);
  assert_near((p.divergent[0] + p.rest[0]) / (unit * unit * central[2]), 1, 1e-4);
  assert_near(p.kurtosis[0], central[4] / (central[2] * central[2]) - 3, 1e-4);
}

// N times the average's bias at rate beta is S (N / m)^(1 - beta); slopes by difference quotients.
static void test_family(void **state) {
  (void)state;
  enum { N = 300 };
  struct prediction p = predict(0.1, 0.15, N);
  double shape[3][N], slope[N], sum[2] = {0, 0};
  for (int at_edge = 0; at_edge < 2; at_edge++) {
    if (at_edge) p = predict(1e-6, 0.15, N);
    bias_family(&p, 0.7 - 1e-4, shape[0], slope);
    bias_family(&p, 0.7 + 1e-4, shape[1], slope);
    bias_family(&p, 0.7, shape[2], slope);
    for (int j = 0; j < N; j++)
      assert_near(slope[j], (shape[1][j] - shape[0][j]) / 2e-4, 1e-6 * fabs(slope[j]) + 1e-12);
    if (at_edge) break;
    for (int j = 0; j < N; j++) sum[j >= (int)p.bias_end] += shape[2][j];
    assert_near((sum[0] + sum[1]) / sum[0], pow((double)N / (double)p.bias_end, 0.3), 1e-12);
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"beyond a line a box holds the segment of its disc", test_box, 0, 0, 0},
      {"beyond a line every kernel holds what stripes add up to", test_all_kernels, 0, 0, 0},
      {"at the edge half is missing, past the disc nothing", test_at_the_edge, 0, 0, 0},
      {"across the edge bias integrates to theory's constants", test_across, 0, 0, 0},
      {"a half-shadowed disc has theory's bias, and the box's counts are binomial", test_profile, 0,
       0, 0},
      {"corners, strips, holes, what scatters and what varies have no closed form", test_refusals,
       0, 0, 0},
      {"the rate is 0 at the edge and 1 where the discs come clear of it", test_rates, 0, 0, 0},
      {"in a pixel with its side on the edge the bias is theory's L1 and falls as r", test_side, 0,
       0, 0},
      {"a pixel's moments are those of its places", test_pixel_moments, 0, 0, 0},
      {"the bias tilts as its rate says", test_family, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("predict_edge", tests, NULL, NULL);
}
