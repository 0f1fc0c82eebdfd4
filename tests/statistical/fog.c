// What theory says of photons in fog against fog that is simulated here, straight from the
// densities, and against the integrators.
#define _GNU_SOURCE // mkdtemp, nftw
#include "analysis/fog.h"
#include "analysis/fit.h"
#include "analysis/pairs.h"
#include "integrator/integrator.h"
#include "numeric/rng.h"
#include "tests/unit/run_fixture.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// ---- random numbers, in order ----

struct dice {
  struct rng_key key;
  uint64_t path;
  uint32_t pair;
  double spare;
  bool has_spare;
};

static struct dice dice_of(const char *name) {
  return (struct dice){.key = rng_key(rng_hash_name(name), 1, RNG_TEST)};
}

static double roll(struct dice *dice) {
  double u;
  if (dice->has_spare) {
    dice->has_spare = false;
    return dice->spare;
  }
  rng_fill(dice->key, 1, &dice->path, 1, dice->pair++, &u, &dice->spare);
  dice->has_spare = true;
  return u;
}

static struct vec direction(struct dice *dice) {
  double z = 2 * roll(dice) - 1, phi = 2 * pi * roll(dice), across = sqrt(1 - z * z);
  return vec(across * cos(phi), across * sin(phi), z);
}

static double flight(struct dice *dice, double sigma) { return -log(1 - roll(dice)) / sigma; }

// ---- one photon ----

struct sums {
  double n, first[2], second[2]; // of Y and of Y^2: their sums, and those of their squares
};

static void add(struct sums *sums, double y) {
  sums->n++;
  sums->first[0] += y;
  sums->first[1] += y * y;
  sums->second[0] += y * y;
  sums->second[1] += y * y * y * y;
}

static void assert_mean(const char *what, const double sum[2], double n, double expected,
                        double largest_se) {
  double mean = sum[0] / n, se = sqrt((sum[1] / n - mean * mean) / n);
  if (!(fabs(mean - expected) <= 4 * se))
    fail_msg("%s: %g, not %g +- %g", what, mean, expected, se);
  assert_true(se <= largest_se * expected);
}

// A photon of fog-beam collides within the ball of a radius of 1.8 with a probability of 0.07. |z|
// < 4 for mean and mean square of two kernels, level 2.5e-4; found are 2 % of either: the bias of
// 36 % would be 48 % in two dimensions.
static void a_photon_collides(void **state) {
  (void)state;
  static const char *const kernel[] = {"box", "epanechnikov"};
  const struct fog fog = {{1, 1, 1}, 0.8, 1, 1 / (4 * pi), 2, INFINITY};
  const double r = 1.8, side = 3.6, flux = 0.8 / (4 * pi); // a beam as wide as the ball
  struct dice dice = dice_of("fog-a-photon-collides");
  struct sums sums[2] = {{0}};
  for (int n = 0; n < 100000; n++) {
    double x = side * (roll(&dice) - 0.5), y = side * (roll(&dice) - 0.5);
    double z = flight(&dice, 1) - 2, t2 = (x * x + y * y + z * z) / (r * r);
    for (int k = 0; k < 2; k++)
      add(&sums[k], t2 < 1 ? flux * kernel_value(kernel_find(kernel[k]), 3, t2) / (r * r * r) : 0);
  }
  for (int k = 0; k < 2; k++) {
    struct profile profile = fog_of_points(&fog, 1 / (side * side), kernel_find(kernel[k]), r);
    assert_mean("mean", sums[k].first, sums[k].n, profile_moment(&profile, 1, r), 0.02);
    assert_mean("mean square", sums[k].second, sums[k].n, profile_moment(&profile, 2, r), 0.02);
  }
}

// A photon of a slab, 3 / (4 a) (1 - (y / a)^2) for |y| < a and uniform in 0 < x < 2, flies past
// the ray with probability e^-1 and is seen through x of fog. As above.
static void a_photon_flies(void **state) {
  (void)state;
  static const char *const kernel[] = {"box", "epanechnikov"};
  const struct fog fog = {{1, 1, 1}, 0.8, 1, 1 / (4 * pi), 1, 2};
  const double a = 0.7, r = 0.63, flux = 0.8 / (4 * pi);
  struct dice dice = dice_of("fog-a-photon-flies");
  struct sums sums[2] = {{0}};
  for (int n = 0; n < 100000; n++) {
    // The median of three uniform numbers has the density 6 u (1 - u).
    double u = roll(&dice), v = roll(&dice), w = roll(&dice);
    double median = fmax(fmin(u, v), fmin(fmax(u, v), w)), y = a * (2 * median - 1);
    double x = 2 * roll(&dice), t2 = y * y / (r * r);
    bool seen = flight(&dice, 1) > 1 && t2 < 1;
    for (int k = 0; k < 2; k++)
      add(&sums[k], seen ? flux * exp(-x) * kernel_value(kernel_find(kernel[k]), 1, t2) / r : 0);
  }
  double density[CHEBYSHEV_TERMS];
  for (int k = 0; k < CHEBYSHEV_TERMS; k++)
    density[k] = 0.75 / a * (1 - chebyshev_node(r * r, k) / (a * a)) / 2;
  for (int k = 0; k < 2; k++) {
    struct profile profile = fog_of_beams(&fog, density, kernel_find(kernel[k]), r);
    assert_mean("mean", sums[k].first, sums[k].n, profile_moment(&profile, 1, r), 0.02);
    assert_mean("mean square", sums[k].second, sums[k].n, profile_moment(&profile, 2, r), 0.02);
  }
}

// ---- pairs ----

// Where collisions are uniform, E[Y^2] r^3 / q is the mean over a collision at u of the ball of
// psi(u) (psi(u) + 2 times the sum over those that follow of psi). In units of R that is 1 + 2 a
// sigma r J / R
// + O((sigma r)^2); the latter are the attenuation of the next flight and the collision after it,
// at s with the density a^2 sigma^2 pi / (16 s): 2 a (pi^2 a / 4 - 1) (sigma r)^2 times the
// integral of s times psi's autocorrelation over s, 0.4 R for the box.
static double pair_share(struct dice *dice, double albedo, double sigma_r, int paths, double *se) {
  double sum = 0, square = 0;
  for (int n = 0; n < paths; n++) {
    struct vec p = vec_scale(direction(dice), cbrt(roll(dice)));
    double later = 0;
    while (roll(dice) < albedo) {
      p = vec_along(p, direction(dice), flight(dice, sigma_r));
      double distance2 = vec_dot(p, p);
      later += distance2 < 1;
      if (distance2 > 30 * 30) break; // about sigma r / 2700 of these collide in the ball again
    }
    sum += 2 * later;
    square += 4 * later * later;
  }
  double mean = sum / paths;
  *se = sqrt((square / paths - mean * mean) / paths);
  return mean;
}

// For the box. |z| < 4 for two, level 1.3e-4; at sigma r = 0.05 and 0.1 the terms of r^-2 are 0.06
// and 0.12 of the leading one, known to 2 %; what is of third order is below a fiftieth of them.
static void two_of_a_path_in_a_ball(void **state) {
  (void)state;
  struct dice dice = dice_of("fog-two-of-a-path-in-a-ball");
  const double albedo = 0.8;
  for (double sigma_r = 0.05; sigma_r < 0.2; sigma_r *= 2) {
    double se, share = pair_share(&dice, albedo, sigma_r, 200000, &se);
    double pairs = 2 * albedo * sigma_r * pairs_constant(kernel_find("box"));
    double next = 2 * albedo * (pi * pi * albedo / 4 - 1) * sigma_r * sigma_r * 0.4;
    if (!(fabs(share - pairs - next) <= 4 * se + 0.02 * pairs))
      fail_msg("%g, not %g + %g +- %g", share, pairs, next, se);
    assert_true(se < 0.02 * pairs);
  }
}

// ---- integrators ----

static const struct fit_row *row_of(const struct fit *fit, enum quantity quantity) {
  for (int r = 0; r < fit->n_rows; r++)
    if (fit->row[r].quantity == quantity) return &fit->row[r];
  fail_msg("there is no such row");
  return NULL;
}

// Four standard errors for rate and coefficient of both, level 2.5e-4.
static void agrees(const char *name, const char *yaml, double bias_rate, double most_rate_se,
                   double most_coefficient_se) {
  struct results results = run(name, yaml);
  struct fit fit;
  struct problem problem = {0};
  if (!fit_results(&results, &arena, &fit, &problem)) fail_msg("%s", problem.text);
  const struct fit_row *variance = row_of(&fit, QUANTITY_VARIANCE);
  const struct fit_row *bias = row_of(&fit, QUANTITY_BIAS);
  assert_true(variance->closed_form && bias->closed_form);
  assert_true(fabs(bias->rate_theory - bias_rate) < 1e-12);
  const struct fit_row *row[] = {variance, bias};
  for (int k = 0; k < 2; k++) {
    double ratio = row[k]->coefficient / row[k]->coefficient_theory;
    double se = row[k]->coefficient_se / fabs(row[k]->coefficient_theory);
    if (!(fabs(row[k]->rate - row[k]->rate_theory) <= 4 * row[k]->rate_se))
      fail_msg("rate %g +- %g, not %g", row[k]->rate, row[k]->rate_se, row[k]->rate_theory);
    if (!(fabs(ratio - 1) <= 4 * se)) fail_msg("ratio %g +- %g", ratio, se);
    assert_true(row[k]->rate_se < most_rate_se && se < most_coefficient_se);
    assert_int_equal(row[k]->verdict, VERDICT_AGREE);
  }
}

// Standard errors predicted by `photonlab plan`: 0.010 and 0.018 of the rates; the rate of a
// surface would be off by 0.1.
static void points(void **state) {
  (void)state;
  agrees(
      "fog-points",
      "scene: scenes/fog-beam.pbrt\nintegrator: probabilistic\nalpha: 4/7\nradius: 1.8\n"
      "photons: 400\ndepth: 1\nprobes: [[32, 32]]\niterations: 500\nruns: 40\nseed: fog-points\n",
      2.0 / 7, 0.03, 0.06);
}

// 0.017 and 0.0035; the rate of a surface would be off by 0.2.
static void beams(void **state) {
  (void)state;
  agrees("fog-beams",
         "scene: scenes/fog-slab.pbrt\nintegrator: beams\nalpha: 0.8\nradius: 0.9\nphotons: 400\n"
         "depth: 1\nprobes: [[32, 32]]\niterations: 200\nruns: 48\nseed: fog-beams\n",
         0.4, 0.03, 0.03);
}

// A constant radius of 0.8: what the wall takes, 7 % of the light, to a standard error of 3 % of
// it; |z| < 4, level 6e-5; found is a sixth of it more or less, as the fifth that attenuation
// within r of the wall makes.
static void wall(void **state) {
  (void)state;
  struct results results =
      run("fog-wall", "scene: scenes/fog-furnace.pbrt\nintegrator: probabilistic\nalpha: 1\n"
                      "radius: 0.8\nphotons: 200\ndepth: 1000\nprobes: [[32, 32]]\n"
                      "iterations: 100\nruns: 64\nseed: fog-wall\n");
  const struct series *series = &results.series[0];
  struct moments all = {0};
  for (uint64_t j = 0; j < series->n_iterations; j++)
    all = moments_merge(all, series->iteration[j]);
  // e^-1 0.8 int_0^1 2 pi s psi (e^(x s) - 1 - x s) / x^2 ds for x = 0.8, mpmath.
  const double wall_takes = 0.0692200529913816;
  double expected = 1 - wall_takes, se = sqrt(moments_se2(all));
  if (!(fabs(all.mean - expected) <= 4 * se)) fail_msg("%g, not %g +- %g", all.mean, expected, se);
  assert_true(se < 0.04 * wall_takes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      {"where a photon collides: mean and mean square in a ball", a_photon_collides, 0, 0, 0},
      {"where a photon flies: mean and mean square in a strip", a_photon_flies, 0, 0, 0},
      {"two photons of a path in a ball: r^-2", two_of_a_path_in_a_ball, 0, 0, 0},
      {"photon points: rates and sizes in fog", points, 0, 0, 0},
      {"photon beams: rates and sizes in fog", beams, 0, 0, 0},
      {"photon points before a wall", wall, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fog", tests, make_folder, remove_folder);
}
