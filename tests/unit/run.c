// The runner: every cell gets what it asked for, or the experiment is refused before anything is
// made.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run_fixture.h"

#include "run/pilot.h"

#include <math.h>

// ---- what is measured ----

static void cells_that_the_integrator_cannot_tell_apart_get_the_same_values(void **state) {
  (void)state;
  struct results results =
      run("path", BOX "integrator: path\nalpha: [0.5, 2/3]\nprobes: [[32, 20]]\n");
  assert_int_equal(results.n_series, 2);
  for (int i = 0; i < 2; i++) {
    assert_true(results.series[0].iteration[i].mean > 0);
    assert_memory_equal(&results.series[0].iteration[i], &results.series[1].iteration[i],
                        sizeof(struct moments));
  }
}

static void cells_that_share_photons_keep_references_of_their_own(void **state) {
  (void)state;
  struct results results = run(
      "references", BOX "probes: [[32, 20]]\nparts: [{alpha: 0.5, reference: none}, {alpha: 2/3, "
                        "reference: {integrator: path, se: 0.05}}]\n");
  assert_true(isnan(results.probe[0]->reference));
  assert_true(results.probe[1]->reference > 0);
  assert_true(results.probe[1]->reference_se <= 0.05);
}

static void one_run_of_one_iteration_is_an_experiment(void **state) {
  (void)state;
  struct results results = run("one", BEAM "\nparts: [{iterations: 1, runs: 1}]\n");
  const struct series *series = &results.series[0];
  assert_int_equal(series->n_iterations, 1);
  assert_int_equal(series->n_checkpoints, 1);
  assert_true(series->iteration[0].n == 1 && series->iteration[0].m2 == 0);
  assert_true(series->average[0].mean == series->iteration[0].mean);
}

static void the_default_probes_are_the_centres_of_nine_parts(void **state) {
  (void)state;
  struct results results = run("default", BOX);
  assert_int_equal(results.n_probes[0], 9);
  for (int p = 0; p < 9; p++) { // film of 64 x 64: floor(64 (2k + 1) / 6)
    static const int at[] = {10, 32, 53};
    assert_int_equal(results.probe[0][p].x, at[p % 3]);
    assert_int_equal(results.probe[0][p].y, at[p / 3]);
  }
}

// ---- references ----

// The bias of the quadratic beam is known (theory 5 iii): of iteration 8 it is 0.5 / pi * 8 / pi *
// mu_2 r^2 rho_8 / 2. 128 differences give it to about 1 %.
static void a_reference_can_be_known_to_a_share_of_the_bias(void **state) {
  (void)state;
  struct experiment experiment = experiment_of(
      "share", "scene: scenes/plane-quadratic-beam.pbrt\nradius: 0.7\nphotons: 2000\ndepth: 1\n"
               "probes: [[32, 32]]\niterations: 8\nruns: 16\n"
               "parts: [{reference: {integrator: path, se: 10%}}, {reference: none}]\n");
  struct experiment settled;
  struct problem problem = {0};
  assert_true(pilot_settle(&experiment, quiet, &settled, &arena, &problem));
  const double pi = 3.14159265358979323846;
  double rho = law_find("knaus-zwicker")->rho(2.0 / 3, 8);
  double expected = 0.1 * 0.5 / pi * 8 / pi * 0.25 * 0.49 * rho / 2;
  assert_true(fabs(settled.cell[0].reference_se / expected - 1) < 0.05);
  assert_true(settled.cell[1].reference_se == 0 && experiment.cell[0].reference_se == 0);
}

static void where_no_light_is_a_share_of_the_bias_is_refused(void **state) {
  (void)state;
  struct experiment experiment =
      experiment_of("dark", "scene: tests/data/scenes/plane-lit-from-below.pbrt\nradius: 0.5\n"
                            "photons: 250\ndepth: 1\nprobes: [[32, 32]]\niterations: 2\n"
                            "reference: {integrator: path, se: 3%}\n");
  struct experiment settled;
  struct problem problem = {0};
  assert_false(pilot_settle(&experiment, quiet, &settled, &arena, &problem));
  assert_non_null(strstr(problem.text, "no light"));
}

// The only file in the cache of references.
static const char *cached_reference(void) {
  DIR *list = opendir(path_in("references"));
  const char *found = NULL;
  assert_non_null(list);
  for (struct dirent *entry; (entry = readdir(list));) {
    if (entry->d_name[0] == '.') continue;
    assert_null(found);
    found = arena_format(&arena, "%s/references/%s", folder, entry->d_name);
  }
  closedir(list);
  return found;
}

static void a_reference_cut_anywhere_is_made_again(void **state) {
  (void)state;
  remove_references();
  struct results fresh = run("traced", TRACED);
  const char *path = cached_reference();
  char *whole = read_text(path);
  for (int less = 1; less < 40; less += 12) { // the line's end; samples; the standard error
    write_text(path, arena_format(&arena, "%.*s", (int)strlen(whole) - less, whole));
    remove(path_in("traced/manifest.json"));
    struct results again = run("traced", TRACED);
    assert_memory_equal(again.probe[0], fresh.probe[0], sizeof(struct probe));
    assert_string_equal(read_text(path), whole);
  }
}

static void a_cached_reference_is_used(void **state) {
  (void)state;
  remove_references();
  run("cached", TRACED);
  replace_in(cached_reference(), "\n32,32,", "\n32,32,7");
  remove(path_in("cached/manifest.json"));
  assert_true(run("cached", TRACED).probe[0]->reference >= 7);
  remove_references();
}

static void references_of_thousands_of_probes_are_references(void **state) {
  (void)state;
  char *probes = "";
  for (int y = 0; y < 64; y++) { // 65 x 64 > the samples of one step
    char *row = "";
    for (int x = 0; x < 65; x++) row = arena_format(&arena, "%s[%d,%d],", row, x + 1, y + 1);
    probes = arena_format(&arena, "%s%s\n ", probes, row);
  }
  write_disk("large.pbrt", 67, 67, 20, 3);
  struct results results =
      run("thousands", arena_format(&arena,
                                    "scene: %s\nradius: 0.3\nphotons: 9\niterations: 1\nruns: 1\n"
                                    "reference: {integrator: path, se: 1}\nprobes: [%s]\n",
                                    path_in("large.pbrt"), probes));
  for (int p = 0; p < 64 * 65; p++) assert_true(results.probe[0][p].reference > 0);
  remove_references();
}

// ---- checkpoints of the log ----

static void averages_are_logged_ten_times_a_decade_and_at_the_end(void **state) {
  (void)state;
  static const uint64_t expected[] = {1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 17};
  int count;
  uint64_t *checkpoint = plan_checkpoints(17, &count, &arena);
  assert_int_equal(count, sizeof expected / sizeof *expected);
  assert_memory_equal(checkpoint, expected, sizeof expected);
}

// ---- plans that fail ----

static void refuses(const char *name, const char *yaml, const char *says) {
  struct experiment experiment = experiment_of(name, yaml);
  struct problem problem = {0};
  const char *directory = path_in(name);
  assert_int_equal(run_experiment(&experiment, directory, quiet, &arena, &problem), RUN_FAILED);
  if (!strstr(problem.text, says)) fail_msg("expected '%s' in '%s'", says, problem.text);
  assert_false(file_exists(directory));
}

static void a_film_too_small_for_the_default_probes_is_refused(void **state) {
  (void)state;
  write_disk("small.pbrt", 2, 64, 90, 1);
  write_disk("least.pbrt", 3, 3, 20, 3);
  const char *yaml = "scene: %s\nradius: 0.3\nphotons: 9\niterations: 1\nruns: 1\n";
  refuses("small", arena_format(&arena, yaml, path_in("small.pbrt")), "no nine default probes");
  struct results results = run("least", arena_format(&arena, yaml, path_in("least.pbrt")));
  for (int p = 0; p < 9; p++)
    assert_true(results.probe[0][p].x == p % 3 && results.probe[0][p].y == p / 3);
}

static void a_probe_that_sees_nothing_is_refused_before_anything_is_made(void **state) {
  (void)state;
  write_disk("disk.pbrt", 64, 64, 90, 1);
  char *yaml = arena_format(&arena, "scene: %s\nradius: 0.3\n", path_in("disk.pbrt"));
  refuses("nothing", yaml, "default probe [10, 10] sees no surface");
  refuses("corner", arena_format(&arena, "%sprobes: [[32, 32], [0, 1]]\n", yaml),
          "disk.pbrt: probe [0, 1] sees no surface");
}

static void a_name_that_would_break_the_outputs_is_refused(void **state) {
  (void)state;
  refuses("a,b", BEAM, "\"a,b\" cannot be the name");
  refuses("a\"b", BEAM, "cannot be the name");
  refuses("caf\xe9", BEAM, "cannot be the name");
  write_text(path_in("a,b.pbrt"), read_text("scenes/plane-uniform-beam.pbrt"));
  refuses("scene-name", arena_format(&arena, "scene: \"%s\"\nradius: 0.3\n", path_in("a,b.pbrt")),
          "\"a,b\" cannot be the name");
}

static void a_film_of_more_pixels_than_can_be_numbered_is_refused(void **state) {
  (void)state;
  write_disk("film.pbrt", 65536, 65536, 20, 1);
  char *yaml = arena_format(&arena, "scene: %s\nradius: 0.3\nprobes: [[32768, 32768]]\nimages: 1\n",
                            path_in("film.pbrt"));
  refuses("film", yaml, "film of 65536 x 65536 pixels is too large");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_reference_can_be_known_to_a_share_of_the_bias),
      cmocka_unit_test(where_no_light_is_a_share_of_the_bias_is_refused),
      cmocka_unit_test(cells_that_the_integrator_cannot_tell_apart_get_the_same_values),
      cmocka_unit_test(cells_that_share_photons_keep_references_of_their_own),
      cmocka_unit_test(one_run_of_one_iteration_is_an_experiment),
      cmocka_unit_test(the_default_probes_are_the_centres_of_nine_parts),
      cmocka_unit_test(a_reference_cut_anywhere_is_made_again),
      cmocka_unit_test(a_cached_reference_is_used),
      cmocka_unit_test(references_of_thousands_of_probes_are_references),
      cmocka_unit_test(averages_are_logged_ten_times_a_decade_and_at_the_end),
      cmocka_unit_test(a_film_too_small_for_the_default_probes_is_refused),
      cmocka_unit_test(a_probe_that_sees_nothing_is_refused_before_anything_is_made),
      cmocka_unit_test(a_name_that_would_break_the_outputs_is_refused),
      cmocka_unit_test(a_film_of_more_pixels_than_can_be_numbered_is_refused),
  };
  return cmocka_run_group_tests_name("run", tests, make_folder, remove_folder);
}
