// Blocks: interrupted, damaged or shared by threads, a run leaves the same bytes and loses no work.
#define _GNU_SOURCE // mkdtemp, nftw
#include "run_fixture.h"

#include "run/block.h"

// A folder with block 1 of a plan of two, as an interrupted run leaves it.
static const char *begin_blocks(const struct plan *plan, const char *directory) {
  const char *blocks = block_folder(plan, directory, &arena);
  struct problem problem = {0};
  assert_true(file_make_directory(blocks, &problem));
  struct block block = block_new(&plan->group[0], 1, &arena);
  struct progress silent = {.quiet = true};
  block_compute(&plan->group[0], 1, &block, &silent, 0, arena);
  block.time[0] = (struct block_time){1234.5, 0.5, 2385};
  block_write(&plan->group[0], 1, blocks, &block, arena);
  return blocks;
}

static void a_block_with_any_byte_changed_or_cut_is_none(void **state) {
  (void)state;
  struct experiment experiment = experiment_of("byte", BEAM "parts: [{runs: 20}]\n");
  struct plan plan = plan_of(&experiment);
  const char *blocks = begin_blocks(&plan, path_in("byte"));
  const struct block_time *time = block_times(&plan.group[0], 1, blocks, &arena);
  assert_non_null(time);
  assert_true(time->wall_s == 1234.5 && time->cpu_s == 0.5);
  assert_null(block_times(&plan.group[0], 0, blocks, &arena));
  const char *path = arena_format(&arena, "%s/group-000-block-000001", blocks);
  struct text text;
  struct problem problem = {0};
  assert_true(file_read(path, &arena, &text, &problem));
  for (ptrdiff_t at = 0; at < text.length; at++) {
    if (at == 40) at += sizeof *time; // times are no result
    text.data[at] ^= 4;
    FILE *file = fopen(path, "wb");
    fwrite(text.data, 1, (size_t)text.length, file);
    fclose(file);
    assert_null(block_times(&plan.group[0], 1, blocks, &arena));
    text.data[at] ^= 4;
  }
  assert_int_equal(truncate(path, text.length - 1), 0);
  assert_null(block_times(&plan.group[0], 1, blocks, &arena));
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
  assert_non_null(
      strstr(read_text(path_in("resumed/timing.csv")), ",4,4,2385,1234.500000,0.500000\n"));
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
  run_into(&other, path_in("shared"));
  assert_non_null(block_times(&plan.group[0], 1, blocks, &arena));
  run_into(&third, path_in("shared")); // finished results are set aside, the blocks stay
  assert_true(file_exists(path_in("shared.1/log.csv")));
  assert_non_null(block_times(&plan.group[0], 1, blocks, &arena));
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_block_with_any_byte_changed_or_cut_is_none),
      cmocka_unit_test(a_run_goes_on_where_it_stopped_and_keeps_the_times),
      cmocka_unit_test(blocks_that_a_killed_program_could_not_remove_go_with_the_next_call),
      cmocka_unit_test(threads_share_blocks_and_references_without_a_trace),
      cmocka_unit_test(another_experiment_leaves_unfinished_blocks_alone),
      cmocka_unit_test(results_that_lost_a_file_are_not_up_to_date),
      cmocka_unit_test(a_slash_behind_the_directory_changes_nothing),
  };
  return cmocka_run_group_tests_name("run_blocks", tests, make_folder, remove_folder);
}
