// Photons and light samples against the densities of theory 5, as hypotheses. Every p-value is of
// level 1e-5; seeds come from the test's name; one try.
// Chi-squared: photons are mapped to the unit square by the distribution they should have, 16 x 16
// cells, n = 2^20: finds a relative error of the density of 1.4 % rms with probability 0.99
// (non-centrality 190 at 255 degrees of freedom).
// Fluxes and irradiances: z-tests. A patch that gets a share p of the n photons is known to
// sqrt((1 - p) / (p n)): for p > 0.1 an error of 2 % is 6.8 of these, found with probability 0.99.
#ifndef TESTS_LIGHT_STATISTICS_H
#define TESTS_LIGHT_STATISTICS_H

#include "numeric/rng.h"
#include "tests/light_fixture.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

enum { N = 1 << 20, CELLS = 16, BATCH = 1024 };

static const double level = 1e-5;

// ---- random numbers: u[LIGHT_U] of photon j ----

struct stream {
  struct rng_key key;
  double u[LIGHT_U][BATCH];
};

static inline struct stream stream_begin(const char *test) {
  return (struct stream){.key = rng_key(rng_hash_name(test), 1, RNG_TEST)};
}

static inline void stream_read(struct stream *stream, uint64_t j, double u[LIGHT_U]) {
  if (j % BATCH == 0) {
    uint64_t path[BATCH];
    for (int k = 0; k < BATCH; k++) path[k] = j + (uint64_t)k;
    for (uint32_t pair = 0; pair < LIGHT_U / 2; pair++)
      rng_fill(stream->key, 1, path, BATCH, pair, stream->u[2 * pair], stream->u[2 * pair + 1]);
  }
  for (int k = 0; k < LIGHT_U; k++) u[k] = stream->u[k][j % BATCH];
}

static inline struct emission emit(const struct scene *scene, struct stream *stream, uint64_t j) {
  double u[LIGHT_U];
  struct emission photon;
  stream_read(stream, j, u);
  scene->light[0].type->emit(scene, &scene->light[0], u, &photon);
  assert_true(fabs(vec_length(photon.ray.d) - 1) < 1e-14);
  assert_true(photon.ray.t_max == INFINITY);
  for (int c = 0; c < 3; c++) // constant: to rounding all of the power
    assert_true(fabs(photon.flux[c] / scene->light[0].power[c] - 1) < 1e-14);
  return photon;
}

// ---- chi-squared on the unit square ----

struct histogram {
  double count[CELLS][CELLS];
};

static inline void histogram_add(struct histogram *histogram, double a, double b) {
  assert_true(a >= 0 && a <= 1 && b >= 0 && b <= 1);
  int i = (int)(a * CELLS), j = (int)(b * CELLS);
  histogram->count[i < CELLS ? i : CELLS - 1][j < CELLS ? j : CELLS - 1] += 1;
}

static inline void assert_uniform(const struct histogram *histogram) {
  double expected = (double)N / (CELLS * CELLS), chi2 = 0;
  for (int i = 0; i < CELLS; i++)
    for (int j = 0; j < CELLS; j++) {
      double difference = histogram->count[i][j] - expected;
      chi2 += difference * difference / expected;
    }
  double p = gsl_cdf_chisq_Q(chi2, CELLS * CELLS - 1);
  if (!(p >= level)) fail_msg("chi-squared %.1f of %d, p = %.2g", chi2, CELLS * CELLS - 1, p);
}

static inline double turn(double x, double y) {
  double a = atan2(y, x) / (2 * pi);
  return a < 0 ? a + 1 : a;
}

static inline void assert_z(double measured, double expected, double se) {
  double limit = gsl_cdf_ugaussian_Qinv(level / 2), z = (measured - expected) / se;
  if (!(fabs(z) <= limit))
    fail_msg("%.9g, not %.9g: z = %.2f (se %.2g)", measured, expected, z, se);
}

// ---- directions ----

// A frame of our own along the light's axis: `across` as the beam has it.
static inline void frame(struct vec axis, struct vec across, struct vec *x, struct vec *y) {
  *y = vec_normalize(vec_cross(axis, across));
  *x = vec_cross(*y, axis);
}

// Direction about n: cos^2 uniform (the cosine law), azimuth uniform.
static inline void add_cosine_law(struct histogram *histogram, struct vec n, struct vec d) {
  struct vec x, y;
  frame(n, vec(0.1, 0.7, -0.4), &x, &y);
  double cosine = vec_dot(d, n);
  assert_true(cosine >= 0);
  histogram_add(histogram, cosine * cosine, turn(vec_dot(d, x), vec_dot(d, y)));
}

// ---- flux through a patch ----

struct patch {
  struct vec centre, s, t, n; // half edges; lit from the side of n
};

static inline struct patch patch(struct vec centre, struct vec n, double half) {
  struct patch patch = {.centre = centre, .n = n};
  vec_basis(n, &patch.s, &patch.t);
  patch.s = vec_scale(patch.s, half);
  patch.t = vec_scale(patch.t, half);
  return patch;
}

static inline bool crosses(const struct patch *patch, const struct ray *ray) {
  double toward = vec_dot(ray->d, patch->n);
  if (toward >= 0) return false;
  double t = vec_dot(vec_sub(patch->centre, ray->o), patch->n) / toward;
  if (t <= 0) return false;
  struct vec v = vec_sub(vec_along(ray->o, ray->d, t), patch->centre);
  double half2 = vec_dot(patch->s, patch->s);
  return fabs(vec_dot(v, patch->s)) < half2 && fabs(vec_dot(v, patch->t)) < half2;
}

// The integral of `irradiance` over the patch by the midpoint rule: relative error < 1e-4 on these.
static inline double integrate(const struct scene *scene, const struct patch *patch,
                               double irradiance(const struct scene *, struct vec, struct vec)) {
  enum { SIDE = 128 };
  double sum = 0;
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) {
      double a = (2 * i + 1) / (double)SIDE - 1, b = (2 * j + 1) / (double)SIDE - 1;
      struct vec p = vec_along(vec_along(patch->centre, patch->s, a), patch->t, b);
      sum += irradiance(scene, p, patch->n);
    }
  return sum * 4 * vec_dot(patch->s, patch->s) / (SIDE * SIDE);
}

static inline void check_flux(const struct scene *scene, const char *name,
                              const struct patch *patch,
                              double irradiance(const struct scene *, struct vec, struct vec)) {
  struct stream stream = stream_begin(name);
  double count = 0, flux = 0;
  for (uint64_t j = 0; j < N; j++) {
    struct emission photon = emit(scene, &stream, j);
    if (!crosses(patch, &photon.ray)) continue;
    count += 1;
    flux = photon.flux[0];
  }
  double share = count / N, expected = integrate(scene, patch, irradiance);
  assert_true(share > 0.1); // else the patch is too small to find what the head of the file says
  assert_z(flux * share, expected, flux * sqrt(share * (1 - share) / N));
}

#endif
