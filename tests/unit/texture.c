// Textures without images: what they are by their formulas, what they say of themselves, and what
// they refuse.
#include "texture_text.h"

static struct texture_world world;

static const struct surface somewhere = {
    .p = {0.3, -1.7, 2.385}, .ng = {0, 0.6, 0.8}, .uv = {0.3125, 1.75}};

static void assert_value(struct texture texture, double r, double g, double b) {
  struct vec value = texture_at(texture, &somewhere);
  assert_near(value.x, r, 1);
  assert_near(value.y, g, 1);
  assert_near(value.z, b, 1);
}

static void constants_are_one_value(void **state) {
  (void)state;
  assert_value(make_texture(&world, "a", false, "constant", "\"float value\" 2.385"), 2.385, 2.385,
               2.385);
  assert_value(make_texture(&world, "b", true, "constant", "\"rgb value\" [.1 .2 .3]"), .1, .2, .3);
  assert_value(make_texture(&world, "c", false, "constant", ""), 1, 1, 1);
  assert_value(make_texture(&world, "d", true, "constant", ""), 1, 1, 1);
}

static void scale_multiplies(void **state) {
  (void)state;
  make_texture(&world, "half", false, "constant", "\"float value\" .5");
  make_texture(&world, "colour", true, "constant", "\"rgb value\" [.1 .2 .3]");
  assert_value(make_texture(&world, "a", true, "scale",
                            "\"texture tex\" \"colour\" \"texture scale\" \"half\""),
               .05, .1, .15);
  assert_value(make_texture(&world, "b", false, "scale", "\"float tex\" .5 \"float scale\" 3"), 1.5,
               1.5, 1.5);
  assert_value(make_texture(&world, "c", true, "scale", ""), 1, 1, 1);
}

static void mix_interpolates(void **state) {
  (void)state;
  assert_value(make_texture(&world, "a", true, "mix",
                            "\"rgb tex1\" [.1 .2 .3] \"rgb tex2\" [.5 .5 .5] \"float amount\" .25"),
               .2, .275, .35);
  assert_value(make_texture(&world, "b", false, "mix", ""), .5, .5, .5);
  assert_value(make_texture(&world, "c", false, "mix", "\"float amount\" .25"), .25, .25, .25);
}

// The normal (0, 0.6, 0.8) against the direction in world space.
static void directionmix_goes_by_the_normal(void **state) {
  (void)state;
  static const char both[] = "\"float tex1\" 2 \"float tex2\" 5 \"vector3 dir\" [0 0 -3]";
  assert_value(make_texture(&world, "a", false, "directionmix", ""), .4, .4, .4);
  assert_value(make_texture(&world, "b", false, "directionmix", both), 2.6, 2.6, 2.6);
  world.builder.world_from_object = transform_rotate(90, vec(1, 0, 0)); // y becomes z
  assert_value(make_texture(&world, "c", false, "directionmix", ""), .2, .2, .2);
  world.builder.world_from_object = transform_identity();
}

static void bilerp_has_its_corners(void **state) {
  (void)state;
  struct texture texture = make_texture(
      &world, "a", true, "bilerp",
      "\"rgb v00\" [1 0 0] \"rgb v01\" [2 0 0] \"rgb v10\" [3 1 0] \"rgb v11\" [7 0 0]");
  static const double corner[4][3] = {{0, 0, 1}, {0, 1, 2}, {1, 0, 3}, {1, 1, 7}};
  for (int k = 0; k < 4; k++)
    assert_near(texture_at_uv(texture, corner[k][0], corner[k][1]).x, corner[k][2], 1);
  assert_near(texture_at_uv(texture, .25, .5).x, .75 * 1.5 + .25 * 5, 1);
  assert_near(texture_at_uv(texture, .25, .5).y, .25 * .5, 1);
  assert_near(texture_at_uv(make_texture(&world, "b", false, "bilerp", ""), .25, .3).x, .3, 1);
}

static void checkerboards_alternate_on_both_sides_of_zero(void **state) {
  (void)state;
  struct texture flat = make_texture(
      &world, "flat", true, "checkerboard",
      "\"float uscale\" 2 \"float vscale\" 4 \"rgb tex1\" [.1 .2 .3] \"rgb tex2\" [.4 .5 .6]");
  world.builder.world_from_object =
      transform_multiply(transform_translate(vec(5, 0, 0)), transform_scale(vec(2, 2, 2)));
  struct texture solid =
      make_texture(&world, "solid", false, "checkerboard", "\"integer dimension\" 3");
  world.builder.world_from_object = transform_identity();
  for (int i = -5; i < 5; i++)
    for (int j = -5; j < 5; j++) {
      bool second = (i + j) % 2 != 0;
      assert_near(texture_at_uv(flat, (i + .3) / 2, (j + .9) / 4).z, second ? .6 : .3, 1);
      for (int k = -5; k < 5; k++) {
        struct vec value = texture_at_p(solid, 5 + 2 * (i + .3), 2 * (j + .01), 2 * (k + .99));
        assert_true(value.x == ((i + j + k) % 2 == 0)); // default: 1, beside it 0
      }
    }
}

static void mappings_are_pbrts(void **state) {
  (void)state;
  static const char unit[] = "\"float v00\" 0 \"float v10\" 1 \"float v01\" 0 \"float v11\" 1 ",
                    across[] = "\"float v00\" 0 \"float v10\" 0 \"float v01\" 1 \"float v11\" 1 ";
  static const struct {
    const char *text;
    double s, t; // of the point below
  } row[] = {
      {"", 0.25, -1.5},
      {"\"string mapping\" \"uv\" \"float uscale\" 3 \"float vscale\" -2 \"float udelta\" .5 "
       "\"float vdelta\" 7",
       1.25, 10},
      // (3, -3, -3 sqrt 2) in texture space: theta = 135, phi = 315 degrees.
      {"\"string mapping\" \"spherical\"", .75, .875},
      {"\"string mapping\" \"cylindrical\"", .375, -4.242640687119285},
      {"\"string mapping\" \"planar\" \"vector3 v1\" [1 2 0] \"vector3 v2\" [-2 0 0] "
       "\"float udelta\" .5",
       -2.5, -6},
      {"\"string mapping\" \"planar\"", 3, -3},
  };
  // World = 2 texture + (0, 0, 1).
  world.builder.world_from_object =
      transform_multiply(transform_translate(vec(0, 0, 1)), transform_scale(vec(2, 2, 2)));
  struct surface surface = {.p = {6, -6, 1 - 2 * 4.242640687119285}, .uv = {.25, -1.5}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    const char *s = arena_format(&world.arena, "%s%s", unit, row[k].text);
    const char *t = arena_format(&world.arena, "%s%s", across, row[k].text);
    assert_near(texture_at(make_texture(&world, "s", false, "bilerp", s), &surface).x, row[k].s,
                16);
    assert_near(texture_at(make_texture(&world, "t", false, "bilerp", t), &surface).x, row[k].t,
                16);
  }
  world.builder.world_from_object = transform_identity();
}

// Of every type: colours only where an input has colours.
static void gray_is_said_exactly(void **state) {
  (void)state;
  static const struct {
    const char *type, *text;
    bool gray;
  } row[] = {
      {"constant", "\"rgb value\" [.2 .2 .2]", true},
      {"constant", "\"rgb value\" [.2 .2 .3]", false},
      {"scale", "\"rgb tex\" [.2 .2 .2] \"float scale\" 3", true},
      {"scale", "\"rgb tex\" [.2 .3 .2]", false},
      {"mix", "\"rgb tex1\" [.2 .2 .2]", true},
      {"mix", "\"rgb tex2\" [.2 .3 .2]", false},
      {"directionmix", "", true},
      {"directionmix", "\"rgb tex1\" [.2 .3 .2]", false},
      {"bilerp", "", true},
      {"bilerp", "\"rgb v10\" [.2 .3 .2]", false},
      {"checkerboard", "", true},
      {"checkerboard", "\"rgb tex2\" [.2 .3 .2]", false},
      {"dots", "\"rgb inside\" [.2 .2 .2]", true},
      {"dots", "\"rgb outside\" [.2 .3 .2]", false},
      {"dots", "\"texture outside\" \"tinted\"", false},
      {"marble", "", false},
  };
  make_texture(&world, "tinted", true, "constant", "\"rgb value\" [.2 .2 .3]");
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    struct texture texture = make_texture(&world, "g", true, row[k].type, row[k].text);
    assert_int_equal(texture.type->is_gray(&texture), row[k].gray);
  }
}

// Whatever is registered gives three equal numbers as a float, and only takes what it knows.
static void every_type_is_a_float_or_a_spectrum(void **state) {
  (void)state;
  for (int k = 0; texture_types[k]; k++) {
    const char *type = texture_types[k]->name;
    assert_true(type && texture_types[k]->about);
    if (strcmp(type, "imagemap") == 0) continue;
    struct texture texture;
    struct problem problem;
    bool a_float = try_texture(&world, "f", false, type, "", &texture, &problem);
    if (a_float) {
      struct vec value = texture_at(texture, &somewhere);
      assert_true(value.x == value.y && value.x == value.z && isfinite(value.x));
      assert_true(texture.type->is_gray(&texture));
    }
    assert_true(try_texture(&world, "s", true, type, "", &texture, &problem) || a_float);
    assert_texture_refused(&world, !a_float, type, "\"float nonsense\" 1", "nonsense");
  }
}

static void what_cannot_be_is_refused_with_its_place(void **state) {
  (void)state;
  static const struct {
    bool spectrum;
    const char *type, *text, *says;
  } row[] = {
      {false, "scale", "\"texture tex\" \"none\"", "there is no texture \"none\""},
      {true, "constant", "\"rgb value\" [.1 -1 0]", "must not be negative"},
      {false, "checkerboard", "\"integer dimension\" 4",
       "t.pbrt:1:1: Texture \"checkerboard\": \"dimension\" is 2 or 3"},
      {false, "bilerp", "\"string mapping\" \"cube\"", "\"cube\" is no mapping"},
      {false, "bilerp", "\"string mapping\" \"planar\" \"vector3 v1\" [1 0 0 0 1 0]", "one vector"},
      {false, "bilerp", "\"float v1\" 2", "v1"},
      {false, "directionmix", "\"vector3 dir\" [0 0 0]", "has no direction"},
      {true, "fbm", "", "there are only float textures of this type"},
      {false, "marble", "", "there are only spectrum textures of this type"},
      {false, "wrinkled", "\"integer octaves\" 2000000000", "\"octaves\" is from 0 to 64"},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++)
    assert_texture_refused(&world, row[k].spectrum, row[k].type, row[k].text, row[k].says);
  world.builder.world_from_object = transform_scale(vec(1, 0, 1));
  assert_texture_refused(&world, false, "fbm", "", "has no inverse");
  make_texture(&world, "flat", false, "checkerboard", ""); // needs no space
  world.builder.world_from_object = transform_identity();
}

int main(void) {
  texture_world_begin(&world, NULL);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(constants_are_one_value),
      cmocka_unit_test(scale_multiplies),
      cmocka_unit_test(mix_interpolates),
      cmocka_unit_test(directionmix_goes_by_the_normal),
      cmocka_unit_test(bilerp_has_its_corners),
      cmocka_unit_test(checkerboards_alternate_on_both_sides_of_zero),
      cmocka_unit_test(mappings_are_pbrts),
      cmocka_unit_test(gray_is_said_exactly),
      cmocka_unit_test(every_type_is_a_float_or_a_spectrum),
      cmocka_unit_test(what_cannot_be_is_refused_with_its_place),
  };
  return cmocka_run_group_tests_name("texture", tests, NULL, NULL);
}
