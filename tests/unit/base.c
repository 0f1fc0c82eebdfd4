// Problems and files: what is too long is cut, what cannot be written leaves nothing.
#define _GNU_SOURCE // mkdtemp
#include "base/file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

// A problem with something behind it that nobody may write to.
struct guarded {
  struct problem problem;
  char after[4096];
};

static void a_long_path_in_a_problem_is_cut(void **state) {
  (void)state;
  struct guarded guarded = {0};
  char path[3000];
  memset(path, 'p', sizeof path - 1);
  path[sizeof path - 1] = 0;
  struct place place = {path, 23, 85};
  assert_false(problem_at(&guarded.problem, place, "what is wrong"));
  assert_int_equal(strlen(guarded.problem.text), sizeof guarded.problem.text - 1);
  for (size_t k = 0; k < sizeof guarded.after; k++) assert_int_equal(guarded.after[k], 0);
}

static void the_first_problem_is_kept(void **state) {
  (void)state;
  struct problem problem = {0};
  problem_at(&problem, (struct place){"a.yaml", 3, 5}, "no %s", "value");
  problem_set(&problem, "another");
  assert_string_equal(problem.text, "a.yaml:3:5: no value");
}

static void a_file_is_read_whole_whatever_its_size(void **state) {
  (void)state;
  char folder[] = P_tmpdir "/photonlab-base-XXXXXX", path[64];
  static char bytes[200000];
  struct arena arena = arena_reserve();
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/file", folder);
  for (size_t k = 0; k < sizeof bytes; k++) bytes[k] = (char)(k * 37 % 251);
  static const size_t sizes[] = {0, 1, 2, 3, 4095, 4096, 65534, 65535, 65536, 200000};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    struct problem problem = {0};
    struct file_out out;
    struct text text;
    assert_true(file_begin(&out, path, &problem));
    fwrite(bytes, 1, sizes[k], out.stream);
    assert_true(file_commit(&out, &problem));
    assert_true(file_read(path, &arena, &text, &problem));
    assert_int_equal(text.length, sizes[k]);
    assert_memory_equal(text.data, bytes, sizes[k]);
    assert_int_equal(text.data[sizes[k]], 0);
  }
  unlink(path);
  rmdir(folder);
  arena_release(arena);
}

// The limit of a file's size stands for a full disk.
static void a_file_that_cannot_be_written_whole_says_why_and_leaves_nothing(void **state) {
  (void)state;
  char folder[] = P_tmpdir "/photonlab-base-XXXXXX", path[64];
  struct rlimit before, small = {1000, 1000};
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/file", folder);
  getrlimit(RLIMIT_FSIZE, &before);
  small.rlim_max = before.rlim_max;
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  for (int size = 1001; size < 100000; size *= 9) { // fails at the end, or long before it
    struct problem problem = {0};
    struct file_out out;
    assert_true(file_begin(&out, path, &problem));
    for (int k = 0; k < size; k++) fputc('x', out.stream);
    assert_false(file_commit(&out, &problem));
    assert_non_null(strstr(problem.text, "file: cannot write it: "));
    assert_non_null(strstr(problem.text, strerror(EFBIG)));
  }
  setrlimit(RLIMIT_FSIZE, &before);
  assert_int_equal(rmdir(folder), 0); // it is empty
}

static void a_directory_without_a_name_is_a_problem(void **state) {
  (void)state;
  struct problem problem = {0};
  assert_false(file_make_directory("", &problem));
  assert_string_equal(problem.text, "a directory without a name cannot be made");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_long_path_in_a_problem_is_cut),
      cmocka_unit_test(the_first_problem_is_kept),
      cmocka_unit_test(a_file_is_read_whole_whatever_its_size),
      cmocka_unit_test(a_file_that_cannot_be_written_whole_says_why_and_leaves_nothing),
      cmocka_unit_test(a_directory_without_a_name_is_a_problem),
  };
  return cmocka_run_group_tests_name("base", tests, NULL, NULL);
}
