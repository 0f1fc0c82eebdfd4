// `photonlab info` says what a scene uses and which features it lets us skip.
#define _GNU_SOURCE // fmemopen
#include "scene/info.h"
#include "scene/skip.h"
#include "scene_text.h"

static char said[8192];

static void info_of(const char *text) {
  struct scene scene = scene_of(text);
  FILE *out = fmemopen(said, sizeof said, "w");
  scene_info(&scene, out);
  fclose(out);
}

static void assert_says(const char *line) {
  if (!strstr(said, line)) fail_msg("\"%s\" is not in\n%s", line, said);
}

static void what_a_scene_uses_is_listed(void **state) {
  (void)state;
  info_of(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"float scale\" .25\n"
      "\"rgb sigma_a\" [.5 1 2] \"rgb Le\" [3 3 3] \"float g\" -.5 MediumInterface \"\" \"fog\"\n"
      "Camera \"perspective\" WorldBegin MediumInterface \"fog\" \"\"\n"
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [.5 .25 .25]\n"
      "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
      "ObjectBegin \"o\" NamedMaterial \"a\" Shape \"sphere\" Shape \"disk\" ObjectEnd\n"
      "ObjectInstance \"o\" ObjectInstance \"o\" ObjectInstance \"o\" LightSource \"point\"\n"
      "NamedMaterial \"b\" Shape \"sphere\" \"float alpha\" .5\n"
      "Texture \"f\" \"float\" \"constant\" Texture \"f\" \"spectrum\" \"constant\"\n");
  assert_says("1 scene file and all");
  assert_says("shapes       7 with 7 primitives");
  assert_says("  sphere       4 with 4 primitives");
  assert_says("  objects      1, 3 instances");
  assert_says("  alpha        on 1 shapes");
  assert_says("materials    2 named");
  assert_says("on 7 shapes, 1 black, 6 coloured");
  assert_says("textures     2\n  constant             2\n");
  assert_says(
      "media        1 (lengths in scene units)\n"
      "  fog          homogeneous, sigma_a (0.125 0.25 0.5), sigma_s 0.25, emits (0.375 0.75 "
      "1.5), g -0.5\n"
      "               inside of 7 and outside of 0 shapes, around 0 lights and the camera\n");
  assert_says("  colour       yes");
  assert_says("  see-through  yes");
  assert_says("  random eye   yes");
  assert_says("  gray         no");
}

static void what_a_scene_does_not_need_is_said_so(void **state) {
  (void)state;
  info_of("WorldBegin LightSource \"point\" Shape \"sphere\"");
  static const char *const names[] = {"colour",     "motion", "see-through",
                                      "background", "media",  "random"};
  for (int k = 0; k < 6; k++)
    assert_says(arena_format(&test_memory()->lists, "  %-12s no: ", names[k]));
  assert_says("  gray         yes");
  assert_null(strstr(said, "textures"));
  assert_null(strstr(said, "sigma"));
}

static void each_skip_is_listed_and_says_whether_it_applies(void **state) {
  (void)state;
  info_of("WorldBegin LightSource \"point\" Shape \"sphere\"");
  for (int k = 0; k < n_skip_rows; k++)
    assert_says(arena_format(&test_memory()->lists, "\n  %-12s ", skip_rows[k].name));
  assert_says("\n  motion       yes: ");
  assert_says("\n  media        yes: ");
  assert_says("\n  tree         yes: ");
  info_of("WorldBegin LightSource \"point\" ActiveTransform EndTime Translate 1 0 0\n"
          "Shape \"sphere\"");
  assert_says("\n  motion       no, something moves: ");
  assert_says("\n  static-eye   no, ");
}

static void a_grid_says_where_it_is_and_how_dense(void **state) {
  (void)state;
  info_of("Translate 1 2 3 Scale 2 2 2 MakeNamedMedium \"a\" \"string type\" \"uniformgrid\"\n"
          "\"integer nx\" 2 \"float density\" [1 4] \"rgb sigma_a\" [.5 .5 .5] WorldBegin\n"
          "MediumInterface \"a\" \"\" Shape \"sphere\"");
  assert_says("  a            uniformgrid, where it is densest, sigma_a 2, sigma_s 4, g 0\n"
              "               2 x 1 x 1 samples up to 4, within 1 2 3 to 3 4 5\n"
              "               inside of 1 and outside of 0 shapes, around 0 lights\n");
  assert_says("  media        yes");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_a_scene_uses_is_listed),
      cmocka_unit_test(what_a_scene_does_not_need_is_said_so),
      cmocka_unit_test(each_skip_is_listed_and_says_whether_it_applies),
      cmocka_unit_test(a_grid_says_where_it_is_and_how_dense),
  };
  return cmocka_run_group_tests_name("scene_info", tests, NULL, NULL);
}
