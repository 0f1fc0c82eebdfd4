// Coated materials: what a coat lets through against integrals written out, the closed form's
// limits, the delta series, and what the readers refuse.
#include "scene/layered.h"
#include "scene_text.h"

#include <stdlib.h>

static const double pi = 0x1.921fb54442d18p+1;

static struct dielectric coat_of(double eta, double alpha_x, double alpha_y) {
  return dielectric_of(eta, microfacet_of(alpha_x, alpha_y));
}

static struct vec direction(double cosine, double phi) {
  double sine = sqrt((1 - cosine) * (1 + cosine));
  return vec(sine * cos(phi), sine * sin(phi), cosine);
}

// The scattering of the one surface of a scene, which lives until the next.
static struct bsdf bsdf_of(const char *material, double u) {
  static struct scene scene;
  static char text[1024];
  snprintf(text, sizeof text, "WorldBegin LightSource \"point\" %s Shape \"disk\"", material);
  scene = scene_of(text);
  struct surface surface = {.ng = {0, 0, 1}, .ns = {0, 0, 1}, .dpdu = {1, 0, 0}};
  struct bsdf out;
  surface_bsdf(&scene, &surface, u, &out);
  return out;
}

static double value(const struct bsdf *bsdf, struct vec wo, struct vec wi) {
  double f[3];
  bsdf->type->value(bsdf, wo, wi, TRANSPORT_RADIANCE, f);
  assert_true(f[0] == f[1] && f[1] == f[2]);
  return f[0];
}

#define assert_near(is, expected, tolerance)                                                       \
  do {                                                                                             \
    double is_ = (is), expected_ = (expected);                                                     \
    if (!(fabs(is_ - expected_) <= (tolerance)))                                                   \
      fail_msg("line %d: %.12g instead of %.12g", __LINE__, is_, expected_);                       \
  } while (0)

// ---- t and K ----

// Over directions inside instead of facets: midpoints in cosine^2 and azimuth. 2000 x 400 of them
// resolve lobes of alpha >= 0.2, refracted at eta >= 1.3, to 1e-5; t is claimed to 5e-5 at constant
// roughness below 0.5.
static double entering_by_directions(const struct dielectric *coat, double depth, struct vec w) {
  enum { N = 2000, M = 200 };
  double sum = 0, pdf;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < M; j++) {
      double cosine = sqrt((i + 0.5) / N), phi = 2 * pi * (j + 0.5) / M;
      struct vec in = direction(cosine, phi);
      in.z = -in.z;
      sum += coat_transmission(coat, w, in, &pdf) * exp(-depth / cosine);
    }
  return sum * pi / ((double)N * M);
}

static void t_is_the_integral_over_directions(void **state) {
  (void)state;
  static const struct {
    double eta, alpha_x, alpha_y, depth, cosine, phi;
  } cases[] = {{1.5, 0.3, 0.3, 0.01, 0.85, 0},
               {1.5, 0.45, 0.45, 0.3, 0.15, 0},
               {1.35, 0.4, 0.25, 0.02, 0.55, 0.7}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    struct dielectric coat = coat_of(cases[k].eta, cases[k].alpha_x, cases[k].alpha_y);
    struct vec w = direction(cases[k].cosine, cases[k].phi);
    double t = coat_entering(&coat, cases[k].depth, w);
    assert_near(t, entering_by_directions(&coat, cases[k].depth, w), 5e-5 * t + 1e-5);
  }
}

// Sent up Lambertian, reflected, both ways attenuated: three integrals over directions, cosines
// graded towards grazing, where the attenuation has its edge: cos dw = 4 x^3 dx for cos = x^2.
static void k_is_the_integral_over_directions(void **state) {
  (void)state;
  enum { N = 80 };
  static const double alphas[] = {0.45, 0.7, 1};
  for (int a = 0; a < 3; a++) {
    struct dielectric coat = coat_of(1.5, alphas[a], alphas[a]);
    double sum = 0;
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) {
        double x = (i + 0.5) / N, y = (j + 0.5) / N, up = x * x, back = y * y, ring = 0;
        struct vec w = vec_scale(direction(up, 0), -1);
        for (int k = 0; k < N; k++)
          ring += dielectric_value(&coat, w, vec_scale(direction(back, pi * (k + 0.5) / N), -1),
                                   TRANSPORT_IMPORTANCE);
        sum += ring * exp(-0.01 / up - 0.01 / back) * 16 * x * x * x * y * y * y;
      }
    assert_near(coat_returned(&coat, 0.01), sum * pi / ((double)N * N * N), 1e-4);
  }
}

// Walsh's closed form of the diffuse reflectance from outside; from inside it follows since a
// lossless Lambertian base under a smooth coat keeps nothing: 1 - K = (1 - external) / eta^2.
static double walsh(double n) {
  double n2 = n * n, n4 = n2 * n2, m = n2 - 1, p = n2 + 1;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * m * m / (p * p * p) * log((n - 1) / (n + 1)) -
         2 * n2 * n * (n2 + 2 * n - 1) / (p * (n4 - 1)) +
         8 * n4 * (n4 + 1) / (p * (n4 - 1) * (n4 - 1)) * log(n);
}

static void k_of_a_smooth_coat_is_walshs(void **state) {
  (void)state;
  static const double etas[] = {1.2, 1.5, 2.385};
  assert_near(walsh(1.5), 0.0918, 5e-5); // as tabulated
  for (int i = 0; i < 3; i++) {
    struct dielectric coat = coat_of(etas[i], 0, 0);
    assert_near(coat_returned(&coat, 0), 1 - (1 - walsh(etas[i])) / (etas[i] * etas[i]), 1e-6);
  }
}

// As coat.h says.
static void tables_repeat_the_quadrature(void **state) {
  (void)state;
  struct test_memory memory = *test_memory();
  struct draw draw = draw_named("tables_repeat_the_quadrature");
  struct coat_table all = coat_table_alphas(&memory.keep, 1.5, 0.01);
  struct dielectric stretched = coat_of(1.5, 0.4, 0.15);
  struct coat_table one = coat_table_one(&memory.keep, &stretched, 0.01);
  for (int i = 0; i < 300; i++) {
    double x = draw_between(&draw, 0.01, 1), alpha = x * x;
    alpha = alpha < 0.01 ? 0.01 : alpha;
    struct vec w = direction(draw_between(&draw, 0.001, 1), draw_between(&draw, 0, 7));
    struct dielectric coat = coat_of(1.5, alpha, alpha);
    double t = coat_entering(&coat, 0.01, w), s = coat_entering(&stretched, 0.01, w);
    assert_near(coat_table_entering(&all, &coat, w), t, 5e-4 * t);
    assert_near(coat_table_entering(&one, &stretched, w), s, 3e-4 * s);
    if (i % 30 == 0)
      assert_near(coat_table_returned(&all, &coat), coat_returned(&coat, 0.01), 2e-4);
  }
  assert_near(coat_table_returned(&one, &stretched), coat_returned(&stretched, 0.01), 0);
}

// ---- the closed form ----

static const struct vec wo = {0.48, -0.36, 0.8}, wi = {-0.6, 0, 0.8}, grazing = {0, 0.96, 0.28};

static void equal_indices_leave_the_base(void **state) {
  (void)state;
  for (int rough = 0; rough < 2; rough++) {
    struct bsdf bsdf = bsdf_of(rough ? "Material \"coateddiffuse\" \"float eta\" 1 \"float "
                                       "roughness\" 0.3 \"rgb reflectance\" [.7 .7 .7]"
                                     : "Material \"coateddiffuse\" \"float eta\" 1 \"rgb "
                                       "reflectance\" [.7 .7 .7]",
                               0.5);
    double through = exp(-0.01 / 0.8 - 0.01 / 0.28);
    assert_near(value(&bsdf, wo, grazing), 0.7 / pi * through, 1e-15);
    assert_near(value(&bsdf, vec_scale(wo, -1), vec_scale(grazing, -1)), 0.7 / pi * through, 1e-15);
    assert_true(value(&bsdf, wo, vec_scale(grazing, -1)) == 0);
    assert_true(bsdf.type->delta_probability(&bsdf, wo, TRANSPORT_RADIANCE) == 0);
  }
  // Nearly equal: reflection is of the order of the square of the difference; total reflection from
  // inside, beyond sqrt(2 (eta - 1)) from grazing, of its first: K < 3e-6.
  struct bsdf bsdf =
      bsdf_of("Material \"coateddiffuse\" \"float eta\" 1.000001 \"float thickness\" "
              "0 \"rgb reflectance\" [.7 .7 .7]",
              0.5);
  assert_near(value(&bsdf, wo, wi), 0.7 / pi, 3e-6);
}

static void a_black_base_leaves_the_coat(void **state) {
  (void)state;
  struct bsdf bsdf = bsdf_of("Material \"coateddiffuse\" \"float roughness\" 0.16 \"rgb "
                             "reflectance\" [0 0 0] \"float eta\" 1.7",
                             0.5);
  struct dielectric coat = coat_of(1.7, 0.4, 0.4);
  assert_true(value(&bsdf, wo, wi) == dielectric_value(&coat, wo, wi, TRANSPORT_RADIANCE));
  bsdf = bsdf_of("Material \"coateddiffuse\" \"rgb reflectance\" [0 0 0]", 0.5);
  struct bsdf_sample sample;
  assert_true(value(&bsdf, wo, wi) == 0);
  assert_true(bsdf.type->sample(&bsdf, wo, (double[]){0.3, 0.3, 0.3}, TRANSPORT_RADIANCE, &sample));
  double fresnel = fresnel_dielectric(wo.z, 1.5);
  assert_true(sample.pdf == 0 && sample.wi.x == -wo.x && sample.wi.z == wo.z);
  assert_near(sample.weight[1], fresnel, 1e-15);
}

// A lossless base under a smooth lossless coat reflects everything, whatever the angle: F + t = 1
// and the series and eta^2 fit together. The walk's 400 steps leave K^200 = 1e-45. K is good to
// 6e-5, and 1 / (1 - K) doubles that. Of a rough coat what facets pass on to each other is lost:
// less, but not more.
static double reflected(const char *material, double cosine) {
  enum { N = 400, M = 200 };
  struct bsdf bsdf = bsdf_of(material, 0.5);
  struct vec o = direction(cosine, 0);
  double sum = 0;
  for (int i = 0; i < N; i++)
    for (int j = 0; j < M; j++)
      sum += value(&bsdf, o, direction(sqrt((i + 0.5) / N), pi * (j + 0.5) / M));
  return sum * pi / ((double)N * M);
}

static void a_lossless_base_reflects_everything(void **state) {
  (void)state;
#define LOSSLESS                                                                                   \
  "Material \"coateddiffuse\" \"rgb reflectance\" [1 1 1] \"float thickness\" 0 \"integer "        \
  "maxdepth\" 400 "
  for (int k = 1; k <= 4; k++) {
    double z = 0.25 * k;
    assert_near(reflected(LOSSLESS, z) + fresnel_dielectric(z, 1.5), 1, 1.2e-4);
    double rough = reflected(LOSSLESS "\"float roughness\" 0.04", z);
    if (!(rough > 0.7 && rough < 1)) fail_msg("rough: %.6f", rough);
  }
}

static void a_coat_is_reciprocal(void **state) {
  (void)state;
  static const char *const coats[] = {"", "\"float roughness\" 0.1",
                                      "\"float uroughness\" 0.3 \"float vroughness\" 0.05"};
  for (int i = 0; i < 3; i++) {
    char text[200];
    snprintf(text, sizeof text, "Material \"coateddiffuse\" %s", coats[i]);
    struct bsdf bsdf = bsdf_of(text, 0.5);
    double there = value(&bsdf, wo, grazing);
    assert_near(value(&bsdf, grazing, wo), there, 1e-15);
  }
}

// Depths 0, 2, 4, ... are at the base: maxdepth 1 and 2 see it once, 3 twice, 5 thrice.
static void the_series_ends_with_the_walk(void **state) {
  (void)state;
  static const int bounces[] = {0, 1, 1, 2, 2, 3};
  struct dielectric coat = coat_of(1.5, 0, 0);
  double rk = 0.5 * coat_returned(&coat, 0.01), first = 0;
  for (int depth = 1; depth <= 5; depth++) {
    char text[100];
    snprintf(text, sizeof text, "Material \"coateddiffuse\" \"integer maxdepth\" %d", depth);
    struct bsdf bsdf = bsdf_of(text, 0.5);
    double f = value(&bsdf, wo, wi), sum = 0;
    if (depth == 1) first = f;
    for (int i = 0; i < bounces[depth]; i++) sum += pow(rk, i);
    assert_near(f, first * sum, 1e-15);
  }
  double t = coat_entering(&coat, 0.01, wo) * coat_entering(&coat, 0.01, wi);
  assert_near(first, 0.5 / pi * t / 2.25, 1e-15);
}

// Where a texture makes the walk necessary, it has the same expectation
// (tests/statistical/layered.c has the rest): 40000 walks, and a bound of 5 standard errors.
static void the_walk_agrees_with_the_closed_form(void **state) {
  (void)state;
  static const char *const roughness[] = {"0", "0.1", "0.5"};
  enum { N = 40000 };
  for (int k = 0; k < 3; k++) {
    char text[200];
    snprintf(text, sizeof text, "Material \"coateddiffuse\" \"float roughness\" %s", roughness[k]);
    struct bsdf bsdf = bsdf_of(text, 0.5);
    double exact = value(&bsdf, wo, grazing), sum = 0, sum2 = 0, alpha = sqrt(atof(roughness[k]));
    struct layered layered = {.coat = coat_of(1.5, alpha, alpha),
                              .reflectance = {0.5, 0.5, 0.5},
                              .thickness = 0.01,
                              .max_depth = 10,
                              .n_samples = 1};
    for (int i = 0; i < N; i++) {
      double f[3];
      layered_value(&layered, wo, grazing, (i + 0.5) / N, f);
      sum += f[0];
      sum2 += f[0] * f[0];
    }
    double mean = sum / N, se = sqrt((sum2 / N - mean * mean) / N);
    if (!(fabs(mean - exact) <= Z_LIMIT * se + 2e-4 * exact))
      fail_msg("roughness %s: walk %.6f +- %.6f, closed form %.6f", roughness[k], mean, se, exact);
    assert_true(se < 0.01 * exact);
  }
}

// ---- smooth under smooth ----

static void smooth_coats_on_smooth_metals_are_a_series(void **state) {
  (void)state;
  struct bsdf bsdf = bsdf_of("Material \"coatedconductor\" \"rgb reflectance\" [.6 .6 .6] \"float "
                             "thickness\" 0.02 \"integer maxdepth\" 7",
                             0.5);
  struct bsdf_sample sample;
  assert_true(bsdf.type->delta_probability(&bsdf, wo, TRANSPORT_RADIANCE) == 1);
  assert_true(value(&bsdf, wo, wi) == 0);
  assert_true(bsdf.type->sample(&bsdf, wo, (double[]){0.3, 0.3, 0.9}, TRANSPORT_RADIANCE, &sample));
  // Three times to the metal; its eta and k over the coat's.
  double cosine = sqrt(1 - 0.36 / 2.25), through = exp(-0.04 / cosine);
  double metal = fresnel_conductor(cosine, 1 / 1.5, 2 * sqrt(0.6) / sqrt(0.4) / 1.5) * through;
  double f = fresnel_dielectric(0.8, 1.5), x = f * metal;
  assert_near(sample.weight[0], f + (1 - f) * (1 - f) * metal * (1 + x + x * x), 1e-14);
  assert_true(sample.pdf == 0 && sample.wi.x == -wo.x && sample.wi.y == -wo.y);
}

// Any maxdepth is as good as infinite, and ends.
static void endless_walks_end(void **state) {
  (void)state;
  static const char *const materials[] = {"coateddiffuse", "coatedconductor"};
  for (int i = 0; i < 4; i++) {
    char text[200];
    snprintf(text, sizeof text,
             "Material \"%s\" \"rgb reflectance\" [1 1 1] \"float "
             "thickness\" %d \"rgb albedo\" [%d %d "
             "%d] \"integer maxdepth\" 2147483647",
             materials[i % 2], i / 2, i / 2, i / 2, i / 2);
    struct bsdf bsdf = bsdf_of(text, 0.5);
    struct bsdf_sample sample;
    for (int k = 0; k < 100; k++)
      if (bsdf.type->sample(&bsdf, wo, (double[]){0.3, 0.01 * k, 0.7}, TRANSPORT_RADIANCE, &sample))
        assert_true(isfinite(sample.weight[0]));
  }
}

// ---- sampling and reading ----

// The weight is f |cos| / pdf, on either side, and the density is the one that is said.
static void weights_are_values_over_densities(void **state) {
  (void)state;
  static const char *const materials[] = {
      "\"coateddiffuse\"",
      "\"coateddiffuse\" \"float roughness\" 0.1",
      "\"coateddiffuse\" \"rgb albedo\" [.5 .5 .5] \"float thickness\" 0.5 \"float g\" 0.4",
      "\"coateddiffuse\" \"float eta\" 0.8 \"float roughness\" 0.1",
      "\"coatedconductor\" \"float conductor.roughness\" 0.05",
      "\"coatedconductor\" \"float interface.roughness\" 0.05",
      "\"coatedconductor\" \"float interface.roughness\" 0.02 \"float conductor.uroughness\" 0.1",
      "\"coatedconductor\" \"rgb albedo\" [.5 .5 .5] \"float thickness\" 0.5",
  };
  struct draw draw = draw_named("weights_are_values_over_densities");
  for (size_t k = 0; k < sizeof materials / sizeof *materials; k++) {
    char text[200];
    snprintf(text, sizeof text, "Material %s", materials[k]);
    struct bsdf bsdf = bsdf_of(text, 0.37);
    for (int i = 0; i < 300; i++) {
      double u[4], f[3];
      draw_pair(&draw, &u[0], &u[1]);
      draw_pair(&draw, &u[2], &u[3]);
      struct vec o = direction(u[3], 1);
      struct bsdf_sample sample;
      if (i % 2) o = vec_scale(o, -1);
      double delta = bsdf.type->delta_probability(&bsdf, o, TRANSPORT_RADIANCE);
      if (!bsdf.type->sample(&bsdf, o, u, TRANSPORT_RADIANCE, &sample)) continue;
      assert_true((sample.pdf == 0) == (u[2] < delta));
      if (sample.pdf == 0) continue;
      bsdf.type->value(&bsdf, o, sample.wi, TRANSPORT_RADIANCE, f);
      double density = bsdf.type->pdf(&bsdf, o, sample.wi, TRANSPORT_RADIANCE);
      assert_true(density == sample.pdf && density > 0);
      for (int c = 0; c < 3; c++)
        assert_near(sample.weight[c] * density, f[c] * fabs(sample.wi.z), 1e-14 * f[c]);
    }
  }
}

static void problems_name_what_is_wrong(void **state) {
  (void)state;
  static const struct {
    const char *text, *expect;
  } cases[] = {
      {"Material \"coateddiffuse\" \"float thickness\" -1", "must not be negative"},
      {"Material \"coateddiffuse\" \"float g\" 1.5", "g must be in [-1, 1]"},
      {"Material \"coateddiffuse\" \"integer maxdepth\" 0", "\"maxdepth\" must be at least 1"},
      {"Material \"coateddiffuse\" \"integer nsamples\" 0", "\"nsamples\" must be at least 1"},
      {"Material \"coateddiffuse\" \"rgb albedo\" [2 0 0]", "in [0, 1]"},
      {"Material \"coateddiffuse\" \"float interface.roughness\" 1", "interface.roughness"},
      {"Material \"coatedconductor\" \"float roughness\" 1", "roughness"},
      {"Material \"coatedconductor\" \"rgb reflectance\" 1", "reflectance"},
      {"Material \"mix\"", "two names of materials"},
      {"Material \"mix\" \"string materials\" [\"a\"]", "two names of materials"},
      {"Material \"mix\" \"string materials\" [\"a\" \"b\"]", "no material \"a\""},
      {"MakeNamedMaterial \"a\" \"string type\" \"interface\" Material \"mix\" \"string "
       "materials\" [\"a\" \"a\"]",
       "is an interface"},
      {"Material \"interface\" \"float roughness\" 1", "roughness"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[400];
    struct scene scene;
    struct problem problem;
    snprintf(text, sizeof text, "WorldBegin LightSource \"point\" %s Shape \"disk\"",
             cases[i].text);
    assert_false(scene_of_bytes(text, (ptrdiff_t)strlen(text), &scene, &problem));
    if (!strstr(problem.text, cases[i].expect)) fail_msg("%s: %s", cases[i].text, problem.text);
  }
}

// The second material has the probability `amount`, and u is spread over [0, 1) again.
static void a_mix_takes_the_second_by_amount(void **state) {
  (void)state;
  enum { N = 1000 };
  int second = 0;
  double sum = 0;
  for (int i = 0; i < N; i++) {
    struct bsdf bsdf = bsdf_of("MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb "
                               "reflectance\" [.8 .8 .8] MakeNamedMaterial \"b\" \"string type\" "
                               "\"diffuse\" \"rgb reflectance\" [.1 .1 .1] Material \"mix\" "
                               "\"string materials\" [\"a\" \"b\"] \"float amount\" 0.3",
                               (i + 0.5) / N);
    second += value(&bsdf, wo, wi) < 0.2 / pi;
    assert_true(bsdf.u >= 0 && bsdf.u < 1);
    sum += bsdf.u;
  }
  assert_int_equal(second, 300);
  assert_near(sum / N, 0.5, 1e-9);
  for (int amount = 0; amount < 2; amount++) {
    char text[400];
    snprintf(text, sizeof text,
             "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [.8 .8 .8] "
             "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [.1 .1 .1] "
             "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" %d",
             amount);
    for (int end = 0; end < 2; end++) {
      struct bsdf bsdf = bsdf_of(text, end ? 1 - 0x1p-53 : 0);
      assert_near(value(&bsdf, wo, wi) * pi, amount ? 0.1 : 0.8, 1e-15);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(t_is_the_integral_over_directions),
      cmocka_unit_test(k_is_the_integral_over_directions),
      cmocka_unit_test(k_of_a_smooth_coat_is_walshs),
      cmocka_unit_test(tables_repeat_the_quadrature),
      cmocka_unit_test(equal_indices_leave_the_base),
      cmocka_unit_test(a_black_base_leaves_the_coat),
      cmocka_unit_test(a_lossless_base_reflects_everything),
      cmocka_unit_test(a_coat_is_reciprocal),
      cmocka_unit_test(the_series_ends_with_the_walk),
      cmocka_unit_test(the_walk_agrees_with_the_closed_form),
      cmocka_unit_test(smooth_coats_on_smooth_metals_are_a_series),
      cmocka_unit_test(endless_walks_end),
      cmocka_unit_test(weights_are_values_over_densities),
      cmocka_unit_test(a_mix_takes_the_second_by_amount),
      cmocka_unit_test(problems_name_what_is_wrong),
  };
  return cmocka_run_group_tests_name("layered", tests, NULL, NULL);
}
