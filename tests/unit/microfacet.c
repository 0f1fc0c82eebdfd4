// Trowbridge-Reitz microfacets: densities integrate to one, shadowing is what the projected area
// demands, samples follow their density.
#include "scene/material/microfacet.h"
#include "scene_text.h"

#include <gsl/gsl_integration.h>

static const double pi = 0x1.921fb54442d18p+1;

static const double alphas[][2] = {{1, 1}, {0.385, 0.385}, {0.1, 0.1}, {0.7, 0.15}, {0.2, 0.9}};
enum { N_ALPHAS = (int)(sizeof alphas / sizeof *alphas) };

static const struct vec views[] = {{0, 0, 1},        {0.6, 0, 0.8},          {-0.36, 0.48, 0.8},
                                   {0, -0.96, 0.28}, {0.798, 0.6, 0.056},    {0.48, -0.64, -0.6},
                                   {-0.8, 0, -0.6},  {0.9999, 0.01, 0.00999}};
enum { N_VIEWS = (int)(sizeof views / sizeof *views) };

static struct vec view(int i) { return vec_normalize(views[i]); }

// Gauss-Legendre.
struct rule {
  gsl_integration_glfixed_table *table;
};

static double node(const struct rule *rule, double a, double b, size_t i, double *weight) {
  double x;
  gsl_integration_glfixed_point(a, b, i, &x, weight, rule->table);
  return x;
}

// In slopes, tan = s / (1 - s), the integrand is analytic up to both ends: 256 Gauss points are
// exact to rounding, and so are 400 equal steps in the angle for a ratio of alphas below 10.
static void normals_cover_the_surface_once(void **state) {
  (void)state;
  enum { N = 256, M = 400 };
  struct rule rule = {gsl_integration_glfixed_table_alloc(N)};
  for (int k = 0; k < N_ALPHAS; k++) {
    struct microfacet m = microfacet_of(alphas[k][0], alphas[k][1]);
    double sum = 0;
    for (size_t i = 0; i < N; i++) {
      double weight, s = node(&rule, 0, 1, i, &weight), slope = s / (1 - s);
      double cosine = 1 / sqrt(1 + slope * slope), sine = slope * cosine;
      double dtheta = cosine * cosine / ((1 - s) * (1 - s)) * weight;
      for (int j = 0; j < M; j++) {
        double phi = 2 * pi * (j + 0.5) / M;
        struct vec n = vec(sine * cos(phi), sine * sin(phi), cosine);
        sum += microfacet_d(&m, n) * cosine * sine * dtheta * 2 * pi / M;
      }
    }
    if (!(fabs(sum - 1) <= 1e-12)) fail_msg("alpha %g %g: %.15g", m.alpha_x, m.alpha_y, sum);
  }
  gsl_integration_glfixed_table_free(rule.table);
}

// Normals that face both w and +z are a lune about the axis e perpendicular to both: longitudes
// [tilt - pi/2, pi/2] from z towards w, all latitudes.
struct lune {
  struct vec e, x;
  double from, to;
};

static struct lune lune_of(struct vec w) {
  if (w.z < 0) w = vec_scale(w, -1);
  double sine = sqrt(w.x * w.x + w.y * w.y);
  struct vec x = sine > 0 ? vec(w.x / sine, w.y / sine, 0) : vec(1, 0, 0);
  return (struct lune){vec_cross(vec(0, 0, 1), x), x, atan2(sine, w.z) - pi / 2, pi / 2};
}

static struct vec lune_at(const struct lune *lune, double longitude, double height) {
  double r = sqrt(1 - height * height);
  struct vec n = vec_along(vec_scale(lune->e, height), lune->x, r * sin(longitude));
  return vec_along(n, vec(0, 0, 1), r * cos(longitude));
}

// The integral over a rectangle of the lune; (longitude, height) keeps areas (Archimedes). Heights
// by their angle, which has no root at the ends.
static double lune_integral(const struct rule *rule, size_t n, const struct lune *lune,
                            const double longitude[2], const double height[2],
                            const struct microfacet *m, struct vec w) {
  double sum = 0, lo = asin(height[0]), hi = asin(height[1]);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      double a, b, l = node(rule, longitude[0], longitude[1], i, &a);
      double angle = node(rule, lo, hi, j, &b);
      sum += microfacet_pdf(m, w, lune_at(lune, l, sin(angle))) * cos(angle) * a * b;
    }
  return sum;
}

// This is the identity of G1 too: the projected area of the visible facets is that of the surface.
// The poles of D are 0.1 or more (the least alpha) from the real axis and intervals are up to pi
// long: 256 Gauss points leave an error of (1 + 0.1 / (pi / 2))^-512 = 1e-14.
static void visible_normals_fill_the_view(void **state) {
  (void)state;
  enum { N = 256 };
  struct rule rule = {gsl_integration_glfixed_table_alloc(N)};
  for (int k = 0; k < N_ALPHAS; k++)
    for (int v = 0; v < N_VIEWS; v++) {
      struct microfacet m = microfacet_of(alphas[k][0], alphas[k][1]);
      struct lune lune = lune_of(view(v));
      double sum = lune_integral(&rule, N, &lune, (double[]){lune.from, lune.to}, (double[]){-1, 1},
                                 &m, view(v));
      if (!(fabs(sum - 1) <= 1e-12)) fail_msg("alpha %d view %d: %.12g", k, v, sum);
    }
  gsl_integration_glfixed_table_free(rule.table);
}

// The forms without tangents are the usual ones.
static void forms_agree_with_the_tangents(void **state) {
  (void)state;
  struct draw draw = draw_named("forms_agree_with_the_tangents");
  for (int i = 0; i < 20000; i++) {
    double ax = draw_between(&draw, 0.002, 1), ay = draw_between(&draw, 0.002, 1);
    struct microfacet m = microfacet_of(ax, ay);
    struct vec a = draw_direction(&draw), b = draw_direction(&draw);
    double lambda[2], slack = 1e-12;
    for (int k = 0; k < 2; k++) {
      struct vec w = k == 0 ? a : b;
      double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z), phi = atan2(w.y, w.x);
      double alpha2 = pow(ax * cos(phi), 2) + pow(ay * sin(phi), 2);
      lambda[k] = (sqrt(1 + alpha2 * tan2) - 1) / 2;
      double e = tan2 * (pow(cos(phi) / ax, 2) + pow(sin(phi) / ay, 2));
      double d = 1 / (pi * ax * ay * pow(w.z, 4) * pow(1 + e, 2));
      assert_true(fabs(microfacet_d(&m, w) - d) <= slack * d);
      assert_true(fabs(microfacet_lambda(&m, w) - lambda[k]) <= slack * (1 + lambda[k]));
      assert_true(fabs(microfacet_g1(&m, w) * (1 + lambda[k]) - 1) <= slack);
    }
    double g = 1 / (1 + lambda[0] + lambda[1]);
    assert_true(fabs(microfacet_g(&m, a, b) - g) <= slack * g);
    double pdf = microfacet_d(&m, b) * fabs(vec_dot(a, b)) / (fabs(a.z) * (1 + lambda[0]));
    assert_true(fabs(microfacet_pdf(&m, a, b) - pdf) <= slack * pdf);
  }
}

static void smooth_is_below_a_thousandth_in_both_directions(void **state) {
  (void)state;
  assert_true(microfacet_of(0, 0).smooth);
  assert_true(microfacet_of(0.00099, 0.00099).smooth);
  assert_false(microfacet_of(0.001, 0.001).smooth);
  struct microfacet m = microfacet_of(0.2, 0);
  assert_true(!m.smooth && m.alpha_x == 0.2 && m.alpha_y == 1e-4);
  assert_true(microfacet_roughness_to_alpha(0.0625) == 0.25);
}

// 40,000 samples in 8 x 8 cells of the lune; those that expect less than 5 are one. Taking all
// normals for the visible ones changes cells by half: chi-squared 10^4 against a limit of 128
// at 63.
static void samples_follow_their_density(void **state) {
  (void)state;
  enum { SIDE = 8, N = 40000, GAUSS = 16 };
  struct rule rule = {gsl_integration_glfixed_table_alloc(GAUSS)};
  struct draw draw = draw_named("samples_follow_their_density");
  for (int k = 0; k < N_ALPHAS; k++)
    for (int v = 0; v < N_VIEWS; v++) {
      struct microfacet m = microfacet_of(alphas[k][0], alphas[k][1]);
      struct vec w = view(v);
      struct lune lune = lune_of(w);
      double count[SIDE][SIDE] = {{0}}, step = (lune.to - lune.from) / SIDE;
      for (int i = 0; i < N; i++) {
        double u[2];
        draw_pair(&draw, &u[0], &u[1]);
        struct vec n = microfacet_sample(&m, w, u);
        assert_true(fabs(vec_length(n) - 1) <= 1e-15 * 4);
        assert_true(n.z >= 0 && vec_dot(n, w) * (w.z < 0 ? -1 : 1) >= -1e-14);
        double longitude = atan2(vec_dot(n, lune.x), n.z), height = vec_dot(n, lune.e);
        int a = (int)((longitude - lune.from) / step), b = (int)((height + 1) / 2 * SIDE);
        count[a < 0 ? 0 : a > SIDE - 1 ? SIDE - 1 : a][b > SIDE - 1 ? SIDE - 1 : b] += 1;
      }
      double chi2 = 0, rare = 0, rare_count = 0;
      int cells = 0;
      for (int a = 0; a < SIDE; a++)
        for (int b = 0; b < SIDE; b++) {
          double longitude[] = {lune.from + a * step, lune.from + (a + 1) * step};
          double height[] = {2.0 * b / SIDE - 1, 2.0 * (b + 1) / SIDE - 1};
          double expected = N * lune_integral(&rule, GAUSS, &lune, longitude, height, &m, w);
          if (expected < 5) {
            rare += expected;
            rare_count += count[a][b];
            continue;
          }
          cells++;
          chi2 += (count[a][b] - expected) * (count[a][b] - expected) / expected;
        }
      if (rare >= 5) {
        cells++;
        chi2 += (rare_count - rare) * (rare_count - rare) / rare;
      } else {
        assert_true(rare_count <=
                    30); // a Poisson count of mean 5 exceeds it with probability 1e-14
      }
      if (!(chi2 <= chi2_limit(cells - 1)))
        fail_msg("alpha %d view %d: chi-squared %g over %d cells", k, v, chi2, cells);
    }
  gsl_integration_glfixed_table_free(rule.table);
}

// Straight down the tilt vanishes, straight across the normals face w: nothing is lost to either.
static void extreme_views_have_normals(void **state) {
  (void)state;
  struct microfacet m = microfacet_of(0.3, 0.05);
  struct draw draw = draw_named("extreme_views_have_normals");
  for (int i = 0; i < 20000; i++) {
    double tiny = exp(draw_between(&draw, -700, 0)), phi = draw_between(&draw, 0, 7), u[2];
    double up = sqrt((1 - tiny) * (1 + tiny));
    draw_pair(&draw, &u[0], &u[1]);
    struct vec across = vec(up * cos(phi), up * sin(phi), tiny);
    struct vec along = vec(tiny * cos(phi), tiny * sin(phi), up);
    struct vec a = microfacet_sample(&m, across, u), b = microfacet_sample(&m, along, u);
    assert_true(fabs(vec_length(a) - 1) <= 1e-15 * 4 && fabs(vec_length(b) - 1) <= 1e-15 * 4);
    assert_true(isfinite(microfacet_pdf(&m, across, a)) && microfacet_pdf(&m, along, b) > 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(normals_cover_the_surface_once),
      cmocka_unit_test(visible_normals_fill_the_view),
      cmocka_unit_test(forms_agree_with_the_tangents),
      cmocka_unit_test(smooth_is_below_a_thousandth_in_both_directions),
      cmocka_unit_test(samples_follow_their_density),
      cmocka_unit_test(extreme_views_have_normals),
  };
  return cmocka_run_group_tests_name("microfacet", tests, NULL, NULL);
}
