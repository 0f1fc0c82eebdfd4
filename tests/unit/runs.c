// What is kept of each run (key `keep: runs`): runs.csv, written and read back.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run_fixture.h"

#include "run/block.h"

#include <math.h>

#define KEPT BEAM "seed: 7\nkeep: runs\n"

// Their moments over runs are those of the log, which reduces up to 16 runs in one tree: to the
// bit.
static void averages_of_runs_are_those_of_the_log(void **state) {
  (void)state;
  struct results results = run("kept", KEPT "kernel: [box, gaussian]\n");
  for (int s = 0; s < 2; s++) {
    const struct series *series = &results.series[s];
    for (int c = 0; c < series->n_checkpoints; c++) {
      const double *x = series->run_average + 3 * c;
      struct moments two = moments_merge(moments_of(x[0]), moments_of(x[1]));
      struct moments all = moments_merge(two, moments_of(x[2]));
      assert_memory_equal(&all, &series->average[c], sizeof all);
      assert_true(all.m2 > 0);
    }
    assert_null(series->run_richardson);
  }
}

static void averages_of_richardsons_biases_are_kept_too(void **state) {
  (void)state;
  struct results results =
      run("half", KEPT "parts: [{probes: [[32, 32], [30, 40]], reference: richardson}]\n");
  for (int s = 0; s < 2; s++) {
    const struct series *series = &results.series[s];
    double sum = 0;
    for (int c = 0; c < 4; c++) {
      const double *x = series->run_richardson + 3 * c;
      sum += series->richardson[c].mean;
      assert_true(fabs((x[0] + x[1] + x[2]) / 3 - sum / (c + 1)) < 1e-15);
    }
  }
}

static void who_keeps_nothing_pays_nothing(void **state) {
  (void)state;
  struct results results = run("moments", BEAM "seed: 7\n");
  run("kept-too", KEPT);
  assert_null(results.series[0].run_average);
  assert_false(file_exists(path_in("moments/runs.csv")));
  assert_null(strstr(read_text(path_in("moments/manifest.json")), "runs_hash"));
  assert_string_equal(read_text(path_in("moments/log.csv")),
                      read_text(path_in("kept-too/log.csv")));
  struct experiment experiment = experiment_of("moments", BEAM "seed: 7\n");
  assert_int_equal(plan_of(&experiment).group[0].kept_width, 0);
}

// 40 runs are three blocks; the second one is there before.
static void threads_and_interruptions_leave_the_same_runs(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("forty", KEPT "parts: [{runs: 40}, {alpha: 0.5}]\n");
  struct run_options two = {.threads = 2, .quiet = true};
  struct problem problem = {0};
  run_into(&experiment, path_in("one"));
  assert_int_equal(run_experiment(&experiment, path_in("two"), two, &arena, &problem), RUN_DONE);
  struct plan plan = plan_of(&experiment);
  const char *blocks = block_folder(&plan, path_in("resumed"), &arena);
  struct block block = block_new(&plan.group[0], 1, &arena);
  struct progress silent = {.quiet = true};
  assert_true(file_make_directory(blocks, &problem));
  block_compute(&plan.group[0], 1, &block, &silent, 0, arena);
  block_write(&plan.group[0], 1, blocks, &block, arena);
  run_into(&experiment, path_in("resumed"));
  char *text = read_text(path_in("one/runs.csv"));
  assert_string_equal(text, read_text(path_in("two/runs.csv")));
  assert_string_equal(text, read_text(path_in("resumed/runs.csv")));
  int rows = 0;
  for (char *at = text; (at = strchr(at, '\n')); at++) rows++;
  assert_int_equal(rows, 1 + 4 * 40 + 4 * 3);
}

// Every byte of the runs is covered by the block's checksum.
static void a_block_with_a_changed_run_is_none(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("byte", KEPT);
  struct plan plan = plan_of(&experiment);
  const char *blocks = block_folder(&plan, path_in("byte"), &arena);
  struct block block = block_new(&plan.group[0], 0, &arena), back;
  struct problem problem = {0};
  struct progress silent = {.quiet = true};
  assert_true(file_make_directory(blocks, &problem));
  block_compute(&plan.group[0], 0, &block, &silent, 0, arena);
  block_write(&plan.group[0], 0, blocks, &block, arena);
  assert_true(block_read(&plan.group[0], 0, blocks, &back, &arena));
  assert_memory_equal(back.kept, block.kept, 3 * 4 * sizeof(double));
  const char *path = arena_format(&arena, "%s/group-000-block-000000", blocks);
  struct text text;
  assert_true(file_read(path, &arena, &text, &problem));
  for (ptrdiff_t at = text.length - 3 * 4 * 8; at < text.length; at++) {
    text.data[at] ^= 4;
    FILE *file = fopen(path, "wb");
    fwrite(text.data, 1, (size_t)text.length, file);
    fclose(file);
    assert_false(block_read(&plan.group[0], 0, blocks, &back, &arena));
    text.data[at] ^= 4;
  }
}

static void damaged_runs_are_refused(void **state) {
  (void)state;
  static const char *const row[][3] = {
      {"average,2,1,", "average,7,1,", "runs.csv:3:1: no average is kept there"},
      {"average,2,1,", "average,1,1,", "runs.csv:3:1: a value stands twice"},
      {"average,2,1,", "average,2,4,", "runs.csv:3:1: a number is out of range"},
      {"average,2,1,", "average,2,1,nan,", "runs.csv:3:1: a row has not as many fields"},
      {"average,2,1,", "richardson,2,1,", "runs.csv:3:1: a row of an unknown series"},
      {"0,0,average,2,1,", "0,1,average,2,1,", "runs.csv:3:1: a row of runs that were not kept"},
      {"average,2,1,", "average,2,1,1", "runs.csv: was changed after the run"},
      {"value", "values", "runs.csv:1:1: unexpected columns"},
  };
  run("damage", KEPT);
  const char *path = path_in("damage/runs.csv");
  char *whole = read_text(path);
  for (size_t k = 0; k <= sizeof row / sizeof *row; k++) {
    const char *says = "a run is missing";
    struct results results;
    struct problem problem = {0};
    write_text(path, whole);
    if (k == sizeof row / sizeof *row) {
      char *cut = arena_string(&arena, whole, (ptrdiff_t)strlen(whole));
      *(strstr(cut, "0,0,average,4,3,")) = 0;
      write_text(path, cut);
    } else {
      replace_in(path, row[k][0], row[k][1]);
      says = row[k][2];
    }
    assert_false(results_read(path_in("damage"), &arena, &results, &problem));
    if (!strstr(problem.text, says)) fail_msg("expected '%s' in '%s'", says, problem.text);
  }
}

static void results_that_lost_their_runs_are_not_up_to_date(void **state) {
  (void)state;
  run("lost", KEPT);
  char *text = read_text(path_in("lost/runs.csv"));
  remove(path_in("lost/runs.csv"));
  run("lost", KEPT);
  assert_string_equal(read_text(path_in("lost/runs.csv")), text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(averages_of_runs_are_those_of_the_log),
      cmocka_unit_test(averages_of_richardsons_biases_are_kept_too),
      cmocka_unit_test(who_keeps_nothing_pays_nothing),
      cmocka_unit_test(threads_and_interruptions_leave_the_same_runs),
      cmocka_unit_test(a_block_with_a_changed_run_is_none),
      cmocka_unit_test(damaged_runs_are_refused),
      cmocka_unit_test(results_that_lost_their_runs_are_not_up_to_date),
  };
  return cmocka_run_group_tests_name("runs", tests, make_folder, remove_folder);
}
