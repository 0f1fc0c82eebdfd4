// A fit of synthetic results, and what it writes into a temporary folder.
#ifndef TESTS_FIT_FIXTURE_H
#define TESTS_FIT_FIXTURE_H

#include "base/file.h"
#include "experiment/cell_keys.h"
#include "tests/statistical/fit_synthetic.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = P_tmpdir "/photonlab-fit-XXXXXX";

static const struct synthetic base = {.name = "fit: written",
                                      .alpha = 2.0 / 3,
                                      .iterations = 300,
                                      .runs = 16,
                                      .photons_1 = 50,
                                      .curvature = 0.5,
                                      .closed_form = true};

static inline const char *
written(const struct fit *fit, bool (*write)(const struct fit *, const char *, struct problem *)) {
  const char *path = arena_format(&arena, "%s/out", folder);
  struct problem problem = {0};
  struct text text;
  assert_true(write(fit, path, &problem));
  assert_true(file_read(path, &arena, &text, &problem));
  unlink(path);
  return text.data;
}

static inline int count_lines(const char *text) {
  int lines = 0;
  for (; *text; text++) lines += *text == '\n';
  return lines;
}

// The c-th point of a curve.
static inline int make_folder(void **state) {
  (void)state;
  arena = arena_reserve();
  return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

#endif
