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
#include <dirent.h>
#include <ftw.h>
#include <stdlib.h>
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

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *at) {
  (void)info, (void)type, (void)at;
  return remove(path);
}

static void remove_references(void) {
  const char *path = path_in("references");
  if (file_exists(path)) nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
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
#define TRACED BEAM "reference: {integrator: path, se: 0.05}\n"

// A disk seen from above and the field of view around it, in degrees.
static void write_disk(const char *name, int width, int height, int fov, int radius) {
  write_text(path_in(name),
             arena_format(&arena,
                          "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d\n"
                          "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" %d\n"
                          "WorldBegin\nLightSource \"point\" \"point3 from\" [0 0 2]\n"
                          "Material \"diffuse\"\nShape \"disk\" \"float radius\" %d\n",
                          width, height, fov, radius));
}

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

// ---- reading back ----

// What write_text wrote is `text` with the first `old` replaced.
static void replace_in(const char *path, const char *old, const char *new) {
  char *text = read_text(path), *at = strstr(text, old);
  if (!at) fail_msg("there is no '%s' in %s", old, path);
  *at = 0;
  write_text(path, arena_format(&arena, "%s%s%s", text, new, at + strlen(old)));
}

static void reading_says(const char *directory, const char *says) {
  struct results results;
  struct problem problem = {0};
  assert_false(results_read(directory, &arena, &results, &problem));
  if (!strstr(problem.text, says)) fail_msg("expected '%s' in '%s'", says, problem.text);
}

// The moments over all runs of one group without any file: what must come back, bit for bit.
static void what_is_read_back_is_what_was_measured(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("back", BEAM "kernel: [box, gaussian]\n");
  struct plan plan;
  struct problem problem = {0};
  assert_true(plan_make(&experiment, quiet, &arena, &plan, &problem));
  struct moments *expected = arena_new(&arena, struct moments, plan.group[0].width);
  block_compute(&plan.group[0], 0, expected, arena);
  run_into(&experiment, path_in("back"));
  struct results results = results_of(path_in("back"));
  assert_int_equal(results.n_series, 2);
  for (int e = 0; e < 2; e++) {
    const struct series *series = &results.series[e];
    const struct moments *at = expected + plan_series(&plan.group[0], e, 0);
    assert_int_equal(series->cell, e);
    assert_int_equal(series->n_checkpoints, 4);
    assert_memory_equal(series->iteration, at, 4 * sizeof *at);
    assert_memory_equal(series->average, at + 4, 4 * sizeof *at);
    assert_int_equal(series->checkpoint[3], 4);
  }
  assert_true(results.scene_hash[1] == plan.scene[0].scene.hash);
}

static void the_seed_of_the_command_line_is_read_back(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("seed", BEAM);
  experiment.cell[0].seed = UINT64_C(0xfedcba9876543210);
  run_into(&experiment, path_in("seed"));
  assert_true(results_of(path_in("seed")).experiment.cell[0].seed == UINT64_C(0xfedcba9876543210));
}

static void a_damaged_log_is_refused_with_its_line(void **state) {
  (void)state;
  static const struct {
    const char *old, *new, *says;
  } damage[] = {
      {"iteration,2,", "iteration,nan,", "log.csv:3:1: a number is out of range"},
      {"iteration,2,", "iteration,2.5,", "log.csv:3:1: a number is out of range"},
      {"iteration,2,", "iteration,5,", "log.csv:3:1: a number is out of range"},
      {"iteration,2,", "iteration,1,", "log.csv:3:1: an iteration stands twice"},
      {"iteration,2,", "iteratiom,2,", "log.csv:3:1: a row of an unknown series"},
      {"iteration,2,", "iteration,2,2,", "log.csv:3:1: a row has not as many fields"},
      {"iteration,2,", "iteration", "log.csv:3:1: a row has not as many fields"},
      {"average,2,", "average,1,", "log.csv:7:1: averages do not ascend"},
      {"average,3,", "iteration,3,", "log.csv:8:1: an iteration stands twice"},
      {"scene,", "scenes,", "log.csv:1:1: unexpected columns"},
  };
  run("damage", BEAM);
  const char *path = path_in("damage/log.csv");
  char *whole = read_text(path);
  for (size_t k = 0; k < sizeof damage / sizeof *damage; k++) {
    write_text(path, whole);
    replace_in(path, damage[k].old, damage[k].new);
    reading_says(path_in("damage"), damage[k].says);
  }
}

static void a_log_cut_anywhere_is_refused(void **state) {
  (void)state;
  run("cut", BEAM);
  const char *path = path_in("cut/log.csv");
  char *whole = read_text(path);
  for (size_t length = strlen(whole) - 1; length > 0; length--) {
    whole[length] = 0;
    write_text(path, whole);
    reading_says(path_in("cut"), "damaged");
  }
}

static void an_edited_experiment_is_refused(void **state) {
  (void)state;
  run("edited", BEAM);
  replace_in(path_in("edited/edited.yaml"), "radius: 0.5", "radius: [0.5, 0.6]");
  reading_says(path_in("edited"), "has 2 cells, 1 were run");
}

// ---- blocks ----

static struct plan plan_of(const struct experiment *experiment) {
  struct plan plan;
  struct problem problem = {0};
  if (!plan_make(experiment, quiet, &arena, &plan, &problem)) fail_msg("%s", problem.text);
  return plan;
}

// A folder with block 1 of a plan of two, as an interrupted run leaves it.
static const char *begin_blocks(const struct plan *plan, const char *directory) {
  const char *blocks = block_folder(plan, directory, &arena);
  struct problem problem = {0};
  assert_true(file_make_directory(blocks, &problem));
  struct moments *moments = arena_new(&arena, struct moments, plan->group[0].width);
  block_compute(&plan->group[0], 1, moments, arena);
  block_write(&plan->group[0], 1, blocks, moments, (struct block_time){1234.5, 0.5}, arena);
  return blocks;
}

static void a_block_with_any_byte_changed_or_cut_is_none(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("byte", BEAM "parts: [{runs: 20}]\n");
  struct plan plan = plan_of(&experiment);
  struct block_time time;
  const char *blocks = begin_blocks(&plan, path_in("byte"));
  assert_true(block_exists(&plan.group[0], 1, blocks, &time, arena));
  assert_true(time.wall_s == 1234.5 && time.cpu_s == 0.5);
  assert_false(block_exists(&plan.group[0], 0, blocks, &time, arena));
  const char *path = arena_format(&arena, "%s/group-000-block-000001", blocks);
  struct text text;
  struct problem problem = {0};
  assert_true(file_read(path, &arena, &text, &problem));
  for (ptrdiff_t at = 0; at < text.length; at++) {
    if (at == 40) at += sizeof time; // times are no result
    text.data[at] ^= 4;
    FILE *file = fopen(path, "wb");
    fwrite(text.data, 1, (size_t)text.length, file);
    fclose(file);
    assert_false(block_exists(&plan.group[0], 1, blocks, &time, arena));
    text.data[at] ^= 4;
  }
  assert_int_equal(truncate(path, text.length - 1), 0);
  assert_false(block_exists(&plan.group[0], 1, blocks, &time, arena));
}

static void a_run_goes_on_where_it_stopped_and_keeps_the_times(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("resumed", BEAM "parts: [{runs: 20}]\n");
  run_into(&experiment, path_in("at-once"));
  struct plan plan = plan_of(&experiment);
  begin_blocks(&plan, path_in("resumed"));
  run_into(&experiment, path_in("resumed"));
  assert_string_equal(read_text(path_in("resumed/log.csv")), read_text(path_in("at-once/log.csv")));
  assert_non_null(strstr(read_text(path_in("resumed/timing.csv")), "0,0,"));
  assert_non_null(strstr(read_text(path_in("resumed/timing.csv")), ",1234.500000,0.500000\n"));
  assert_false(file_exists(path_in("resumed/blocks")));
}

static void blocks_that_a_killed_program_could_not_remove_go_with_the_next_call(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("killed", BEAM "parts: [{runs: 20}]\n");
  struct plan plan = plan_of(&experiment);
  run_into(&experiment, path_in("killed"));
  begin_blocks(&plan, path_in("killed"));
  run_into(&experiment, path_in("killed"));
  assert_false(file_exists(path_in("killed/blocks")));
}

static void threads_share_blocks_and_references_without_a_trace(void **state) {
  (void)state;
  const char *yaml = TRACED "parts: [{runs: 40}, {alpha: 0.5, runs: 20}]\n";
  struct experiment experiment = experiment_of("threads", yaml);
  struct run_options two = {.threads = 2, .quiet = true};
  struct problem problem = {0};
  remove_references();
  run_into(&experiment, path_in("one-thread"));
  remove_references();
  assert_int_equal(run_experiment(&experiment, path_in("two-threads"), two, &arena, &problem),
                   RUN_DONE);
  assert_string_equal(read_text(path_in("one-thread/log.csv")),
                      read_text(path_in("two-threads/log.csv")));
  assert_string_equal(read_text(path_in("one-thread/probes.csv")),
                      read_text(path_in("two-threads/probes.csv")));
}

static void another_experiment_leaves_unfinished_blocks_alone(void **state) {
  (void)state;
  struct experiment first = experiment_of("first", BEAM "parts: [{runs: 20}]\n");
  struct experiment other = experiment_of("other", BEAM);
  struct experiment third = experiment_of("third", BEAM "parts: [{runs: 1}]\n");
  struct plan plan = plan_of(&first);
  const char *blocks = begin_blocks(&plan, path_in("shared"));
  struct block_time time;
  run_into(&other, path_in("shared"));
  assert_true(block_exists(&plan.group[0], 1, blocks, &time, arena));
  run_into(&third, path_in("shared")); // finished results are set aside, the blocks stay
  assert_true(file_exists(path_in("shared.1/log.csv")));
  assert_true(block_exists(&plan.group[0], 1, blocks, &time, arena));
}

static void results_that_lost_a_file_are_not_up_to_date(void **state) {
  (void)state;
  run("lost", BEAM);
  char *log = read_text(path_in("lost/log.csv"));
  remove(path_in("lost/log.csv"));
  run("lost", BEAM);
  assert_string_equal(read_text(path_in("lost/log.csv")), log);
}

static void a_slash_behind_the_directory_changes_nothing(void **state) {
  (void)state;
  struct experiment first = experiment_of("before", BEAM), other = experiment_of("after", BEAM);
  run_into(&first, path_in("slash//"));
  run_into(&other, path_in("slash/"));
  assert_true(file_exists(path_in("slash.1/before.yaml")));
  assert_true(file_exists(path_in("slash/after.yaml")));
}

// ---- references ----

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

// ---- the program ----

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
      cmocka_unit_test(what_is_read_back_is_what_was_measured),
      cmocka_unit_test(the_seed_of_the_command_line_is_read_back),
      cmocka_unit_test(a_damaged_log_is_refused_with_its_line),
      cmocka_unit_test(a_log_cut_anywhere_is_refused),
      cmocka_unit_test(an_edited_experiment_is_refused),
      cmocka_unit_test(a_block_with_any_byte_changed_or_cut_is_none),
      cmocka_unit_test(a_run_goes_on_where_it_stopped_and_keeps_the_times),
      cmocka_unit_test(blocks_that_a_killed_program_could_not_remove_go_with_the_next_call),
      cmocka_unit_test(threads_share_blocks_and_references_without_a_trace),
      cmocka_unit_test(another_experiment_leaves_unfinished_blocks_alone),
      cmocka_unit_test(results_that_lost_a_file_are_not_up_to_date),
      cmocka_unit_test(a_slash_behind_the_directory_changes_nothing),
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
