// Noise and the textures made of it. Expected values: pbrt's definition in exact rational
// arithmetic (the first point's is also published for Perlin's program), the marble's colour by de
// Casteljau.
#include "scene/noise.h"
#include "texture_text.h"

static struct texture_world world;

static void noise_has_its_exact_values(void **state) {
  (void)state;
  static const double row[][4] = {
      {3.14, 42.0, 7.0, 0.13691995878400012},
      {0.5, 0.5, 0.5, -0.125},
      {-1.25, 300.125, -77.6875, 0.047422547810398896},
      {255.75, -0.125, 511.5, -0.53178001940250397},
      {-1000.3, 12.7, 0.1, -0.25715814188665143},
  };
  // The arguments as doubles are what the exact values are of; the fractions' rounding is 1e-13.
  for (size_t k = 0; k < sizeof row / sizeof *row; k++)
    assert_near(noise(row[k][0], row[k][1], row[k][2]), row[k][3], 10);
}

static void noise_is_zero_at_lattice_points_and_repeats_every_256(void **state) {
  (void)state;
  for (int k = -300; k < 300; k++) {
    assert_true(noise(k, 7 * k, -3 * k) == 0);
    double x = 0.375 * k, y = 0.125 * k, z = 0.8125 * k;
    assert_true(noise(x, y, z) == noise(x + 256, y - 512, z + 768));
  }
  assert_true(isfinite(noise(1e30, -1e300, 0.5)));
}

static void octaves_add_up(void **state) {
  (void)state;
  struct vec p = {0.3125, -2.71875, 5.4375};
  assert_near(noise_fbm(p, 0.5, 8), -0.37917477255077081, 100);
  assert_near(noise_fbm(p, 0.75, 3), -0.41456901387620976, 100);
  assert_near(noise_turbulence(p, 0.5, 8), 0.91731873561904631, 100);
  assert_near(noise_turbulence(p, 0.75, 3), 1.2430766996437401, 100);
  assert_true(noise_fbm(p, 0.5, 0) == 0);
}

static void textures_of_noise_are_in_their_space(void **state) {
  (void)state;
  static const struct {
    bool spectrum;
    const char *type, *text;
    double first, last;
  } row[] = {
      {false, "fbm", "", -0.37917477255077081, -0.37917477255077081},
      {false, "fbm", "\"integer octaves\" 3 \"float roughness\" .75", -0.41456901387620976,
       -0.41456901387620976},
      {false, "wrinkled", "", 0.91731873561904631, 0.91731873561904631},
      {false, "windy", "", -0.22395380976440338, -0.22395380976440338},
      {true, "marble", "\"float scale\" 2", 0.75266466766658802, 0.81663015860520738},
  };
  world.builder.world_from_object =
      transform_multiply(transform_translate(vec(1, 2, 3)), transform_scale(vec(2, 2, -2)));
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    struct texture texture = make_texture(&world, "n", row[k].spectrum, row[k].type, row[k].text);
    struct vec value = texture_at_p(texture, 1 + 2 * 0.3125, 2 - 2 * 2.71875, 3 - 2 * 5.4375);
    assert_near(value.x, row[k].first, 100);
    assert_near(value.z, row[k].last, 100);
  }
  world.builder.world_from_object = transform_identity();
}

static void dots_are_in_their_cells(void **state) {
  (void)state;
  static const double centre[][2] = {
      {-2.9980452, -2.0197340000000001},         {-3.0551064000000001, 0.97031920000000005},
      {-2.0488076, -2.0128279999999998},         {-0.98375440000000003, -1.010656},
      {-1.0655452000000001, 2.0388031999999998}, {0.054454799999999998, -2.9752703999999999}};
  static const double empty[][2] = {{-3, -3}, {-3, -1}, {-3, 0}, {-3, 2}, {-3, 3}, {-2, -3}};
  struct texture dots =
      make_texture(&world, "dots", false, "dots", "\"float inside\" .75 \"float outside\" .25");
  for (int k = 0; k < 6; k++) {
    for (int side = 0; side < 4; side++) {
      double s = (side & 1 ? -1 : 1) * (side & 2 ? 0.6 : 0.8), t = side & 2 ? 0.8 : 0.6;
      double u = centre[k][0], v = centre[k][1];
      assert_true(texture_at_uv(dots, u + 0.3499 * s, v + 0.3499 * t).x == .75);
      assert_true(texture_at_uv(dots, u + 0.3501 * s, v + 0.3501 * t).x == .25);
    }
    assert_true(texture_at_uv(dots, empty[k][0], empty[k][1]).x == .25);
  }
}

int main(void) {
  texture_world_begin(&world, NULL);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(noise_has_its_exact_values),
      cmocka_unit_test(noise_is_zero_at_lattice_points_and_repeats_every_256),
      cmocka_unit_test(octaves_add_up),
      cmocka_unit_test(textures_of_noise_are_in_their_space),
      cmocka_unit_test(dots_are_in_their_cells),
  };
  return cmocka_run_group_tests_name("texture_noise", tests, NULL, NULL);
}
