// The lights' closed forms against theory 5: Laplacians, box means, the irradiance that next-event
// estimation gives, and where a profile stops being smooth.
#define _GNU_SOURCE // mkstemp
#include "tests/light_fixture.h"

#include <math.h>

static struct arena arena;

static const struct vec up = {0, 0, 1};

static void assert_near(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

// Second differences along s and t: exact for quadratics, error h^2 / 12 times the fourth
// derivatives.
static double laplacian(const struct scene *scene, struct vec p, struct vec n, double h) {
  struct vec s, t;
  vec_basis(n, &s, &t);
  double sum = -4 * light_irradiance(scene, p, n);
  for (int sign = -1; sign <= 1; sign += 2)
    sum += light_irradiance(scene, vec_along(p, s, sign * h), n) +
           light_irradiance(scene, vec_along(p, t, sign * h), n);
  return sum / (h * h);
}

// The mean over the disc of radius r around p in the plane n: midpoint rule in angle (converges
// faster than any power for a smooth profile) and Gauss-Legendre, 5 nodes, in squared radius.
static double box_mean(const struct scene *scene, struct vec p, struct vec n, double r) {
  static const double node[] = {0.046910077030668, 0.2307653449471585, 0.5, 0.7692346550528415,
                                0.953089922969332};
  static const double weight[] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                  0.23931433524968324, 0.11846344252809454};
  enum { PANELS = 8, ANGLES = 64 };
  struct vec s, t;
  vec_basis(n, &s, &t);
  double sum = 0;
  for (int panel = 0; panel < PANELS; panel++)
    for (int k = 0; k < 5; k++)
      for (int j = 0; j < ANGLES; j++) {
        double rho = r * sqrt((panel + node[k]) / PANELS), angle = 2 * pi * (j + 0.5) / ANGLES;
        struct vec q = vec_along(vec_along(p, s, rho * cos(angle)), t, rho * sin(angle));
        sum += weight[k] * light_irradiance(scene, q, n);
      }
  return sum / (PANELS * ANGLES);
}

static void test_uniform(void **state) {
  (void)state;
  struct scene scene =
      light_scene("LightSource \"beam\" \"point3 from\" [0.3 0 1] \"point3 to\" "
                  "[0.3 0 0] \"float radius\" 1.7 \"float power\" 2.385" LIGHT_PLANE,
                  &arena);
  double e = 2.385 / (pi * 1.7 * 1.7);
  assert_near(light_irradiance(&scene, vec(0.3, 1.69, 0), up), e, 1e-15);
  assert_near(light_irradiance(&scene, vec(0.3, 1.71, 0), up), 0, 0);
  assert_near(light_irradiance(&scene, vec(0.3, 0, 0), vec(0, 0, -1)), 0, 0);
  assert_near(light_irradiance(&scene, vec(0.3, 0, 1.1), up), 0, 0);
  assert_near(light_form(&scene, vec(0.3, 0, 0), up).photon_flux[0], 2.385, 0);
}

// Phi / a^4 Delta: -8 / pi, wherever one looks.
static void test_quadratic(void **state) {
  (void)state;
  struct scene scene = light_scene(
      "LightSource \"beam\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"string profile\" "
      "\"quadratic\" \"float radius\" 1.3 \"float power\" 2.385" LIGHT_PLANE,
      &arena);
  double a2 = 1.3 * 1.3, expected = -8 * 2.385 / (pi * a2 * a2);
  assert_near(light_irradiance(&scene, vec(0, 0, 0), up), 2 * 2.385 / (pi * a2), 1e-14);
  for (double x = 0; x < 1.1; x += 0.17) {
    assert_near(laplacian(&scene, vec(x, -0.2, 0), up, 0.1), expected, 1e-11);
    double r = 0.15, mean = box_mean(&scene, vec(x, -0.2, 0), up, r);
    assert_near(mean, light_irradiance(&scene, vec(x, -0.2, 0), up) + expected * r * r / 8, 1e-13);
  }
}

// Tilted by cos = 0.8 the profile is stretched: Delta = 0.8 (-4 Phi / (pi a^4)) (1 + 0.8^2).
static void test_tilted(void **state) {
  (void)state;
  struct scene scene = light_scene(
      "LightSource \"beam\" \"point3 from\" [0 0 4] \"point3 to\" [0 0 0] \"string profile\" "
      "\"quadratic\"" LIGHT_PLANE,
      &arena);
  struct vec n = vec(0.6, 0, 0.8), p = vec(0.24, 0.3, -0.18);
  assert_near(light_irradiance(&scene, p, n), 0.8 * 2 / pi * (1 - 0.24 * 0.24 - 0.09), 1e-15);
  assert_near(laplacian(&scene, p, n, 0.1), -0.8 * 4 / pi * 1.64, 1e-11);
}

static void test_gaussian(void **state) {
  (void)state;
  struct scene scene =
      light_scene("LightSource \"beam\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] "
                  "\"string profile\" \"gaussian\" \"float sigma\" 0.5" LIGHT_PLANE,
                  &arena);
  double s2 = 0.25;
  for (double rho = 0; rho < 2; rho += 0.3) {
    double e = exp(-rho * rho / (2 * s2)) / (2 * pi * s2);
    assert_near(light_irradiance(&scene, vec(0, rho, 0), up), e, 1e-15);
    // h^2 / 12 times the fourth derivatives, which are below 100 / s^4 E(0).
    assert_near(laplacian(&scene, vec(0, rho, 0), up, 1e-3), e * (rho * rho / s2 - 2) / s2, 1e-4);
  }
  for (double r = 0.1; r < 1; r += 0.2)
    assert_near(box_mean(&scene, vec(0, 0, 0), up, r), (1 - exp(-r * r / (2 * s2))) / (pi * r * r),
                1e-12);
}

#define GRATING                                                                                    \
  "LightSource \"beam\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"string profile\" "         \
  "\"cosine\" \"float radius\" 1.1 \"float wavelength\" 0.37 \"float contrast\" 0.8 \"float "      \
  "power\" 2.385 \"vector3 across\" [3 4 7]" LIGHT_PLANE

// 5.95 periods across: the flux through the square is nonetheless Phi. Midpoint rule in x.
static void test_grating_flux(void **state) {
  (void)state;
  struct scene scene = light_scene(GRATING, &arena);
  enum { CELLS = 20000 };
  double sum = 0, a = 1.1, width = 2 * a / CELLS;
  for (int j = 0; j < CELLS; j++) {
    double x = -a + (j + 0.5) * width; // the grating runs along (3, 4) / 5
    sum += light_irradiance(&scene, vec(0.6 * x - 0.8 * 0.2, 0.8 * x + 0.6 * 0.2, 0), up) * width;
  }
  assert_near(sum * 2 * a, 2.385, 1e-6);
}

// The mean over a disc blurs cos(kappa x) by 2 J1(kappa r) / (kappa r).
static void test_grating_blur(void **state) {
  (void)state;
  struct scene scene = light_scene(GRATING, &arena);
  double kappa = 2 * pi / 0.37, a = 1.1;
  double e0 = 2.385 / (4 * a * a * (1 + 0.8 * sin(kappa * a) / (kappa * a)));
  for (double x = -0.5; x < 0.5; x += 0.09)
    for (double r = 0.05; r < 0.5; r += 0.1) {
      double blur = 2 * j1(kappa * r) / (kappa * r);
      assert_near(box_mean(&scene, vec(0.6 * x, 0.8 * x, 0), up, r),
                  e0 * (1 + 0.8 * cos(kappa * x) * blur), 1e-8);
    }
}

// d^2/dy^2: -3 / (2 a^3 w) Phi; in x nothing. Along (4, -3) / 5, as x runs along (3, 4) / 5.
static void test_slab(void **state) {
  (void)state;
  struct scene scene =
      light_scene("LightSource \"beam\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] "
                  "\"string profile\" \"slab\" \"float radius\" 0.7 \"float width\" 1.9 "
                  "\"float power\" 2.385 \"vector3 across\" [3 4 7]" LIGHT_PLANE,
                  &arena);
  double a = 0.7, peak = 0.75 * 2.385 / (a * 1.9);
  for (double x = -0.8; x < 0.81; x += 0.2)
    for (double y = -0.5; y < 0.51; y += 0.25) {
      struct vec p = vec(0.6 * x + 0.8 * y, 0.8 * x - 0.6 * y, 0);
      assert_near(light_irradiance(&scene, p, up), peak * (1 - y * y / (a * a)), 1e-14);
      assert_near(laplacian(&scene, p, up, 0.1), -2 * peak / (a * a), 1e-11);
      double side = 0.95 - fabs(x), edge = a - fabs(y);
      assert_near(light_form(&scene, p, up).clear_radius, side < edge ? side : edge, 1e-14);
    }
  assert_near(light_irradiance(&scene, vec(0.6 * 0.96, 0.8 * 0.96, 0), up), 0, 0);
  assert_near(light_irradiance(&scene, vec(0.8 * 0.71, -0.6 * 0.71, 0), up), 0, 0);
}

#define LAMBERTIAN                                                                                 \
  "LightSource \"point\" \"point3 from\" [0 0 1.3] \"point3 to\" [0 0 0] \"string emission\" "     \
  "\"lambertian\" \"float power\" 2.385" LIGHT_PLANE

// Theory 5 (ii): Phi F / (pi r^2), at the foot -r^2 / (h^2 + r^2) below the truth.
static void test_lambertian(void **state) {
  (void)state;
  struct scene scene = light_scene(LAMBERTIAN, &arena);
  double h2 = 1.3 * 1.3;
  assert_near(light_irradiance(&scene, vec(0, 0, 0), up), 2.385 / (pi * h2), 1e-15);
  for (double rho = 0; rho < 3; rho += 0.4)
    for (double r = 0.1; r < 1; r += 0.2) {
      double d2 = rho * rho, r2 = r * r, sum = d2 + h2 + r2;
      double f = (1 - (d2 + h2 - r2) / sqrt(sum * sum - 4 * d2 * r2)) / 2;
      assert_near(box_mean(&scene, vec(0, rho, 0), up, r), 2.385 * f / (pi * r2), 1e-12);
    }
  assert_near(laplacian(&scene, vec(1.3 / sqrt(2), 0, 0), up, 1e-3), 0, 1e-5); // the zero-bias ring
}

static void test_isotropic(void **state) {
  (void)state;
  struct scene scene = light_scene(
      "LightSource \"point\" \"point3 from\" [0 0 1.3] \"rgb I\" [2 2 2] \"float scale\" "
      "0.7" LIGHT_PLANE,
      &arena);
  double h = 1.3, intensity = 1.4;
  for (double rho = 0; rho < 3; rho += 0.4)
    assert_near(light_irradiance(&scene, vec(rho, 0, 0), up),
                intensity * h / pow(h * h + rho * rho, 1.5), 1e-15);
  for (double r = 0.1; r < 1; r += 0.2) {
    double ratio = 2 * h * h * (1 - h / sqrt(h * h + r * r)) / (r * r);
    assert_near(box_mean(&scene, vec(0, 0, 0), up, r), ratio * intensity / (h * h), 1e-12);
  }
  assert_near(laplacian(&scene, vec(0, h * sqrt(2. / 3), 0), up, 1e-3), 0, 1e-5);
}

#define DISC                                                                                       \
  "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [2.385 2.385 2.385]\nTranslate 0 0 1.3\n" \
  "Rotate 180 1 0 0\nShape \"disk\" \"float radius\" 0.5\nAttributeEnd\n" LIGHT_PLANE

static void test_disc(void **state) {
  (void)state;
  struct scene scene = light_scene(DISC, &arena);
  double h2 = 1.3 * 1.3, r2 = 0.25, l = 2.385;
  assert_near(light_irradiance(&scene, vec(0, 0, 0), up), pi * l * r2 / (r2 + h2), 1e-14);
  assert_near(laplacian(&scene, vec(0, 0, 0), up, 1e-2), -8 * pi * l * h2 * r2 / pow(h2 + r2, 3),
              1e-3);
  for (double r = 0.1; r < 1; r += 0.2) {
    double x = 1 + (h2 + r2) / (r * r), f = (x - sqrt(x * x - 4 * r2 / (r * r))) / 2;
    assert_near(box_mean(&scene, vec(0, 0, 0), up, r), pi * l * f, 1e-12);
  }
  // From far away a Lambertian point; 1 - u / sqrt D would have lost all but two digits.
  double far = light_irradiance(&scene, vec(3000, 0, 0), up);
  assert_near(far / (pi * l * r2 * h2 / pow(9e6 + h2, 2)), 1, 1e-6);
  assert_near(light_irradiance(&scene, vec(0, 0, 1.4), vec(0, 0, -1)), 0, 0); // its dark side
  assert_near(light_form(&scene, vec(0, 0, 0), up).photon_flux[0], pi * l * pi * r2, 1e-14);
}

// The formula is for a full circle and a parallel plane; of anything else nothing is claimed.
static void test_disc_refuses(void **state) {
  (void)state;
  static const char *const shapes[] = {
      "Shape \"disk\" \"float innerradius\" 0.1",
      "Shape \"disk\" \"float phimax\" 359",
      "Scale 1 1.001 1\nShape \"disk\"",
      "Shape \"sphere\"",
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
  };
  struct light_closed_form form;
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
    struct scene scene =
        light_scene(arena_format(&arena, "AreaLightSource \"diffuse\"\n%s\n", shapes[i]), &arena);
    const struct light *light = &scene.light[0];
    assert_false(light->type->closed_form(&scene, light, vec(0, 0, 2), vec(0, 0, -1), &form));
  }
  struct scene scene = light_scene(DISC, &arena);
  const struct light *light = &scene.light[0];
  assert_false(light->type->closed_form(&scene, light, vec(0, 0, 0), vec(0.6, 0, 0.8), &form));
  assert_false(light->type->closed_form(&scene, light, vec(1, 0, 1.3), up, &form));
}

static void test_nee_agrees(void **state) {
  (void)state;
  static const char *const lights[] = {
      "LightSource \"point\" \"point3 from\" [0.2 0.1 1.3]" LIGHT_PLANE,
      LAMBERTIAN,
      "LightSource \"distant\" \"point3 from\" [1 2 3] \"rgb L\" [3 3 3]" LIGHT_PLANE,
      "LightSource \"beam\" \"point3 from\" [1 2 3] \"point3 to\" [0 0 0]" LIGHT_PLANE,
      "LightSource \"beam\" \"point3 from\" [1 2 3] \"point3 to\" [0 0 0] \"string profile\" "
      "\"gaussian\"" LIGHT_PLANE,
      "LightSource \"beam\" \"point3 from\" [1 2 3] \"point3 to\" [0 0 0] \"string profile\" "
      "\"quadratic\" \"float radius\" 3" LIGHT_PLANE,
      GRATING,
      "LightSource \"spot\" \"point3 from\" [0.2 0.1 1.3] \"float coneangle\" 70 \"point3 to\" "
      "[0 0 0] \"float conedeltaangle\" 50" LIGHT_PLANE,
  };
  for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
    struct scene scene = light_scene(lights[i], &arena);
    const struct light *light = &scene.light[0];
    int lit = 0;
    for (int j = 0; j < 100; j++) {
      struct vec p = vec(0.013 * j - 0.7, 0.5 - 0.007 * j, -0.001 * j), n = vec(0.36, -0.48, 0.8);
      struct light_sample nee;
      double u[2] = {0.3, 0.7}, e = 0;
      if (light->type->sample(&scene, light, p, u, &nee)) {
        assert_near(vec_length(nee.wi), 1, 1e-15);
        assert_true(nee.pdf_solid_angle == 0 && nee.distance > 0);
        double cosine = vec_dot(n, nee.wi);
        e = cosine > 0 ? nee.radiance_over_pdf[0] * cosine : 0;
      }
      assert_near(light_irradiance(&scene, p, n), e, 1e-14);
      lit += e > 0;
    }
    assert_true(lit >= 50);
  }
}

static double clear_radius(const char *light, struct vec p, struct vec n) {
  struct scene scene = light_scene(light, &arena);
  return light_form(&scene, p, n).clear_radius;
}

static void test_clear_radius(void **state) {
  (void)state;
  const char *beam = "LightSource \"beam\" \"point3 from\" [0 0 3] \"point3 to\" [0 0 0] \"float "
                     "radius\" 1.5" LIGHT_PLANE;
  assert_near(clear_radius(beam, vec(0.3, 0.4, 0), up), 1, 1e-15);
  assert_near(clear_radius(beam, vec(3, 4, 0), up), 3.5, 1e-15);
  // Tilted to cos = 0.8 the plane meets that of emission 3 / 0.6 away.
  assert_near(clear_radius(beam, vec(0, 9, 0), vec(0.6, 0, 0.8)), 5, 1e-14);
  assert_near(clear_radius(GRATING, vec(0.6 * 0.9, 0.8 * 0.9, 0), up), 0.2, 1e-14);
  assert_near(clear_radius(GRATING, vec(0.6 * 1.4 - 0.8 * 1.5, 0.8 * 1.4 + 0.6 * 1.5, 0), up), 0.5,
              1e-14);
  assert_true(clear_radius(LAMBERTIAN, vec(0.5, 0, 0), up) == INFINITY);
  // The plane n through the point 1.3 below the light's horizon meets it 1.3 / 0.6 away.
  assert_near(clear_radius(LAMBERTIAN, vec(0.5, 0, 0), vec(0.6, 0, 0.8)), 1.3 / 0.6, 1e-14);
  assert_true(clear_radius(DISC, vec(0.5, 0, 0), up) == INFINITY);
  // Across its cone, 20 and 25 degrees: 2 sin 20 on the axis; behind the light, the light itself.
  const char *spot = "LightSource \"spot\" \"point3 from\" [0 0 2] \"point3 to\" [0 0 0] "
                     "\"float coneangle\" 25" LIGHT_PLANE;
  assert_near(clear_radius(spot, vec(0, 0, 0), up), 2 * sin(20 * pi / 180), 1e-14);
  assert_near(clear_radius(spot, vec(2, 0, 0), up), sqrt(8) * sin(20 * pi / 180), 1e-14);
  assert_near(clear_radius(spot, vec(0, 0, 5), up), 3, 1e-14);
}

// Smoothstep in the cosine between 20 and 25 degrees: half of it in the middle.
static void test_spot(void **state) {
  (void)state;
  struct scene scene = light_scene("LightSource \"spot\" \"point3 from\" [0 0 2] \"point3 to\" "
                                   "[0 0 0] \"float coneangle\" 25 \"rgb I\" [3 3 3]" LIGHT_PLANE,
                                   &arena);
  double start = cos(20 * pi / 180), end = cos(25 * pi / 180);
  const struct {
    double cosine, profile;
  } at[] = {{1, 1},
            {start + 1e-9, 1},
            {(start + end) / 2, 0.5},
            {0.75 * end + 0.25 * start, 5. / 32},
            {end - 1e-9, 0},
            {-1, 0}};
  for (int k = 0; k < 6; k++) {
    double sine = sqrt(1 - at[k].cosine * at[k].cosine);
    struct vec p = vec(1.7 * sine, 0, 2 - 1.7 * at[k].cosine), n = vec(-sine, 0, at[k].cosine);
    assert_near(light_irradiance(&scene, p, n), 3 * at[k].profile / (1.7 * 1.7), 1e-13);
  }
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"a uniform beam is Phi / (pi a^2) inside, 0 outside, behind and on the far side",
       test_uniform, NULL, NULL, NULL},
      {"the quadratic beam's Laplacian is -8 Phi / (pi a^4) everywhere", test_quadratic, NULL, NULL,
       NULL},
      {"a tilted plane sees the quadratic beam stretched", test_tilted, NULL, NULL, NULL},
      {"the Gaussian beam has its irradiance, Laplacian and box mean", test_gaussian, NULL, NULL,
       NULL},
      {"the flux of a grating of 5.95 periods is Phi", test_grating_flux, NULL, NULL, NULL},
      {"a disc blurs the grating by 2 J1(kappa r) / (kappa r)", test_grating_blur, NULL, NULL,
       NULL},
      {"the slab beam's Laplacian is -3 Phi / (2 a^3 w), and it has sides", test_slab, NULL, NULL,
       NULL},
      {"the Lambertian point light has theory's box mean anywhere", test_lambertian, NULL, NULL,
       NULL},
      {"the isotropic point light follows cos^3 and theory's box mean at the foot", test_isotropic,
       NULL, NULL, NULL},
      {"the disc light has its axis value, Laplacian and box mean", test_disc, NULL, NULL, NULL},
      {"a closed form is claimed for a full disc and a parallel plane alone", test_disc_refuses,
       NULL, NULL, NULL},
      {"next-event estimation gives the closed form of every delta light", test_nee_agrees, NULL,
       NULL, NULL},
      {"a spot's edge is a smoothstep of the cosine", test_spot, NULL, NULL, NULL},
      {"the clear radius ends at the nearest kink", test_clear_radius, NULL, NULL, NULL},
  };
  return cmocka_run_group_tests_name("light_closed_form", tests, NULL, NULL);
}
