// Media as scene files give them: who is in which, grids, bounds of grids.
#include "scene_text.h"

#include <float.h>

#define TWO                                                                                        \
  "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.25 .25 .25]\n"        \
  "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 2 3]\n"
enum { FOG, HAZE };

static void media_are_on_the_sides_of_shapes_and_around_camera_and_lights(void **state) {
  (void)state;
  struct scene scene =
      scene_of(TWO "MediumInterface \"fog\" \"haze\" Camera \"perspective\" WorldBegin\n"
                   "Shape \"sphere\"\n"
                   "AttributeBegin MediumInterface \"fog\" Shape \"disk\" AttributeEnd\n"
                   "AttributeBegin MediumInterface \"\" \"fog\" LightSource \"point\"\n"
                   "LightSource \"infinite\" LightSource \"distant\" Shape \"disk\" AttributeEnd\n"
                   "AttributeBegin MediumInterface \"\" AreaLightSource \"diffuse\" Shape \"disk\" "
                   "AttributeEnd\n"
                   "AttributeBegin AreaLightSource \"diffuse\" Shape \"disk\" AttributeEnd\n");
  static const uint32_t inside[] = {FOG, FOG, MEDIUM_NONE, MEDIUM_NONE, FOG},
                        outside[] = {HAZE, FOG, FOG, MEDIUM_NONE, HAZE},
                        around[] = {FOG, MEDIUM_NONE, MEDIUM_NONE, MEDIUM_NONE, HAZE};
  assert_int_equal(scene.n_media, 2);
  assert_string_equal(scene.medium[HAZE].name, "haze");
  assert_int_equal(scene.camera_medium, HAZE);
  for (int k = 0; k < 5; k++) {
    assert_int_equal(scene.shape[k].inside, inside[k]);
    assert_int_equal(scene.shape[k].outside, outside[k]);
    assert_int_equal(scene.light[k].medium, around[k]);
  }
}

// Instances come last. The mesh, of a triangle and a quad, is two shapes.
static void instances_moving_shapes_and_mixed_meshes_keep_their_media(void **state) {
  (void)state;
  struct scene scene = scene_of(
      TWO "WorldBegin ObjectBegin \"o\" MediumInterface \"haze\" \"fog\" Shape \"sphere\"\n"
          "Material \"interface\" Shape \"disk\" ObjectEnd ObjectInstance \"o\"\n"
          "MediumInterface \"fog\" \"haze\"\n"
          "Shape \"plymesh\" \"string filename\" \"tests/data/meshes/triangle-quad.ply\"\n"
          "ActiveTransform EndTime Translate 0 0 1 ActiveTransform All Shape \"sphere\"\n"
          "ObjectInstance \"o\"");
  assert_int_equal(scene.n_shapes, 7);
  for (uint32_t k = 0; k < 7; k++) {
    assert_int_equal(scene.shape[k].inside, k < 3 ? FOG : HAZE);
    assert_int_equal(scene.shape[k].outside, k < 3 ? HAZE : FOG);
  }
}

static void features_count_the_media_that_are_used(void **state) {
  (void)state;
  struct scene unused = scene_of(TWO "WorldBegin LightSource \"point\" Shape \"sphere\"");
  struct features features = scene_features(&unused);
  assert_false(features.media || features.random_eye);
  assert_true(features.gray);
  struct scene gray = scene_of(TWO "WorldBegin MediumInterface \"fog\" \"\" Shape \"sphere\"");
  features = scene_features(&gray);
  assert_true(features.media && features.random_eye && features.gray);
  struct scene coloured = scene_of(TWO "WorldBegin MediumInterface \"haze\" Shape \"sphere\"");
  features = scene_features(&coloured);
  assert_true(features.media && !features.gray);
  assert_int_equal(features.n_channels, 3);
}

static const struct medium *medium_of(const char *parameters) {
  static struct scene scene;
  char text[2048];
  snprintf(text, sizeof text, "MakeNamedMedium \"a\" %s\nWorldBegin Shape \"sphere\"", parameters);
  scene = scene_of(text);
  return &scene.medium[0];
}

static void assert_spectrum(const double *got, double r, double g, double b) {
  const double wanted[] = {r, g, b};
  for (int c = 0; c < 3; c++)
    if (!(fabs(got[c] - wanted[c]) <= 1e-15 * wanted[c]))
      fail_msg("channel %d is %.17g, not %.17g", c, got[c], wanted[c]);
}

static void coefficients_are_scaled(void **state) {
  (void)state;
  struct medium_point at;
  const struct medium *medium = medium_of("\"string type\" \"homogeneous\"");
  medium->type->at(medium, vec(1, 2, 3), &at);
  assert_spectrum(at.sigma_a, 1, 1, 1);
  assert_spectrum(at.sigma_s, 1, 1, 1);
  assert_spectrum(at.emission, 0, 0, 0);
  assert_true(medium->g == 0);
  medium =
      medium_of("\"string type\" \"homogeneous\" \"rgb sigma_a\" [.5 1 1.5] \"float scale\" 3\n"
                "\"float g\" -.75 \"rgb Le\" [1 2 4] \"float Lescale\" .25");
  medium->type->at(medium, vec(1, 2, 3), &at);
  assert_spectrum(at.sigma_a, 1.5, 3, 4.5);
  assert_spectrum(at.sigma_s, 3, 3, 3);
  assert_spectrum(at.emission, 0.375, 1.5, 4.5);
  assert_true(medium->g == -0.75);
  struct scene scene = scene_of("Attribute \"medium\" \"float g\" .5 \"float scale\" 2\n"
                                "MakeNamedMedium \"a\" \"string type\" \"homogeneous\" "
                                "\"float g\" .25\nWorldBegin Shape \"sphere\"");
  scene.medium[0].type->at(&scene.medium[0], vec(0, 0, 0), &at);
  assert_spectrum(at.sigma_s, 2, 2, 2);
  assert_true(scene.medium[0].g == 0.25);
}

static void a_homogeneous_medium_is_one_piece(void **state) {
  (void)state;
  const struct medium *medium =
      medium_of("\"string type\" \"homogeneous\" \"rgb sigma_a\" [1.5 3 4.5] \"float scale\" 1");
  double end, majorant;
  assert_true(medium->type->piece(medium, &(struct ray){.d = {0, 0, 1}}, 2, &end, &majorant));
  assert_true(end == INFINITY && majorant == 5.5);
}

// pbrt's table of published measurements, per mm.
static void a_preset_overrides_the_coefficients(void **state) {
  (void)state;
  struct medium_point at;
  const struct medium *medium = medium_of(
      "\"string type\" \"homogeneous\" \"string preset\" \"Skimmilk\" \"float scale\" 10");
  medium->type->at(medium, vec(0, 0, 0), &at);
  assert_spectrum(at.sigma_a, 0.014, 0.025, 0.142);
  assert_spectrum(at.sigma_s, 7, 12.2, 19);
}

static double density_at(const struct medium *medium, double x, double y, double z) {
  struct medium_point at;
  medium->type->at(medium, vec(x, y, z), &at);
  return at.sigma_s[0];
}

// By hand: samples at x = 1/4 and 3/4, one along y and z; beyond them it falls to half at a face,
// a quarter at an edge, an eighth at a corner, and outside there is nothing.
static void a_grid_is_interpolated_between_the_centres_of_its_cells(void **state) {
  (void)state;
  const struct medium *medium =
      medium_of("\"string type\" \"uniformgrid\" \"integer nx\" 2 \"float density\" [3 5]");
  static const double wanted[][4] = {
      {.25, .5, .5, 3}, {.75, .5, .5, 5},  {.5, .5, .5, 4},   {.375, .5, .5, 3.5}, {0, .5, .5, 1.5},
      {1, .5, .5, 2.5}, {.25, 0, .5, 1.5}, {.25, 0, 1, .75},  {0, 0, 0, .375},     {1, 1, 1, .625},
      {.5, .25, .5, 3}, {1.01, .5, .5, 0}, {.5, -.01, .5, 0}, {.5, .5, 1.01, 0}};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
    const double *w = wanted[k];
    double got = density_at(medium, w[0], w[1], w[2]);
    if (!(fabs(got - w[3]) < 1e-15)) fail_msg("%g %g %g: %g, not %g", w[0], w[1], w[2], got, w[3]);
  }
}

// The sum over all samples of their tents, in a box that is moved, turned and given by swapped
// corners; lengths stay those of the world, though the box is five times as large.
static void a_grid_is_the_sum_of_its_samples_tents(void **state) {
  (void)state;
  const struct medium *medium = medium_of(
      "\"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 3 \"integer nz\" 2\n"
      "\"float density\" [1 2 3 4 5 6 7 8 9 10 11 12] \"point3 p0\" [3 -1 2] \"point3 p1\" [1 1 "
      "5]\n"
      "\"rgb Le\" [2 2 2] \"float Lescale\" [1 0 0 0 0 0 0 0 0 0 0 0]");
  struct draw draw = draw_named("tents");
  for (int i = 0; i < 1000; i++) {
    double u[3] = {draw_between(&draw, 0, 1), draw_between(&draw, 0, 1), draw_between(&draw, 0, 1)};
    double sum = 0, tent[3], first = 0;
    for (int k = 0; k < 12; k++) {
      const int at[3] = {k % 2, k / 2 % 3, k / 6}, n[3] = {2, 3, 2};
      for (int a = 0; a < 3; a++) tent[a] = fmax(0, 1 - fabs(u[a] * n[a] - 0.5 - at[a]));
      sum += (k + 1) * tent[0] * tent[1] * tent[2];
      if (k == 0) first = tent[0] * tent[1] * tent[2];
    }
    struct vec p = vec(1 + 2 * u[0], -1 + 2 * u[1], 2 + 3 * u[2]);
    struct medium_point at;
    medium->type->at(medium, p, &at);
    if (!(fabs(at.sigma_s[0] - sum) < 1e-12)) fail_msg("%g, not %g", at.sigma_s[0], sum);
    assert_true(fabs(at.emission[0] - 2 * first * sum) < 1e-12);
  }
}

static void a_grid_follows_the_transformation_and_lengths_do_not(void **state) {
  (void)state;
  struct scene scene =
      scene_of("Translate 1 2 3 Rotate 90 0 0 1 Scale 2 4 8\n"
               "MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"integer nx\" 2\n"
               "\"float density\" [3 5] WorldBegin Shape \"sphere\"");
  const struct medium *medium = &scene.medium[0];
  // u -> (1 - 4 u_y, 2 + 2 u_x, 3 + 8 u_z)
  assert_true(fabs(density_at(medium, 1 - 2, 2.5, 7) - 3) < 1e-12);
  assert_true(fabs(density_at(medium, 1 - 2, 3.5, 7) - 5) < 1e-12);
  assert_true(density_at(medium, 1.01, 2.5, 7) == 0);
}

// ---- bounds ----

static double sigma_t_at(const struct medium *medium, const struct ray *ray, double t) {
  struct medium_point at;
  medium->type->at(medium, vec_along(ray->o, ray->d, t), &at);
  double most = 0;
  for (int c = 0; c < 3; c++) most = fmax(most, at.sigma_a[c] + at.sigma_s[c]);
  return most;
}

static void check_at(const struct medium *medium, const struct ray *ray, double t, double most) {
  double sigma_t = sigma_t_at(medium, ray, t);
  if (!(sigma_t <= most))
    fail_msg("sigma_t %.17g > %.17g at t = %.17g of a ray from %g %g %g along %.17g %.17g %.17g",
             sigma_t, most, t, ray->o.x, ray->o.y, ray->o.z, ray->d.x, ray->d.y, ray->d.z);
}

// Every piece ends after it begins, and bounds what is in it, both ends included and their
// neighbours; behind the last there is nothing. Returns the integral of the bound.
static double check_ray(const struct medium *medium, const struct ray *ray, double t,
                        struct draw *draw) {
  double end, majorant, sum = 0;
  int pieces = 0;
  for (; medium->type->piece(medium, ray, t, &end, &majorant); t = end, pieces++) {
    if (!(end > t) || pieces > 60) fail_msg("piece %d from %.17g to %.17g", pieces, t, end);
    assert_true(end < INFINITY);
    sum += (end - t) * majorant;
    const double ends[] = {t, nextafter(t, INFINITY), nextafter(end, 0), end};
    for (int k = 0; k < 4; k++)
      if (ends[k] >= t && ends[k] <= end) check_at(medium, ray, ends[k], majorant);
    for (int k = 0; k < 8; k++) {
      double between = draw_between(draw, t, end);
      check_at(medium, ray, between < end ? between : end, majorant);
    }
  }
  for (int k = 0; k < 8; k++) check_at(medium, ray, t + draw_between(draw, 0, 10), 0);
  return sum;
}

// A grid of n samples, three in four of them empty.
static const struct medium *random_grid(struct draw *draw, int nx, int ny, int nz,
                                        const char *before) {
  static struct scene scene;
  static char text[1 << 18];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "%s\nMakeNamedMedium \"a\" \"string type\" \"uniformgrid\" "
                                 "\"integer nx\" %d \"integer ny\" %d \"integer nz\" %d "
                                 "\"rgb sigma_a\" [.7 .1 0] \"float density\" [",
                                 before, nx, ny, nz);
  for (int k = 0; k < nx * ny * nz; k++)
    used += (size_t)snprintf(text + used, sizeof text - used, "%.9g ",
                             draw_between(draw, 0, 1) < 0.75 ? 0 : draw_between(draw, 0, 3));
  snprintf(text + used, sizeof text - used, "] WorldBegin Shape \"sphere\"");
  scene = scene_of(text);
  return &scene.medium[0];
}

// Starts within, on faces, edges and corners, between the coarse cells, and outside; directions
// with zeros (of both signs) and nearly so.
static struct ray random_ray(struct draw *draw) {
  static const double special[] = {0, 1, 0.5, 0.0625, 0.375, -1, 2};
  struct vec d = draw_direction(draw);
  double o[3], direction[3] = {d.x, d.y, d.z};
  for (int i = 0; i < 3; i++) {
    double kind = draw_between(draw, 0, 4);
    o[i] = kind < 2   ? draw_between(draw, -0.5, 1.5)
           : kind < 3 ? special[(int)draw_between(draw, 0, 7)]
                      : draw_between(draw, 0, 1);
    kind = draw_between(draw, 0, 8);
    if (kind < 1) direction[i] = kind < 0.5 ? 0 : -0.0;
    if (kind > 7) direction[i] *= 1e-15;
    if (kind > 7.9) direction[i] = 5e-324;
  }
  d = vec(direction[0], direction[1], direction[2]);
  if (!(vec_length(d) > 1e-9)) d = vec(0, 0, 1);
  return (struct ray){vec(o[0], o[1], o[2]), vec_normalize(d), INFINITY, PRIMITIVE_NONE};
}

static void bounds_hold_at_every_point_of_their_pieces(void **state) {
  (void)state;
  static const int sizes[][3] = {{1, 1, 1}, {2, 3, 5}, {16, 16, 16}, {17, 4, 33}, {1, 40, 2}};
  struct draw draw = draw_named("bounds");
  for (int s = 0; s < 5; s++) {
    const struct medium *medium = random_grid(&draw, sizes[s][0], sizes[s][1], sizes[s][2], "");
    for (int i = 0; i < 4000; i++) {
      struct ray ray = random_ray(&draw);
      check_ray(medium, &ray, 0, &draw);
      check_ray(medium, &ray, draw_between(&draw, 0, 2), &draw);
    }
  }
}

// The origin is a million, 1e12, 1e15 and 1e18 boxes away, along the ray and across the axes:
// positions are rounded to much more than a cell.
static void bounds_hold_for_rays_from_far_away(void **state) {
  (void)state;
  static const double far[] = {1e6, 1e12, 1e15, 1e18};
  struct draw draw = draw_named("far");
  const struct medium *medium = random_grid(&draw, 20, 20, 20, "");
  for (int i = 0; i < 8000; i++) {
    struct ray ray = random_ray(&draw);
    ray.o = vec_along(ray.o, ray.d, -far[i % 4]);
    check_ray(medium, &ray, 0, &draw);
    check_ray(medium, &ray, far[i % 4] - 1, &draw);
  }
}

static void bounds_hold_in_boxes_that_are_turned_sheared_and_far(void **state) {
  (void)state;
  static const char *const before[] = {
      "Rotate 33 1 2 3 Scale .1 7 3", "ConcatTransform [1 0 0 0 .9 1 0 0 .3 -.8 1 0 5 6 7 1]",
      "Translate 1e7 -1e7 1e7 Rotate 20 1 1 0", "Scale 1e-12 1e12 1"};
  struct draw draw = draw_named("turned");
  for (int b = 0; b < 4; b++) {
    const struct medium *medium = random_grid(&draw, 8, 20, 5, before[b]);
    struct transform world = transform_identity();
    if (b == 2) world = transform_translate(vec(1e7, -1e7, 1e7));
    for (int i = 0; i < 4000; i++) {
      struct ray ray = random_ray(&draw);
      ray.o = transform_point(&world, vec_scale(ray.o, 3));
      check_ray(medium, &ray, 0, &draw);
    }
  }
}

// One sample of 16^3 is not empty: of a ray far from it nothing is bounded by more than zero, and
// one through it pays for the cells it touches, three of sixteen.
static void empty_space_is_bounded_by_zero(void **state) {
  (void)state;
  char text[20000];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "\"string type\" \"uniformgrid\" \"integer nx\" 16 "
                                 "\"integer ny\" 16 \"integer nz\" 16 \"float density\" [");
  for (int k = 0; k < 4096; k++)
    text[used++] = k == 8 + 16 * 8 + 256 * 8 ? '1' : '0', text[used++] = ' ';
  snprintf(text + used, sizeof text - used, "]");
  static char whole[24000];
  snprintf(whole, sizeof whole, "MakeNamedMedium \"a\" %s\nWorldBegin Shape \"sphere\"", text);
  struct scene scene = scene_of(whole);
  struct draw draw = draw_named("empty");
  struct ray past = {vec(-1, 0.2, 0.2), vec(1, 0, 0), INFINITY, PRIMITIVE_NONE};
  struct ray through = {vec(-1, 8.5 / 16, 8.5 / 16), vec(1, 0, 0), INFINITY, PRIMITIVE_NONE};
  assert_true(check_ray(&scene.medium[0], &past, 0, &draw) == 0);
  double optical = check_ray(&scene.medium[0], &through, 0, &draw);
  assert_true(optical > 0 && optical <= 2 * 3.0 / 16 * (1 + 1e-9));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(media_are_on_the_sides_of_shapes_and_around_camera_and_lights),
      cmocka_unit_test(instances_moving_shapes_and_mixed_meshes_keep_their_media),
      cmocka_unit_test(features_count_the_media_that_are_used),
      cmocka_unit_test(coefficients_are_scaled),
      cmocka_unit_test(a_homogeneous_medium_is_one_piece),
      cmocka_unit_test(a_preset_overrides_the_coefficients),
      cmocka_unit_test(a_grid_is_interpolated_between_the_centres_of_its_cells),
      cmocka_unit_test(a_grid_is_the_sum_of_its_samples_tents),
      cmocka_unit_test(a_grid_follows_the_transformation_and_lengths_do_not),
      cmocka_unit_test(bounds_hold_at_every_point_of_their_pieces),
      cmocka_unit_test(bounds_hold_for_rays_from_far_away),
      cmocka_unit_test(bounds_hold_in_boxes_that_are_turned_sheared_and_far),
      cmocka_unit_test(empty_space_is_bounded_by_zero),
  };
  return cmocka_run_group_tests_name("medium", tests, NULL, NULL);
}
