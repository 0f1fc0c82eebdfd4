// Every registered light: photons and next-event estimation are two estimators of the same
// irradiance, photons carry all of the power, and the density of directions integrates to 1.
// Each is a z-test of level 1e-5; a patch that receives a share of a tenth or more of the flux
// shows an error of 2 % of one of the two with probability 0.99 (tests/light_statistics.h).
#define _GNU_SOURCE // mkstemp
#include "bvh/bvh.h"
#include "tests/light_cases.h"

enum { SAMPLES = N / 2 };

struct moments {
  double sum, squares;
};

static void add(struct moments *m, double x) {
  m->sum += x;
  m->squares += x * x;
}

// A running sum of SAMPLES terms of one sign is right to SAMPLES roundings.
static const double rounding = SAMPLES * 0x1p-53;

static double average(const struct moments *m) { return m->sum / SAMPLES; }

static double variance(const struct moments *m) {
  double mean = average(m), v = m->squares / SAMPLES - mean * mean;
  return v > 0 ? v / SAMPLES : 0;
}

static void assert_same(const char *what, const struct moments *a, const struct moments *b) {
  double limit = gsl_cdf_ugaussian_Qinv(level / 2), difference = average(a) - average(b);
  double se = sqrt(variance(a) + variance(b));
  if (!(fabs(difference) <= limit * se + rounding * fabs(average(a))))
    fail_msg("%s: %.9g and %.9g: z = %.2f", what, average(a), average(b), difference / se);
}

static void test_every_row_is_here(void **state) {
  (void)state;
  for (const struct light_type *const *type = light_types; *type; type++) {
    bool found = false;
    for (int i = 0; i < N_CASES; i++) found = found || !strcmp(cases[i].row, (*type)->name);
    if (!found) fail_msg("no case of light \"%s\"", (*type)->name);
  }
}

// Photons: irradiance of the patch, and the total.
static void emit_photons(const struct scene *scene, const char *name, const struct patch *patch,
                         struct moments received[3], struct moments total[3]) {
  struct stream stream = stream_begin(name);
  double area = 4 * vec_dot(patch->s, patch->s);
  for (uint64_t j = 0; j < SAMPLES; j++) {
    double u[LIGHT_U];
    struct emission photon;
    stream_read(&stream, j, u);
    scene->light[0].type->emit(scene, &scene->light[0], u, &photon);
    assert_true(fabs(vec_length(photon.ray.d) - 1) < 1e-12 && photon.ray.t_max == INFINITY);
    bool hit = crosses(patch, &photon.ray);
    for (int c = 0; c < 3; c++) {
      add(&received[c], hit ? photon.flux[c] / area : 0);
      add(&total[c], photon.flux[c]);
    }
  }
}

static void connect(const struct scene *scene, const char *name, const struct patch *patch,
                    struct moments irradiance[3]) {
  struct stream stream = stream_begin(name);
  for (uint64_t j = 0; j < SAMPLES; j++) {
    double u[LIGHT_U];
    struct light_sample nee;
    stream_read(&stream, j, u);
    struct vec p = vec_along(patch->centre, patch->s, 2 * u[0] - 1);
    p = vec_along(p, patch->t, 2 * u[1] - 1);
    bool lit = scene->light[0].type->sample(scene, &scene->light[0], p, u + 2, &nee);
    double cosine = lit ? fmax(vec_dot(nee.wi, patch->n), 0) : 0;
    for (int c = 0; c < 3; c++) add(&irradiance[c], lit ? nee.radiance_over_pdf[c] * cosine : 0);
  }
}

static void test_photons_and_connections_agree(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    const struct case_of_light *c = &cases[i];
    struct scene scene = scene_of(c);
    struct patch receiver = patch(c->centre, c->n, c->half);
    struct moments received[3] = {0}, total[3] = {0}, irradiance[3] = {0};
    emit_photons(&scene, arena_format(&arena, "light row photons %d", i), &receiver, received,
                 total);
    connect(&scene, arena_format(&arena, "light row connections %d", i), &receiver, irradiance);
    for (int k = 0; k < 3; k++) {
      const char *what = arena_format(&arena, "%s (case %d), channel %d", c->row, i, k);
      assert_true(average(&received[k]) > 0);
      assert_same(what, &received[k], &irradiance[k]);
      double limit = gsl_cdf_ugaussian_Qinv(level / 2);
      double z = average(&total[k]) - scene.light[0].power[k], se = sqrt(variance(&total[k]));
      if (!(fabs(z) <= limit * se + rounding * scene.light[0].power[k]))
        fail_msg("%s: photons carry %.9g, the power is %.9g", what, average(&total[k]),
                 scene.light[0].power[k]);
    }
  }
}

// The density of a light without a shape that rays can find, over uniform directions.
static void test_densities_integrate_to_one(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of(&cases[i]);
    const struct light *light = &scene.light[0];
    if (!light->type->background) continue;
    struct stream stream = stream_begin(arena_format(&arena, "light row density %d", i));
    struct moments integral = {0};
    for (uint64_t j = 0; j < SAMPLES; j++) {
      double u[LIGHT_U];
      stream_read(&stream, j, u);
      double z = 1 - 2 * u[0], r = sqrt(1 - z * z), phi = 2 * pi * u[1];
      struct vec d = vec(r * cos(phi), r * sin(phi), z);
      add(&integral, 4 * pi * light->type->pdf(&scene, light, vec(0, 0, 0), NULL, d));
    }
    double se = sqrt(variance(&integral)), limit = gsl_cdf_ugaussian_Qinv(level / 2);
    if (!(fabs(average(&integral) - 1) <= limit * se + rounding))
      fail_msg("%s (case %d): %.9g +- %.2g", cases[i].row, i, average(&integral), se);
  }
}

// What `sample` says of its direction is what `pdf` and `background` say of it.
static void test_samples_are_what_rays_meet(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    struct scene scene = scene_of(&cases[i]);
    const struct light *light = &scene.light[0];
    if (!light->type->background) continue;
    struct stream stream = stream_begin(arena_format(&arena, "light row samples %d", i));
    int different = 0; // next to a texel's edge rounding may take the neighbour
    for (uint64_t j = 0; j < BATCH; j++) {
      double u[LIGHT_U], rgb[3];
      struct light_sample nee;
      stream_read(&stream, j, u);
      assert_true(light->type->sample(&scene, light, vec(0, 0, 0), u, &nee));
      double pdf = light->type->pdf(&scene, light, vec(0, 0, 0), NULL, nee.wi);
      light->type->background(&scene, light, nee.wi, rgb);
      bool same = fabs(pdf / nee.pdf_solid_angle - 1) < 1e-12;
      for (int c = 0; c < 3; c++)
        same = same && fabs(rgb[c] - nee.radiance_over_pdf[c] * pdf) <= 1e-12 * rgb[c];
      different += !same;
    }
    assert_true(different <= 1);
  }
}

// ---- what rays see ----

// Radiance along a ray of the scene, with what a see-through surface stops.
static void seen(const struct scene *scene, const struct ray *ray, struct hit hit, double rgb[3]) {
  const struct light *light = &scene->light[0];
  rgb[0] = rgb[1] = rgb[2] = 0;
  if (hit.primitive == PRIMITIVE_NONE) {
    if (light->type->background) light->type->background(scene, light, ray->d, rgb);
    return;
  }
  struct surface surface;
  scene_surface(scene, ray, hit, &surface);
  if (scene->shape[surface.shape].light == LIGHT_NONE) return;
  light->type->radiance(scene, light, &surface, vec_scale(ray->d, -1), rgb);
  double opacity = surface_opacity(scene, &surface);
  for (int c = 0; c < 3; c++) rgb[c] *= opacity;
}

static void look(const struct scene *scene, const char *name, struct vec p,
                 struct moments irradiance[3]) {
  struct stream stream = stream_begin(name);
  struct ray ray[BATCH];
  struct hit hit[BATCH];
  for (uint64_t first = 0; first < SAMPLES; first += BATCH) {
    for (uint64_t j = 0; j < BATCH; j++) {
      double u[LIGHT_U];
      stream_read(&stream, first + j, u);
      double r = sqrt(u[0]), phi = 2 * pi * u[1]; // cosine-weighted about +z
      struct vec d = vec_normalize(vec(r * cos(phi), r * sin(phi), sqrt(1 - u[0])));
      ray[j] = (struct ray){p, d, INFINITY, PRIMITIVE_NONE};
    }
    bvh_closest_brute_force(scene, ray, hit, BATCH);
    for (int j = 0; j < BATCH; j++) {
      double rgb[3];
      seen(scene, &ray[j], hit[j], rgb);
      for (int c = 0; c < 3; c++) add(&irradiance[c], pi * rgb[c]);
    }
  }
}

// Lights that rays can meet, from a point that sees all of their lit side (the cylinder's is not
// met at all, by its alpha of zero).
static void test_rays_and_connections_agree(void **state) {
  (void)state;
  for (int i = 0; i < N_CASES; i++) {
    const struct case_of_light *c = &cases[i];
    struct scene scene = scene_of(c);
    const struct light *light = &scene.light[0];
    if (light->type->delta || strstr(c->text, "cylinder")) continue;
    struct vec p = vec(c->centre.x, c->centre.y, 0.05);
    struct patch point = {.centre = p, .n = vec(0, 0, 1)};
    struct moments by_ray[3] = {0}, by_connection[3] = {0};
    look(&scene, arena_format(&arena, "light row rays %d", i), p, by_ray);
    connect(&scene, arena_format(&arena, "light row point %d", i), &point, by_connection);
    for (int k = 0; k < 3; k++)
      assert_same(arena_format(&arena, "%s (case %d), channel %d", c->row, i, k), &by_ray[k],
                  &by_connection[k]);
  }
}

int main(void) {
  arena = arena_reserve();
  write_image();
  const struct CMUnitTest tests[] = {
      {"every registered light is tested", test_every_row_is_here, NULL, NULL, NULL},
      {"photons and connections give the same irradiance, and photons all of the power",
       test_photons_and_connections_agree, NULL, NULL, NULL},
      {"rays and connections give the same irradiance", test_rays_and_connections_agree, NULL, NULL,
       NULL},
      {"densities of directions integrate to 1", test_densities_integrate_to_one, NULL, NULL, NULL},
      {"a sampled direction is what a ray meets", test_samples_are_what_rays_meet, NULL, NULL,
       NULL},
  };
  int failed = cmocka_run_group_tests_name("light_rows", tests, NULL, NULL);
  remove_image();
  return failed;
}
