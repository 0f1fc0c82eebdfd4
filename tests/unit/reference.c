// An unfinished reference is kept, taken up as it was, and never believed when it is damaged.
#define _GNU_SOURCE // mkdtemp
#include "run/reference_cache.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 3 };

static struct arena arena;
static char folder[] = P_tmpdir "/photonlab-reference-XXXXXX";

static char *path_of(const char *name) { return arena_format(&arena, "%s/%s", folder, name); }

static struct moments_tree tree_of(uint64_t leaves) {
  struct moments_tree tree = moments_tree_new(WIDTH, &arena);
  for (uint64_t k = 0; k < leaves; k++) {
    struct moments leaf[WIDTH];
    for (int p = 0; p < WIDTH; p++) leaf[p] = moments_of(2.385 * (double)k - p);
    moments_tree_push(&tree, leaf, &arena);
  }
  return tree;
}

static void expect_same(const struct moments_tree *a, const struct moments_tree *b) {
  struct moments root_a[WIDTH], root_b[WIDTH];
  assert_int_equal(a->count, b->count);
  moments_tree_root(a, root_a);
  moments_tree_root(b, root_b);
  assert_memory_equal(root_a, root_b, sizeof root_a);
}

static void what_is_kept_is_taken_up_and_goes_on_to_the_same_bits(void **state) {
  (void)state;
  const char *path = path_of("kept.csv");
  for (uint64_t leaves = 1; leaves < 20; leaves++) {
    struct moments_tree whole = tree_of(leaves + 1), part = tree_of(leaves);
    reference_keep(path, &part, arena);
    struct moments_tree taken = reference_take_up(path, WIDTH, &arena);
    expect_same(&taken, &part);
    struct moments leaf[WIDTH];
    for (int p = 0; p < WIDTH; p++) leaf[p] = moments_of(2.385 * (double)leaves - p);
    moments_tree_push(&taken, leaf, &arena);
    expect_same(&taken, &whole);
  }
  reference_forget(path, arena);
  assert_int_equal(reference_take_up(path, WIDTH, &arena).count, 0);
}

static void a_damaged_or_foreign_file_is_as_good_as_none(void **state) {
  (void)state;
  const char *path = path_of("damaged.csv"), *file = path_of("damaged.csv.unfinished");
  struct moments_tree tree = tree_of(5);
  struct problem problem = {0};
  struct text text;
  reference_keep(path, &tree, arena);
  assert_int_equal(reference_take_up(path, WIDTH + 1, &arena).count, 0);
  assert_true(file_read(file, &arena, &text, &problem));
  for (ptrdiff_t at = 0; at < text.length; at += 7) { // one bit flipped, or cut there
    for (int cut = 0; cut < 2; cut++) {
      char *bytes = arena_string(&arena, text.data, text.length);
      bytes[at] = (char)(bytes[at] ^ 16);
      FILE *out = fopen(file, "wb");
      fwrite(bytes, 1, (size_t)(cut ? at : text.length), out);
      fclose(out);
      struct moments_tree taken = reference_take_up(path, WIDTH, &arena);
      if (taken.count) fail_msg("believed with byte %td %s", at, cut ? "cut" : "changed");
    }
  }
  reference_forget(path, arena);
}

int main(void) {
  arena = arena_reserve();
  if (!mkdtemp(folder)) return 1;
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_kept_is_taken_up_and_goes_on_to_the_same_bits),
      cmocka_unit_test(a_damaged_or_foreign_file_is_as_good_as_none),
  };
  int failed = cmocka_run_group_tests_name("reference", tests, NULL, NULL);
  return rmdir(folder) != 0 || failed;
}
