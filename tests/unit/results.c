// What the runner writes is what results_read reads back, or says that it is damaged.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run_fixture.h"

#include "run/block.h"

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
  struct block block = block_new(&plan.group[0], 0, &arena);
  struct progress silent = {.quiet = true};
  block_compute(&plan.group[0], 0, &block, &silent, 0, arena);
  run_into(&experiment, path_in("back"));
  struct results results = results_of(path_in("back"));
  assert_int_equal(results.n_series, 2);
  for (int e = 0; e < 2; e++) {
    const struct series *series = &results.series[e];
    const struct moments *at = block.moments + plan_series(&plan.group[0], e, 0);
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
  replace_in(path_in("edited/edited.yaml"), "radius: 0.5", "radius: 0.6");
  reading_says(path_in("edited"), "edited.yaml: was changed after the run");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_read_back_is_what_was_measured),
      cmocka_unit_test(the_seed_of_the_command_line_is_read_back),
      cmocka_unit_test(a_damaged_log_is_refused_with_its_line),
      cmocka_unit_test(a_log_cut_anywhere_is_refused),
      cmocka_unit_test(an_edited_experiment_is_refused),
  };
  return cmocka_run_group_tests_name("results", tests, make_folder, remove_folder);
}
