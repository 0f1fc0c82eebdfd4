// What the fit writes: JSON another program can read, a table a person can read, a CSV for the
// figure; and how verdicts are put together.
#define _GNU_SOURCE // mkdtemp
#include "base/file.h"
#include "tests/statistical/fit_synthetic.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <jansson.h>
#include <stdlib.h>
#include <unistd.h>

static struct arena arena;
static char folder[] = "/tmp/photonlab-fit-XXXXXX";

static const struct synthetic base = {.name = "fit: written",
                                      .alpha = 2.0 / 3,
                                      .iterations = 300,
                                      .runs = 16,
                                      .photons_1 = 50,
                                      .curvature = 0.5,
                                      .closed_form = true};

static const char *written(const struct fit *fit,
                           bool (*write)(const struct fit *, const char *, struct problem *)) {
  const char *path = arena_format(&arena, "%s/out", folder);
  struct problem problem = {0};
  struct text text;
  assert_true(write(fit, path, &problem));
  assert_true(file_read(path, &arena, &text, &problem));
  unlink(path);
  return text.data;
}

static double real_at(json_t *object, const char *key) {
  json_t *value = json_object_get(object, key);
  assert_true(json_is_real(value));
  return json_real_value(value);
}

static void test_json(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  const char *text = written(&fit, fit_write_json);
  json_error_t error;
  json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, &error);
  assert_non_null(root);
  assert_string_equal(json_string_value(json_object_get(root, "experiment")), base.name);
  assert_string_equal(json_string_value(json_object_get(root, "quality")), "default");
  assert_string_equal(json_string_value(json_object_get(root, "verdict")), "agree");
  assert_true(real_at(root, "level") == 0.01);
  json_t *cells = json_object_get(root, "cells");
  assert_int_equal(json_array_size(cells), 2);
  for (size_t r = 0; r < 2; r++) {
    json_t *row = json_array_get(cells, r);
    json_t *ci = json_object_get(row, "rate_ci95");
    assert_true(real_at(row, "rate") == fit.row[r].rate); // 17 digits: the same double
    assert_true(real_at(row, "rate_se") == fit.row[r].rate_se);
    assert_true(json_real_value(json_array_get(ci, 0)) == fit.row[r].rate_lo);
    assert_true(json_real_value(json_array_get(ci, 1)) == fit.row[r].rate_hi);
    assert_true(real_at(row, "coefficient") == fit.row[r].coefficient);
    assert_int_equal(json_array_size(json_object_get(row, "tests")), fit.row[r].n_tests);
  }
  json_decref(root);
}

static void test_unknown_is_null(void **state) {
  (void)state;
  struct synthetic s = base;
  s.runs = 1;
  struct fit fit = synthetic_fit(&s, 1, &arena);
  json_t *root = json_loads(written(&fit, fit_write_json), 0, NULL);
  assert_non_null(root);
  json_t *row = json_array_get(json_object_get(root, "cells"), 0);
  assert_true(json_is_null(json_object_get(row, "rate")));
  assert_true(json_is_null(json_object_get(row, "coefficient")));
  assert_string_equal(json_string_value(json_object_get(row, "verdict")), "not-resolvable");
  json_decref(root);
}

static void test_same_bytes(void **state) {
  (void)state;
  struct fit once = synthetic_fit(&base, 1, &arena), again = synthetic_fit(&base, 1, &arena);
  assert_string_equal(written(&once, fit_write_json), written(&again, fit_write_json));
  assert_string_equal(written(&once, fit_write_curves), written(&again, fit_write_curves));
}

static int count_lines(const char *text) {
  int lines = 0;
  for (; *text; text++) lines += *text == '\n';
  return lines;
}

// Checkpoints at N / 2 and N, for variance and bias.
static void test_curves(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  assert_int_equal(count_lines(written(&fit, fit_write_curves)), 1 + 4);
  assert_int_equal(fit.n_points, 4);
  for (int p = 0; p < 4; p++) {
    const struct fit_point *point = &fit.point[p];
    assert_true(point->lower < point->measured && point->measured < point->upper);
  }
}

// The predicted curves are theory 3.2's: (A S- + C N) / N^2 and b_1 S+ / N, for the quadratic
// profile. C = (R_2 Laplacian / 4 q - mu^2) / N_e; with r_1 = 1 and E = 1 - d^2 / 2 the box has
// A = 1 / lambda_1, b_1 = -1/4 and the middle term -A / 4; mu^2 / N_e is 1e-9.
static void test_predicted_curves(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  const struct law *law = law_find("knaus-zwicker");
  for (int p = 0; p < 4; p++) {
    const struct fit_point *point = &fit.point[p];
    double n = (double)point->n, minus = 0, plus = 0;
    for (uint64_t i = 1; i <= point->n; i++) {
      minus += 1 / law->rho(base.alpha, i);
      plus += law->rho(base.alpha, i);
    }
    double expected =
        point->row->quantity == QUANTITY_BIAS ? -0.25 * plus / n : (minus - n / 4) / 50 / (n * n);
    assert_true(fabs(point->predicted / expected - 1) < 1e-6);
  }
}

static char *table_of(const struct fit *fit) {
  char *text = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&text, &size);
  fit_print_table(fit, stream);
  fclose(stream);
  return text;
}

static void test_table(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  char *text = table_of(&fit);
  assert_int_equal(count_lines(text), 1 + 2 + 1);
  assert_null(strchr(text, '\033')); // not a terminal
  assert_non_null(strstr(text, "0.6667"));
  assert_non_null(strstr(text, "fit: written: agree (family-wise level 0.01"));
  assert_null(strstr(text, "kernel")); // the same in all rows
  for (const char *line = text; *line; line = strchr(line, '\n') + 1)
    assert_true(strchr(line, '\n') - line <= 110);
  free(text);
}

// Sidak: the chance that none of n independent tests rejects is 0.99.
static void test_level(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  int n = fit.row[0].n_tests + fit.row[1].n_tests;
  assert_int_equal(n, 8);
  assert_true(fabs(pow(1 - fit.test_level, n) - 0.99) < 1e-12);
}

static int make_folder(void **state) {
  (void)state;
  arena = arena_reserve();
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      {"fit.json holds every number to the last bit", test_json, 0, 0, 0},
      {"what is not known is null", test_unknown_is_null, 0, 0, 0},
      {"the same results give the same bytes", test_same_bytes, 0, 0, 0},
      {"curves.csv has a line per checkpoint and quantity", test_curves, 0, 0, 0},
      {"the predicted curves are those of theory 3.2", test_predicted_curves, 0, 0, 0},
      {"the table has a line per row, no colour in a file, at most 110 columns", test_table, 0, 0,
       0},
      {"the level is divided over all tests of the run", test_level, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fit", tests, make_folder, remove_folder);
}
