// Textures of images: a 4 x 2 gray one of floats and small ones of 8 bits, written here.
#define _GNU_SOURCE // mkdtemp
#include "image/raster.h"
#include "texture_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static struct texture_world world;
static char folder[] = P_tmpdir "/photonlab-imagemap-XXXXXX";

static void write_file(const char *name, const void *bytes, size_t n) {
  FILE *stream = fopen(arena_format(&world.arena, "%s/%s", folder, name), "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(bytes, 1, n, stream), n);
  fclose(stream);
}

// Seen from the top: 10 11 12 13 / 0 1 2 3.
static double gray_texel(int x, int y) { return 10 * (1 - y) + x; }

static void write_images(void) {
  unsigned char file[64] = "Pf 4 2 -1\n";
  float row[8] = {0, 1, 2, 3, 10, 11, 12, 13}; // the bottom one first
  memcpy(file + 10, row, sizeof row);          // little-endian here, as tests/bits runs
  write_file("gray.pfm", file, 10 + sizeof row);
  // Two texels: (200, 100, 50) and (40, 40, 40), 24 bits from the top.
  static const unsigned char colour[] = {0, 0, 2, 0, 0,  0,  0,  0,   0,   0,  0,  0,
                                         2, 0, 1, 0, 24, 32, 50, 100, 200, 40, 40, 40};
  write_file("colour.tga", colour, sizeof colour);
  static const unsigned char shades[] = {0, 0, 2, 0, 0,  0,  0, 0, 0, 0,  0,  0,
                                         2, 0, 1, 0, 24, 32, 7, 7, 7, 40, 40, 40};
  write_file("shades.tga", shades, sizeof shades);
}

static struct texture image(bool spectrum, const char *filename, const char *text) {
  return make_texture(&world, "image", spectrum, "imagemap",
                      arena_format(&world.arena, "\"string filename\" \"%s\" %s", filename, text));
}

// The image's texel x, y has its centre at s = (x + 0.5) / 4, t = 1 - (y + 0.5) / 2.
static void texels_have_centres_and_the_bottom_row_is_at_zero(void **state) {
  (void)state;
  for (int point = 0; point < 2; point++) {
    struct texture texture = image(false, "gray.pfm", point ? "\"string filter\" \"point\"" : "");
    for (int y = 0; y < 2; y++)
      for (int x = 0; x < 4; x++)
        for (int period = -2; period <= 2; period++) {
          struct vec value =
              texture_at_uv(texture, (x + 0.5) / 4 + period, 1 - (y + 0.5) / 2 - period);
          assert_near(value.x, gray_texel(x, y), 20);
        }
  }
}

static void lookups_are_bilinear_or_nearest(void **state) {
  (void)state;
  static const char *const smooth[] = {"bilinear", "trilinear", "ewa", "EWA"};
  for (int k = 0; k < 4; k++) {
    struct texture texture =
        image(false, "gray.pfm",
              arena_format(&world.arena, "\"string filter\" \"%s\" \"float maxanisotropy\" 4",
                           smooth[k]));
    assert_near(texture_at_uv(texture, 1.75 / 4, 0.5 / 2).x, 1.25, 20);
    assert_near(texture_at_uv(texture, 1.75 / 4, 1.1 / 2).x, 1.25 + 6, 20);
    assert_near(texture_at_uv(texture, 3.75 / 4, 0.5 / 2).x, 0.75 * 3, 20); // then 0 again
  }
  struct texture texture = image(false, "gray.pfm", "\"string filter\" \"point\"");
  assert_near(texture_at_uv(texture, 1.99 / 4, 0.01).x, 1, 20);
  assert_near(texture_at_uv(texture, 2.01 / 4, 0.01).x, 2, 20);
}

// Texels outside the image, as pbrt's RemapPixelCoords has them.
static void wrapping_repeats_clamps_blackens_and_folds(void **state) {
  (void)state;
  static const char *const wrap[] = {"repeat", "clamp", "black", "octahedralsphere"};
  static const struct {
    int x, y; // from the top left
    double expected[4];
  } row[] = {
      {-1, 0, {13, 10, 0, 1}}, // octahedral: column 1 of the other row
      {4, 0, {10, 13, 0, 3}},  // column 3 of the other row
      {1, -1, {1, 11, 0, 2}},  // column 2 of row 1
      {2, 2, {12, 2, 0, 1}},   // column 1 of row 1
      {-3, 1, {1, 0, 0, 13}},  // column 3 of row 0
      {9, 5, {1, 3, 0, NAN}},  // octahedral maps have no second period
  };
  for (int w = 0; w < 4; w++) {
    struct texture texture =
        image(false, "gray.pfm", arena_format(&world.arena, "\"string wrap\" \"%s\"", wrap[w]));
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
      double value = texture_at_uv(texture, (row[k].x + 0.5) / 4, 1 - (row[k].y + 0.5) / 2).x;
      if (isnan(row[k].expected[w]))
        assert_true(isfinite(value));
      else
        assert_near(value, row[k].expected[w], 20);
    }
    assert_true(isfinite(texture_at_uv(texture, 1e300, -1e300).x));
    assert_true(isfinite(texture_at_uv(texture, -1e17, 1e17).x));
  }
}

static double srgb(int byte) {
  return encoding_decode((struct encoding){ENCODING_SRGB, 1}, byte / 255.0);
}

static void scale_invert_and_channels(void **state) {
  (void)state;
  double r = srgb(200), g = srgb(100), b = srgb(50);
  struct vec value = texture_at_uv(image(true, "colour.tga", ""), 0.25, 0.5);
  assert_near(value.x, r, 1);
  assert_near(value.y, g, 1);
  assert_near(value.z, b, 1);
  value =
      texture_at_uv(image(true, "colour.tga", "\"float scale\" 3 \"bool invert\" true"), 0.25, 0.5);
  assert_true(value.x == 0); // 1 - 3 r < 0
  assert_near(value.y, 1 - 3 * g, 1);
  value = texture_at_uv(image(false, "colour.tga", "\"float scale\" 3"), 0.25, 0.5);
  assert_near(value.x, r + g + b, 1); // three times the mean
  assert_true(value.x == value.y && value.x == value.z);
  value = texture_at_uv(image(false, "colour.tga", "\"string filter\" \"point\""), 0.25, 0.5);
  assert_near(value.x, r, 1);
  value = texture_at_uv(image(true, "gray.pfm", ""), 0.5 / 4, 0.5 / 2);
  assert_true(value.x == 0 && value.y == 0 && value.z == 0);
  value = texture_at_uv(image(true, "gray.pfm", ""), 1.5 / 4, 0.5 / 2);
  assert_true(value.x == 1 && value.y == 1 && value.z == 1);
  value = texture_at_uv(image(false, "gray.pfm", "\"float uscale\" 2 \"float vdelta\" .5"), 1.5 / 8,
                        0.25);
  assert_near(value.x, 11, 20);
}

// pbrt multiplies an image's own scale by a constant factor: what is inverted is the product.
static void a_constant_factor_comes_before_invert(void **state) {
  (void)state;
  make_texture(&world, "half", false, "constant", "\"float value\" .5");
  static const char inverted[] = "\"string filename\" \"colour.tga\" \"bool invert\" true";
  double g = srgb(100), mean = (srgb(200) + g + srgb(50)) / 3;
  make_texture(&world, "dark", true, "imagemap", inverted);
  make_texture(&world, "dark", false, "imagemap", inverted);
  static const char *const by[] = {"\"texture tex\" \"dark\" \"float scale\" .5",
                                   "\"texture tex\" \"dark\" \"texture scale\" \"half\"",
                                   "\"texture scale\" \"dark\" \"float tex\" .5"};
  for (int k = 0; k < 2; k++)
    assert_near(texture_at_uv(make_texture(&world, "s", true, "scale", by[k]), 0.25, 0.5).y,
                1 - 0.5 * g, 1);
  for (int k = 0; k < 3; k++)
    assert_near(texture_at_uv(make_texture(&world, "s", false, "scale", by[k]), 0.25, 0.5).x,
                1 - 0.5 * mean, 1);
  // Not constant: what is inverted is the image alone.
  make_texture(&world, "board", false, "checkerboard", "\"float tex1\" .5");
  struct texture texture = make_texture(&world, "s", true, "scale",
                                        "\"texture tex\" \"dark\" \"texture scale\" \"board\"");
  assert_near(texture_at_uv(texture, 0.25, 0.5).y, 0.5 * (1 - g), 1);
}

static void gray_is_said_of_all_texels(void **state) {
  (void)state;
  static const struct {
    const char *filename;
    bool spectrum, gray;
  } row[] = {{"gray.pfm", true, true},
             {"shades.tga", true, true},
             {"colour.tga", true, false},
             {"colour.tga", false, true}};
  for (int k = 0; k < 4; k++) {
    struct texture texture = image(row[k].spectrum, row[k].filename, "");
    assert_int_equal(texture.type->is_gray(&texture), row[k].gray);
  }
}

static void a_file_is_read_once_and_counts_in_the_hash(void **state) {
  (void)state;
  struct texture_world other;
  texture_world_begin(&other, world.builder.folder);
  uint64_t hash = other.scene.hash;
  static const char text[] = "\"string filename\" \"colour.tga\"";
  make_texture(&other, "a", true, "imagemap", text);
  assert_true(other.scene.hash != hash);
  hash = other.scene.hash;
  make_texture(&other, "b", true, "imagemap", text);
  make_texture(&other, "c", false, "imagemap", text);
  assert_true(other.scene.hash == hash);
  make_texture(&other, "d", false, "imagemap", "\"string filename\" \"shades.tga\"");
  assert_true(other.scene.hash != hash);
  arena_release(other.arena);
}

static void what_cannot_be_is_refused_with_its_place(void **state) {
  (void)state;
  static const struct {
    const char *text, *says;
  } row[] = {
      {"", "imagemap needs \"string filename\""},
      {"\"string filename\" \"none.png\"", "none.png: cannot open it"},
      {"\"string filename\" \"bad.png\"", "bad.png: not a png file we can read"},
      {"\"string filename\" \"gray.pfm\" \"string wrap\" \"mirror\"", "\"mirror\" does not wrap"},
      {"\"string filename\" \"gray.pfm\" \"string filter\" \"box\"", "\"box\" is no filter"},
      {"\"string filename\" \"gray.pfm\" \"string encoding\" \"srgb\"", "\"srgb\" is no encoding"},
      {"\"string filename\" \"gray.pfm\" \"float gamma\" 2", "gamma"},
  };
  write_file("bad.png", "not a png at all", 16);
  for (size_t k = 0; k < sizeof row / sizeof *row; k++)
    assert_texture_refused(&world, true, "imagemap", row[k].text, row[k].says);
}

int main(void) {
  if (!mkdtemp(folder)) die("cannot make %s", folder);
  texture_world_begin(&world, NULL);
  world.builder.folder = arena_format(&world.arena, "%s/", folder);
  write_images();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(texels_have_centres_and_the_bottom_row_is_at_zero),
      cmocka_unit_test(lookups_are_bilinear_or_nearest),
      cmocka_unit_test(wrapping_repeats_clamps_blackens_and_folds),
      cmocka_unit_test(scale_invert_and_channels),
      cmocka_unit_test(a_constant_factor_comes_before_invert),
      cmocka_unit_test(gray_is_said_of_all_texels),
      cmocka_unit_test(a_file_is_read_once_and_counts_in_the_hash),
      cmocka_unit_test(what_cannot_be_is_refused_with_its_place),
  };
  int failed = cmocka_run_group_tests_name("texture_imagemap", tests, NULL, NULL);
  static const char *const name[] = {"gray.pfm", "colour.tga", "shades.tga", "bad.png"};
  for (int k = 0; k < 4; k++) unlink(arena_format(&world.arena, "%s/%s", folder, name[k]));
  rmdir(folder);
  return failed;
}
