// Mutated scenes are read or refused in one line, and never crash or hang. Most useful under asan.
#include "scene_text.h"

#include <time.h>

static const char *const seeds[] = {
    "LookAt 0 1 -3.4  0 1 0  0 1 0\nCamera \"perspective\" \"float fov\" [38]\n"
    "Film \"rgb\" \"integer xresolution\" [64] \"integer yresolution\" [48] "
    "\"string filename\" \"a\\\"b.pfm\"\nPixelFilter \"box\" \"float xradius\" 0.5\n"
    "Sampler \"stratified\" \"integer xsamples\" 1 \"integer ysamples\" 1 \"bool jitter\" false\n"
    "Integrator \"probabilistic\" \"integer maxdepth\" [64] \"float radius\" .05 \"string kernel\" "
    "[\"box\"]\nWorldBegin\nAttributeBegin\n AreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n"
    " Translate 0 1.5 0 Rotate -90 1 0 0\n Shape \"disk\" \"float radius\" .3 \"float phimax\" "
    "270\n"
    "AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [.7 .6 .5]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-1 0 -1 1 0 -1 1 0 1 "
    "-1 0 1] # floor\n",
    "Transform [1 0 0 0 0 1 0 0 0 0 -1 0 0 -1 6.8 1] ConcatTransform [2 0 0 0 0 1 0 0 0 0 -1 0 0 "
    "-1 6.8 1]\nScale -1 1 1 Identity ColorSpace \"srgb\"\nWorldBegin ReverseOrientation\n"
    "LightSource \"point\" \"rgb I\" [1 2 3] \"point3 from\" [0 5 0] \"float power\" 10\n"
    "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n"
    "Shape \"sphere\" \"float radius\" 1.5e0 \"float zmin\" -1 \"float zmax\" .75\n",
    "Option \"seed\" 17 CoordinateSystem \"a\" TransformTimes 0 1 WorldBegin CoordSysTransform "
    "\"a\"\n"
    "Attribute \"shape\" \"float radius\" 2 \"float alpha\" .5 ActiveTransform All ObjectBegin "
    "\"b\"\n"
    "NamedMaterial \"late\" Translate 1 2 3 Shape \"sphere\" \"float radius\" [.75] Shape "
    "\"disk\"\n"
    "ObjectEnd Scale -1 1 1 ObjectInstance \"b\" TransformBegin ObjectInstance \"b\" TransformEnd\n"
    "Texture \"t\" \"float\" \"constant\" \"float value\" .25 MediumInterface \"\" \"\" Shape "
    "\"disk\"\n"
    "MakeNamedMaterial \"late\" \"string type\" \"diffuse\" Shape \"disk\" \"texture alpha\" "
    "\"t\"\n"
    "LightSource \"point\"\n",
    "MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"float density\" "
    "[1 2] \"point3 p0\" [-1 -1 -1] \"float scale\" 2 MediumInterface \"\" \"a\" WorldBegin "
    "Attribute \"medium\" \"float g\" .5 MakeNamedMedium \"b\" \"string type\" "
    "\"homogeneous\" \"rgb sigma_a\" [1 2 3] \"float Lescale\" 3\n"
    "Material \"interface\" MediumInterface \"b\" Shape \"sphere\" LightSource \"point\"\n",
};

// What an edit may put in: bytes alone rarely make a different token.
static const char *const pieces[] = {
    "\"",
    "[",
    "]",
    "#",
    "\n",
    "-",
    "1e308",
    "1e-320",
    "0",
    "nan",
    "-1",
    "1e400",
    "\\",
    "\x00",
    "\xff",
    "Scale 0 1 1 ",
    "\"float ",
    "360",
    "[[",
    "true",
    " ",
    "AttributeEnd ",
    "AttributeBegin ",
    "ObjectBegin \"a\" ",
    "ObjectEnd ",
    "ActiveTransform EndTime ",
    "4294967296",
    "Shape \"sphere\" ",
    "\"integer indices\" [",
    "99999999999999999999",
};
enum {
  N_SEEDS = (int)(sizeof seeds / sizeof *seeds),
  N_PIECES = (int)(sizeof pieces / sizeof *pieces)
};

static int draw_int(struct draw *draw, int n) { return (int)draw_between(draw, 0, n); }

// Changes the next digit (which often leaves a scene), replaces a byte, cuts a piece out or puts
// one in.
static int mutate(struct draw *draw, char *text, int length) {
  int at = draw_int(draw, length);
  switch (draw_int(draw, 6)) {
  case 0:
    text[at] = (char)draw_int(draw, 256);
    return length;
  case 1: {
    int cut = 1 + draw_int(draw, 8);
    if (at + cut > length) cut = length - at;
    memmove(text + at, text + at + cut, (size_t)(length - at - cut));
    return length - cut;
  }
  case 2: {
    const char *piece = pieces[draw_int(draw, N_PIECES)];
    int n = *piece ? (int)strlen(piece) : 1; // the piece that is a zero byte
    memmove(text + at + n, text + at, (size_t)(length - at));
    memcpy(text + at, piece, (size_t)n);
    return length + n;
  }
  default:
    while (at < length && (text[at] < '0' || text[at] > '9')) at++;
    if (at < length) text[at] = (char)('0' + draw_int(draw, 10));
    return length;
  }
}

static bool is_one_line(const char *text) {
  for (; *text; text++)
    if ((unsigned char)*text < 0x20 && *text != '\t') return false;
  return true;
}

static void check_scene(const struct scene *scene) {
  for (uint32_t k = 0; k < scene->n_positions; k++)
    for (int i = 0; i < 3; i++) assert_true(isfinite(scene->position[k][i]));
  for (uint32_t k = 0; k < scene->n_triangles; k++)
    for (int i = 0; i < 3; i++) assert_true(scene->triangle[k][i] < scene->n_positions);
  for (int i = 0; i < 3; i++) assert_true(scene->bounds.lo[i] <= scene->bounds.hi[i]);
  for (uint32_t k = 0; k < scene->n_lights; k++)
    assert_true(scene->light[k].probability >= 0 && scene->light[k].probability <= 1);
  struct ray ray = camera_ray(&scene->camera, 0.5, 0.5, NULL);
  assert_true(isfinite(ray.o.x) && scene->camera.width > 0);
}

static void mutated_scenes_are_read_or_refused(void **state) {
  (void)state;
  struct draw draw = draw_named("mutated_scenes_are_read_or_refused");
  int accepted = 0;
  for (int s = 0; s < N_SEEDS; s++) scene_of(seeds[s]);
  for (int k = 0; k < 20000; k++) {
    char text[4096];
    int length = (int)strlen(seeds[k % N_SEEDS]), edits = 1 + draw_int(&draw, 4);
    memcpy(text, seeds[k % N_SEEDS], (size_t)length);
    for (int e = 0; e < edits; e++) length = mutate(&draw, text, length);
    struct scene scene;
    struct problem problem;
    if (scene_of_bytes(text, length, &scene, &problem)) {
      accepted++;
      check_scene(&scene);
      assert_true(problem.text[0] == 0);
    } else if (strncmp(problem.text, "t.pbrt:", 7) != 0 || !is_one_line(problem.text)) {
      fail_msg("%s\n%s", text, problem.text);
    }
  }
  assert_true(accepted > 1000 && accepted < 19000); // both ways are exercised
}

static void prefixes_of_a_scene_are_read_or_refused(void **state) {
  (void)state;
  for (int s = 0; s < N_SEEDS; s++)
    for (int length = 0; length <= (int)strlen(seeds[s]); length++) {
      struct scene scene;
      struct problem problem;
      bool ok = scene_of_bytes(seeds[s], length, &scene, &problem);
      assert_true(ok == (problem.text[0] == 0));
    }
}

// Work must grow as the file does: these would take minutes if any of it were quadratic.
static void long_files_take_time_in_proportion(void **state) {
  (void)state;
  static const struct {
    const char *head, *repeated, *tail;
  } cases[] = {
      {"WorldBegin ", "AttributeBegin ", ""},
      {"WorldBegin ", "Shape \"sphere\" ", ""},
      {"WorldBegin ", "Material \"diffuse\" ", "Shape \"sphere\""},
      {"WorldBegin AreaLightSource \"diffuse\" ", "Shape \"disk\" ", ""},
      {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [", "1 ", "]"},
      {"WorldBegin Shape \"sphere\" \"float radius\" ", "1", ""},
      {"WorldBegin ", "Attribute \"shape\" \"float radius\" 1 ", "Shape \"sphere\""},
      {"WorldBegin ObjectBegin \"a\" Shape \"disk\" ObjectEnd ", "ObjectInstance \"a\" ", ""},
      {"WorldBegin ", "CoordinateSystem \"a\" CoordSysTransform \"a\" ", ""},
      {"WorldBegin ", "NamedMaterial \"a\" Shape \"disk\" ", ""},
      {"", "#\n", ""},
      {"", "[", ""},
      {"", "\"", ""},
  };
  enum { LENGTH = 2000000 };
  static char text[LENGTH + 256];
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    int length = (int)strlen(strcpy(text, cases[c].head)), step = (int)strlen(cases[c].repeated);
    for (; length < LENGTH; length += step) memcpy(text + length, cases[c].repeated, (size_t)step);
    strcpy(text + length, cases[c].tail);
    struct scene scene;
    struct problem problem;
    clock_t start = clock();
    scene_of_bytes(text, length + (int)strlen(cases[c].tail), &scene, &problem);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    if (seconds > 10) fail_msg("case %zu took %g s of processor time", c, seconds);
  }
}

// Tens of thousands of names, each found at once.
static void many_names_take_time_in_proportion(void **state) {
  (void)state;
  enum { N_NAMES = 20000, LONGEST = 192 };
  static char text[N_NAMES * LONGEST + 64];
  char *at = text + sprintf(text, "WorldBegin ");
  for (int k = 0; k < N_NAMES; k++)
    at += sprintf(at,
                  "ObjectBegin \"o%d\" ObjectEnd ObjectInstance \"o%d\" NamedMaterial \"m%d\" "
                  "CoordinateSystem \"c%d\"\n",
                  k, N_NAMES - k - 1, k, k);
  for (int k = 0; k < N_NAMES; k++) at += sprintf(at, "CoordSysTransform \"c%d\" ", k);
  struct scene scene;
  struct problem problem;
  clock_t start = clock();
  assert_false(scene_of_bytes(text, at - text, &scene, &problem));
  assert_non_null(strstr(problem.text, "unknown material \"m0\""));
  double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
  if (seconds > 5) fail_msg("%g s of processor time", seconds);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(mutated_scenes_are_read_or_refused),
      cmocka_unit_test(prefixes_of_a_scene_are_read_or_refused),
      cmocka_unit_test(long_files_take_time_in_proportion),
      cmocka_unit_test(many_names_take_time_in_proportion),
  };
  return cmocka_run_group_tests_name("scene_fuzz", tests, NULL, NULL);
}
