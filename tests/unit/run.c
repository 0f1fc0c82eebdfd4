// The runner: what it writes is what results_read reads, whatever is asked, interrupted or damaged.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run/run.h"
#include "base/file.h"
#include "run/block.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <ftw.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = "/tmp/photonlab-run-XXXXXX"; // of all files of these tests

static const char *path_in(const char *name) { return arena_format(&arena, "%s/%s", folder, name); }

static void write_text(const char *path, const char *text) {
  struct file_out out;
  struct problem problem = {0};
  if (!file_begin(&out, path, &problem)) fail_msg("%s", problem.text);
  fputs(text, out.stream);
  if (!file_commit(&out, &problem)) fail_msg("%s", problem.text);
}

static char *read_text(const char *path) {
  struct text text;
  struct problem problem = {0};
  if (!file_read(path, &arena, &text, &problem)) fail_msg("%s", problem.text);
  return text.data;
}

// An experiment file NAME.yaml with this text, read.
static struct experiment experiment_of(const char *name, const char *yaml) {
  const char *path = path_in(arena_format(&arena, "%s.yaml", name));
  struct experiment experiment;
  struct problem problem = {0};
  write_text(path, yaml);
  if (!experiment_read(path, "default", &arena, &experiment, &problem))
    fail_msg("%s", problem.text);
  return experiment;
}

static const struct run_options quiet = {.threads = 1, .quiet = true};

static void run_into(const struct experiment *experiment, const char *directory) {
  struct problem problem = {0};
  enum run_outcome outcome = run_experiment(experiment, directory, quiet, &arena, &problem);
  if (outcome != RUN_DONE) fail_msg("%s", problem.text);
}

static struct results results_of(const char *directory) {
  struct results results;
  struct problem problem = {0};
  if (!results_read(directory, &arena, &results, &problem)) fail_msg("%s", problem.text);
  return results;
}

// Runs the experiment into a directory of its name and reads the results back.
static struct results run(const char *name, const char *yaml) {
  struct experiment experiment = experiment_of(name, yaml);
  run_into(&experiment, path_in(name));
  return results_of(path_in(name));
}

#define BEAM                                                                                       \
  "scene: scenes/plane-quadratic-beam.pbrt\nradius: 0.5\nphotons: 250\ndepth: 1\n"                 \
  "probes: [[32, 32]]\niterations: 4\nruns: 3\n"
#define BOX "scene: scenes/cornell-box.pbrt\nradius: 0.3\nphotons: 300\niterations: 2\nruns: 2\n"

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

static void a_probe_that_sees_nothing_is_refused_before_anything_is_made(void **state) {
  (void)state;
  write_text(path_in("disk.pbrt"),
             "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64\n"
             "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\n"
             "LightSource \"point\" \"point3 from\" [0 0 2]\nMaterial \"diffuse\"\n"
             "Shape \"disk\" \"float radius\" 1\n");
  char *yaml = arena_format(&arena, "scene: %s\nradius: 0.3\n", path_in("disk.pbrt"));
  refuses("nothing", yaml, "default probe [10, 10] sees no surface");
  refuses("corner", arena_format(&arena, "%sprobes: [[32, 32], [0, 1]]\n", yaml),
          "disk.pbrt: probe [0, 1] sees no surface");
}

// ---- the program ----

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *at) {
  (void)info, (void)type, (void)at;
  return remove(path);
}

static int make_folder(void **state) {
  (void)state;
  arena = arena_reserve();
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  arena_release(arena);
  return nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cells_that_the_integrator_cannot_tell_apart_get_the_same_values),
      cmocka_unit_test(cells_that_share_photons_keep_references_of_their_own),
      cmocka_unit_test(one_run_of_one_iteration_is_an_experiment),
      cmocka_unit_test(the_default_probes_are_the_centres_of_nine_parts),
      cmocka_unit_test(averages_are_logged_ten_times_a_decade_and_at_the_end),
      cmocka_unit_test(a_probe_that_sees_nothing_is_refused_before_anything_is_made),
  };
  return cmocka_run_group_tests_name("run", tests, make_folder, remove_folder);
}
