// The closed forms of the integrating sphere, the white furnace and the plane mirror (theory 5 vii,
// viii) against integrations and walks of their own.
#define _GNU_SOURCE // mkstemp
#include "analysis/prediction.h"
#include "analysis/sphere.h"
#include "numeric/rng.h"
#include "tests/light_fixture.h"

#include <math.h>

static struct arena arena;

static const struct integrator_type photons = {
    .name = "probabilistic", .photons = true, .independent = true};

static void assert_relative(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance * fabs(expected)))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

// ---- the sphere's moments ----

static const double flux = 2.385, area = 4 * 3.141592653589793, albedo = 0.6;

// The first two moments as sums over hits and pairs of hits: k(t), or k(t) (1 - t) where the photon
// must come from farther away, and for consecutive hits the second nearer than the first, each by
// the midpoint rule, which errs by 1e-6 at the cone's tip.
struct sums {
  double first, second;
};

static struct sums add_up(const struct kernel *kernel, bool from_wall, double r) {
  enum { STEPS = 20000 };
  double share = pi * r * r / area, dt = share / STEPS, any[2] = {0}, seen[2] = {0};
  double pair_any = 0, pair_seen = 0, nearer = 0;
  for (int j = 0; j < STEPS; j++) {
    double t = (j + 0.5) * dt, k = kernel_value(kernel, 2, t / share) / (r * r);
    any[0] += k * dt, any[1] += k * k * dt;
    seen[0] += k * (1 - t) * dt, seen[1] += k * k * (1 - t) * dt;
    pair_any += k * (nearer + k * dt / 2) * dt;
    pair_seen += k * (1 - t) * (nearer + k * dt / 2) * dt;
    nearer += k * dt;
  }
  double a = albedo, b = 1 - a;
  if (from_wall) // every hit must come from farther away
    return (struct sums){
        seen[0] / b, seen[1] / b + 2 * (pair_seen * a / b + seen[0] * seen[0] * a * a / (b * b))};
  return (struct sums){any[0] + seen[0] * a / b, any[1] + seen[1] * a / b +
                                                     2 * (a * pair_any + pair_seen * a * a / b +
                                                          any[0] * seen[0] * a * a / b +
                                                          seen[0] * seen[0] * a * a * a / (b * b))};
}

static void test_two_moments(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++)
    for (int from_wall = 0; from_wall < 2; from_wall++) {
      struct profile profile = sphere_profile(flux, area, albedo, from_wall, &kernels[k], 1.4);
      for (double r = 0.1; r < 1.4; r += 0.4) {
        struct sums sums = add_up(&kernels[k], from_wall, r);
        assert_relative(profile_moment(&profile, 1, r), flux * sums.first, 2e-6);
        assert_relative(profile_moment(&profile, 2, r), flux * flux * sums.second, 2e-6);
      }
    }
}

// As r -> 0, theory's R / (A (1 - albedo)) per r^2, and the bias mu_2 r^2 / (2 R^2) of what is
// scattered.
static void test_limits(void **state) {
  (void)state;
  for (int k = 0; k < n_kernels; k++) {
    struct kernel_constants c = kernels[k].constants(2);
    struct profile profile = sphere_profile(flux, area, albedo, false, &kernels[k], 0.5);
    assert_relative(profile.exact, flux / (area * 0.4), 1e-13);
    assert_relative(profile_roughness(&profile), flux * flux * c.roughness / (area * 0.4), 1e-9);
    assert_relative(profile_bias(&profile, 0.3), -0.6 * profile.exact * c.mu2 * 0.09 / 2, 1e-12);
  }
}

// One path after another, the sums of its box raised to powers. Level 4e-5 for each of the eight;
// the smallest error caught is four standard errors, 3 % of the fourth moment.
static void test_four_moments(void **state) {
  (void)state;
  enum { PATHS = 400000 };
  const double r = 1.1, share = r * r / 4;
  for (int from_wall = 0; from_wall < 2; from_wall++) {
    struct profile profile = sphere_profile(flux, area, albedo, from_wall, kernel_find("box"), 1.4);
    struct rng_key key = rng_key(rng_hash_name("sphere: moments"), (uint64_t)from_wall, RNG_TEST);
    double sum[4] = {0}, square[4] = {0};
    for (uint64_t path = 0; path < PATHS; path++) {
      double last = 1, t, survive, count = 0;
      rng_fill(key, 1, &path, 1, 0, &t, &survive);
      if (from_wall) last = survive;
      for (unsigned hit = 1;; hit++) {
        count += t < share && t < last;
        last = t;
        double next;
        rng_fill(key, 1, &path, 1, hit, &next, &survive);
        if (survive >= albedo) break;
        t = next;
      }
      for (int m = 0; m < 4; m++) {
        double power = pow(flux * count / (pi * r * r), m + 1);
        sum[m] += power, square[m] += power * power;
      }
    }
    for (int m = 0; m < 4; m++) {
      double mean = sum[m] / PATHS, variance = square[m] / PATHS - mean * mean;
      double z = (mean - profile_moment(&profile, m + 1, r)) / sqrt(variance / PATHS);
      if (!(fabs(z) < 4.1)) fail_msg("moment %d: z = %g", m + 1, z);
    }
  }
}

// ---- scenes ----

static struct cell cell_of(double radius, int depth) {
  return (struct cell){.integrator = &photons,
                       .reference_radius = &reference_radii[0],
                       .kernel = kernel_find("box"),
                       .law = law_find("knaus-zwicker"),
                       .alpha = 2.0 / 3,
                       .radius = radius,
                       .photons = 1000,
                       .direct = DIRECT_PHOTONS,
                       .depth = depth};
}

static struct probe probe_at(struct vec p, struct vec n) {
  return (struct probe){.hit = true,
                        .p = p,
                        .n = n,
                        .scale = 1,
                        .scale_rgb = {1, 1, 1},
                        .reference = NAN,
                        .reference_se = NAN};
}

static bool find(const char *world, struct cell cell, struct probe probe, struct profile *profile) {
  struct scene scene = light_scene(world, &arena);
  return profile_find(&scene, &cell, &probe, cell.radius, arena, profile);
}

#define LAMP "LightSource \"point\" \"float power\" 2.385\n"
#define WALL "Material \"diffuse\" \"rgb reflectance\" [0.75 0.75 0.75]\n"
#define SPHERE "Shape \"sphere\" \"float radius\" 1.7\n"
#define GLOW "AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\nReverseOrientation\n"

static void test_sphere_scenes(void **state) {
  (void)state;
  struct cell cell = cell_of(0.4, 200);
  struct probe inside = probe_at(vec(0, 1.7, 0), vec(0, -1, 0));
  struct profile profile;
  assert_true(find("Scale -2 2 2\n" LAMP WALL SPHERE, cell, probe_at(vec(0, 3.4, 0), vec(0, -1, 0)),
                   &profile));
  assert_relative(profile.exact, 2.385 / (4 * pi * 3.4 * 3.4 * 0.25), 1e-6);
  assert_true(find(WALL GLOW SPHERE, cell, inside, &profile));
  assert_relative(profile.exact, 2 * pi / 0.25, 1e-6); // E = pi L / (1 - albedo)
  assert_false(find(LAMP WALL SPHERE, cell_of(3.4, 200), inside, &profile)); // all of the sphere
  assert_false(find(LAMP WALL SPHERE, cell_of(0.4, 64), inside, &profile));  // 0.75^64 = 1e-8
  struct probe outside = probe_at(vec(0, 1.7, 0), vec(0, 1, 0));
  assert_false(find(LAMP WALL SPHERE, cell, outside, &profile));
  assert_false(find(WALL "AreaLightSource \"diffuse\"\n" SPHERE, cell, inside, &profile));
  assert_false(find(WALL "AreaLightSource \"diffuse\" \"bool twosided\" true\n" SPHERE, cell,
                    inside, &profile));
  assert_false(find(LAMP WALL GLOW SPHERE, cell, inside, &profile));
  assert_false(
      find("Translate 0.1 0 0\n" LAMP "Translate -0.1 0 0\n" WALL SPHERE, cell, inside, &profile));
  assert_false(find(LAMP WALL "Shape \"sphere\" \"float radius\" 1.7 \"float zmax\" 1.6\n", cell,
                    inside, &profile));
  assert_false(find(LAMP WALL "Scale 1 1 2\n" SPHERE, cell, inside, &profile));
  assert_false(
      find(LAMP WALL SPHERE "Shape \"sphere\" \"float radius\" 0.1\n", cell, inside, &profile));
  assert_false(find("LightSource \"point\" \"string emission\" \"lambertian\"\n" WALL SPHERE, cell,
                    inside, &profile));
  assert_false(find(LAMP "Material \"diffuse\" \"rgb reflectance\" [0.5 0.6 0.7]\n" SPHERE, cell,
                    inside, &profile));
}

// ---- the mirror ----

#define POINT(height, to)                                                                          \
  "LightSource \"point\" \"string emission\" \"lambertian\" \"float power\" 2.385 "                \
  "\"point3 from\" [0.1 0 " height "] \"point3 to\" [0.1 0 " to "]\n"
#define FLOOR WALL LIGHT_PLANE
#define PERFECT "Material \"conductor\" \"rgb eta\" [0 0 0] \"rgb k\" [1 1 1]\n"
#define CEILING(height, size)                                                                      \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-" size " -" size        \
  " " height " " size " -" size " " height " " size " " size " " height " -" size " " size         \
  " " height "]\n"

// A light at 0.625 under a mirror at 1.25 is one at 1.875 that shines down: theory's box anywhere.
static void test_mirror(void **state) {
  (void)state;
  struct profile seen, real;
  for (double x = 0.1; x < 2; x += 0.6) {
    struct probe probe = probe_at(vec(x, 0.2, 0), vec(0, 0, 1));
    assert_true(find(POINT("0.625", "1") FLOOR PERFECT CEILING("1.25", "4"), cell_of(0.8, 3), probe,
                     &seen));
    assert_true(find(POINT("1.875", "1") FLOOR, cell_of(0.8, 3), probe, &real));
    assert_relative(seen.exact, real.exact, 1e-12);
    double h2 = 1.875 * 1.875, rho2 = (x - 0.1) * (x - 0.1) + 0.04;
    for (double r = 0.1; r < 0.8; r += 0.2) {
      double sum = rho2 + h2 + r * r;
      double share = (1 - (sum - 2 * r * r) / sqrt(sum * sum - 4 * rho2 * r * r)) / 2;
      assert_relative(profile_moment(&seen, 1, r), 2.385 * share / (pi * r * r), 1e-6);
      assert_relative(profile_moment(&seen, 2, r), profile_moment(&real, 2, r), 1e-11);
    }
  }
}

static void test_mirror_refusals(void **state) {
  (void)state;
  struct probe probe = probe_at(vec(0.1, 0.2, 0), vec(0, 0, 1));
  struct cell cell = cell_of(0.8, 3);
  struct profile profile;
#define UP POINT("0.625", "1")
  assert_true(find(UP FLOOR PERFECT CEILING("1.25", "1"), cell, probe, &profile));
  assert_false(find(UP FLOOR PERFECT CEILING("1.25", "0.5"), cell, probe, &profile)); // too small
  assert_false(find(UP FLOOR PERFECT CEILING("1.25", "4"), cell_of(0.8, 4), probe, &profile));
  assert_false(find(UP FLOOR PERFECT CEILING("1.25", "4"), cell_of(0.8, 2), probe, &profile));
  assert_false(find(POINT("0.625", "0") FLOOR PERFECT CEILING("1.25", "4"), cell, probe, &profile));
  assert_false(find(POINT("1.5", "2") FLOOR PERFECT CEILING("1.25", "4"), cell, probe, &profile));
  assert_false(find(
      UP FLOOR "Material \"conductor\" \"rgb reflectance\" [0.9 0.9 0.9]\n" CEILING("1.25", "4"),
      cell, probe, &profile));
  assert_false(find(UP FLOOR "Material \"conductor\" \"rgb eta\" [0 0 0] \"rgb k\" [1 1 1] "
                             "\"float roughness\" 0.1\n" CEILING("1.25", "4"),
                    cell, probe, &profile));
  assert_false(find(UP FLOOR WALL CEILING("1.25", "4"), cell, probe, &profile));
  assert_false(
      find(UP FLOOR PERFECT CEILING("1.25", "4") CEILING("1.5", "4"), cell, probe, &profile));
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"the sphere's first two moments are the sums over hits and pairs", test_two_moments, 0, 0,
       0},
      {"the sphere's variance and bias begin as theory says", test_limits, 0, 0, 0},
      {"the sphere's four moments are those of simulated paths", test_four_moments, 0, 0, 0},
      {"a whole gray sphere with its light at the centre or all over, followed to the end",
       test_sphere_scenes, 0, 0, 0},
      {"light by a mirror is that of the light's image", test_mirror, 0, 0, 0},
      {"small, dim, rough and second mirrors have no closed form", test_mirror_refusals, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("predict_sphere", tests, NULL, NULL);
}
