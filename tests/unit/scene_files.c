// Include and Import, on disk.
#define _GNU_SOURCE // mkdtemp
#include "base/file.h"
#include "scene_text.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0]\n"

static char folder[] = P_tmpdir "/photonlab-scene-XXXXXX";

static char *path_of(const char *name) {
  return arena_format(&test_memory()->lists, "%s/%s", folder, name);
}

static void put(const char *name, const char *text) {
  FILE *file = fopen(path_of(name), "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static bool read_as(const char *name, struct scene *scene, struct problem *problem) {
  struct arena keep = test_memory()->keep;
  *problem = (struct problem){{0}};
  return scene_read(path_of(name), &keep, scene, problem);
}

static struct scene read_scene(const char *name) {
  struct scene scene;
  struct problem problem;
  if (!read_as(name, &scene, &problem)) fail_msg("%s", problem.text);
  return scene;
}

static void assert_problem(const char *name, const char *place, const char *words) {
  struct scene scene;
  struct problem problem;
  assert_false(read_as(name, &scene, &problem));
  const char *begin = path_of(place);
  if (strncmp(problem.text, begin, strlen(begin)) != 0 || !strstr(problem.text, words))
    fail_msg("%s\nis not %s: %s", problem.text, begin, words);
}

static void an_included_file_is_read_in_place(void **state) {
  (void)state;
  put("main.pbrt", "WorldBegin Include \"part/a.pbrt\"\n" TRIANGLE "AttributeEnd\n" TRIANGLE);
  // Names are relative to the scene's folder, as in pbrt, not to the folder of part/a.pbrt.
  put("part/a.pbrt", "AttributeBegin Translate 5 0 0 Include \"part/b.pbrt\"");
  put("part/b.pbrt", TRIANGLE "Translate 2 0 0");
  struct scene scene = read_scene("main.pbrt");
  assert_int_equal(scene.n_shapes, 3);
  assert_true(scene.position[0][0] == 5 && scene.position[3][0] == 7 && scene.position[6][0] == 0);
}

static void an_imported_files_attributes_are_its_own(void **state) {
  (void)state;
  put("main.pbrt",
      "WorldBegin Translate 3 0 0 Import \"b.pbrt\"\n" TRIANGLE "ObjectInstance \"x\"");
  put("b.pbrt", TRIANGLE "Translate 2 0 0 ObjectBegin \"x\"\n" TRIANGLE "ObjectEnd");
  struct scene scene = read_scene("main.pbrt");
  assert_true(scene.position[0][0] == 3 && scene.position[3][0] == 3 && scene.position[6][0] == 8);
}

static void what_an_imported_file_begins_it_ends(void **state) {
  (void)state;
  put("main.pbrt", "WorldBegin AttributeBegin Import \"b.pbrt\" AttributeEnd\n" TRIANGLE);
  put("b.pbrt", "\nAttributeBegin");
  assert_problem("main.pbrt", "b.pbrt:2:1: ", "this AttributeBegin has no AttributeEnd");
  put("b.pbrt", "\n AttributeEnd");
  assert_problem("main.pbrt", "b.pbrt:2:2: ", "AttributeEnd without AttributeBegin");
}

static void problems_name_the_file_they_are_in(void **state) {
  (void)state;
  put("main.pbrt", "WorldBegin\n Include \"part/a.pbrt\"\nShpae");
  put("part/a.pbrt", "\nShape \"sphere\" \"float radius\" [1");
  assert_problem("main.pbrt", "part/a.pbrt:2:31: ", "this [ has no ]");
  put("part/a.pbrt", "AttributeBegin AttributeEnd");
  assert_problem("main.pbrt", "main.pbrt:3:1: ", "did you mean Shape?");
  put("part/a.pbrt", "Include \"part\"");
  assert_problem("main.pbrt", "part/a.pbrt:1:1: ", "is a directory");
}

static void a_file_that_includes_itself_is_a_problem(void **state) {
  (void)state;
  put("main.pbrt", "WorldBegin Include \"b.pbrt\"");
  put("b.pbrt", "Include \"main2.pbrt\"");
  put("main2.pbrt", " Include \"b.pbrt\"");
  assert_problem("main.pbrt", "main2.pbrt:1:2: ", "does one include itself?");
}

static void the_hash_is_of_all_files_in_order(void **state) {
  (void)state;
  put("main.pbrt", "WorldBegin Include \"b.pbrt\" Include \"c.pbrt\"\n");
  put("b.pbrt", TRIANGLE);
  put("c.pbrt", "#");
  uint64_t first = read_scene("main.pbrt").hash;
  assert_true(read_scene("main.pbrt").hash == first);
  put("c.pbrt", "##");
  assert_true(read_scene("main.pbrt").hash != first);
  put("c.pbrt", TRIANGLE);
  put("b.pbrt", "#");
  assert_true(read_scene("main.pbrt").hash != first); // the same bytes, elsewhere
}

static void put_compressed(const char *name, const char *text) {
  gzFile file = gzopen(path_of(name), "wb");
  gzputs(file, text);
  gzclose(file);
}

static void compressed_files_are_read(void **state) {
  (void)state;
  put_compressed("main.pbrt.gz", "WorldBegin Include \"b.pbrt.gz\"");
  put_compressed("b.pbrt.gz", TRIANGLE);
  assert_int_equal(read_scene("main.pbrt.gz").n_triangles, 1);
  struct text text;
  struct problem problem = {{0}};
  assert_true(file_read(path_of("b.pbrt.gz"), &test_memory()->lists, &text, &problem));
  assert_int_equal(truncate(path_of("b.pbrt.gz"), text.length / 2), 0);
  assert_problem("main.pbrt.gz", "main.pbrt.gz:1:12: ", "the gzip file is cut off");
  put("b.pbrt.gz", "\x1f\x8b but this is no compressed file at all");
  assert_problem("main.pbrt.gz", "main.pbrt.gz:1:12: ", "a damaged gzip file");
}

static void what_is_left_out_leniently_is_said(void **state) {
  (void)state;
  put("main.pbrt", "WorldBegin Material \"diffuse\" \"string normalmap\" \"n.png\"\n" TRIANGLE
                   "AreaLightSource \"diffuse\" ObjectBegin \"a\" Attribute \"shape\"\n"
                   "\"texture displacement\" \"bumps\"\nShape \"disk\" ObjectEnd "
                   "ObjectInstance \"a\" ObjectInstance \"a\"");
  struct arena keep = test_memory()->keep;
  struct scene scene;
  struct problem problem = {{0}};
  char said[1024] = "", wanted[1024];
  FILE *notes = fmemopen(said, sizeof said, "w");
  struct scene_options options = {.lenient = true, .notes = notes};
  assert_true(scene_read_with(path_of("main.pbrt"), options, &keep, &scene, &problem));
  fclose(notes);
  assert_int_equal(scene.n_lights, 0);
  snprintf(wanted, sizeof wanted,
           "%1$s:1:31: Material \"diffuse\": \"normalmap\" is left out\n"
           "%1$s:5:1: Shape \"disk\": its area light is left out\n"
           "%1$s:4:1: Shape \"disk\": \"displacement\" is left out\n",
           path_of("main.pbrt"));
  assert_string_equal(said, wanted);
}

// Radiance 1 from a triangle of area 1/2 and a square of area 1.
static void all_of_a_mixed_mesh_emits(void **state) {
  (void)state;
  put("b.pbrt", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 -1 0\n4 0 1 2 3\n3 0 4 1\n");
  put("main.pbrt", "WorldBegin AreaLightSource \"diffuse\"\n"
                   "Shape \"plymesh\" \"string filename\" \"b.pbrt\"");
  struct scene scene = read_scene("main.pbrt");
  double power = 0;
  for (uint32_t k = 0; k < scene.n_lights; k++) power += scene.light[k].power[0];
  assert_true(fabs(power - acos(-1.0) * 1.5) <= 1e-12);
}

static void files_outside_of_the_folder_can_be_refused(void **state) {
  (void)state;
  static const char *const names[] = {"/etc/hostname", "../b.pbrt", "part/../b.pbrt", "//b.pbrt"};
  struct arena keep = test_memory()->keep;
  struct scene_options options = {.own_folder = true};
  struct scene scene;
  for (int k = 0; k < 4; k++) {
    struct problem problem = {{0}};
    put("main.pbrt", arena_format(&test_memory()->lists, "Include \"%s\"", names[k]));
    assert_false(scene_read_with(path_of("main.pbrt"), options, &keep, &scene, &problem));
    assert_non_null(strstr(problem.text, "is outside of the scene's folder"));
  }
  struct problem problem = {{0}};
  put("main.pbrt", "WorldBegin Include \"part/b.pbrt\"");
  put("part/b.pbrt", TRIANGLE);
  if (!scene_read_with(path_of("main.pbrt"), options, &keep, &scene, &problem))
    fail_msg("%s", problem.text);
}

static int make_folder(void **state) {
  (void)state;
  if (!mkdtemp(folder)) die("cannot make %s", folder);
  return mkdir(path_of("part"), 0777);
}

static int remove_folder(void **state) {
  (void)state;
  static const char *const names[] = {"main.pbrt",   "main2.pbrt",  "b.pbrt",       "c.pbrt",
                                      "part/a.pbrt", "part/b.pbrt", "main.pbrt.gz", "b.pbrt.gz"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) unlink(path_of(names[i]));
  rmdir(path_of("part"));
  return rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_included_file_is_read_in_place),
      cmocka_unit_test(an_imported_files_attributes_are_its_own),
      cmocka_unit_test(what_an_imported_file_begins_it_ends),
      cmocka_unit_test(problems_name_the_file_they_are_in),
      cmocka_unit_test(a_file_that_includes_itself_is_a_problem),
      cmocka_unit_test(the_hash_is_of_all_files_in_order),
      cmocka_unit_test(compressed_files_are_read),
      cmocka_unit_test(what_is_left_out_leniently_is_said),
      cmocka_unit_test(all_of_a_mixed_mesh_emits),
      cmocka_unit_test(files_outside_of_the_folder_can_be_refused),
  };
  return cmocka_run_group_tests_name("scene_files", tests, make_folder, remove_folder);
}
