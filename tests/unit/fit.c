// What the fit writes: JSON another program can read, a table a person can read, a CSV for the
// figure; and how verdicts are put together.
#define _GNU_SOURCE // mkdtemp
#include "base/file.h"
#include "experiment/cell_keys.h"
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
static char folder[] = P_tmpdir "/photonlab-fit-XXXXXX";

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
    assert_true(real_at(row, "alpha") == base.alpha);
    assert_true(real_at(row, "rate") == fit.row[r].rate); // 17 digits: the same double
    assert_true(real_at(row, "rate_se") == fit.row[r].rate_se);
    assert_true(json_real_value(json_array_get(ci, 0)) == fit.row[r].rate_lo);
    assert_true(json_real_value(json_array_get(ci, 1)) == fit.row[r].rate_hi);
    assert_true(real_at(row, "coefficient") == fit.row[r].coefficient);
    assert_int_equal(json_array_size(json_object_get(row, "tests")), fit.row[r].n_tests);
  }
  json_decref(root);
}

enum kind { STRING, NUMBER, PAIR, COUNT, TRUTH, LIST };
struct key {
  const char *name;
  enum kind kind;
};
#define END                                                                                        \
  { NULL, STRING }

static const struct key top_keys[] = {{"experiment", STRING},
                                      {"quality", STRING},
                                      {"method", STRING},
                                      {"level", NUMBER},
                                      {"test_level", NUMBER},
                                      {"verdict", STRING},
                                      {"cells", LIST},
                                      END};
static const struct key row_keys[] = {{"cell", COUNT},
                                      {"scene", STRING},
                                      {"probe", PAIR},
                                      {"integrator", STRING},
                                      {"kernel", STRING},
                                      {"law", STRING},
                                      {"alpha", NUMBER},
                                      {"reference-radius", STRING},
                                      {"radius", NUMBER},
                                      {"k", COUNT},
                                      {"photons", COUNT},
                                      {"iterations", COUNT},
                                      {"runs", COUNT},
                                      {"seed", STRING},
                                      {"direct", STRING},
                                      {"view", STRING},
                                      {"depth", COUNT},
                                      {"pixel", STRING},
                                      {"hit-points", COUNT},
                                      {"quantity", STRING},
                                      {"rate_theory", NUMBER},
                                      {"rate", NUMBER},
                                      {"rate_se", NUMBER},
                                      {"rate_ci95", PAIR},
                                      {"coefficient_theory", NUMBER},
                                      {"coefficient", NUMBER},
                                      {"coefficient_se", NUMBER},
                                      {"tests", LIST},
                                      {"verdict", STRING},
                                      END};
// What the fit adds of its own.
static const struct key added_keys[] = {{"closed_form", TRUTH}, {"first_iteration", COUNT}, END};
static const struct key bias_keys[] = {
    {"snr", NUMBER}, {"expected_snr", NUMBER}, {"upper_bound", NUMBER}, END};
static const struct key test_keys[] = {
    {"name", STRING}, {"statistic", NUMBER}, {"p", NUMBER}, {"verdict", STRING}, END};

static bool is_number(json_t *value) { return json_is_number(value) || json_is_null(value); }

static bool is_kind(json_t *value, enum kind kind) {
  switch (kind) {
  case STRING:
    return json_is_string(value);
  case NUMBER:
    return is_number(value);
  case COUNT:
    return json_is_integer(value);
  case TRUTH:
    return json_is_boolean(value);
  case LIST:
    return json_is_array(value);
  case PAIR:
    return json_array_size(value) == 2 && is_number(json_array_get(value, 0)) &&
           is_number(json_array_get(value, 1));
  }
  return false;
}

static size_t check_keys(json_t *object, const struct key *key) {
  size_t n = 0;
  for (; key->name; key++, n++)
    if (!is_kind(json_object_get(object, key->name), key->kind)) fail_msg("%s", key->name);
  return n;
}

static void assert_one_of(json_t *value, const char *const *names, int n) {
  for (int k = 0; k < n; k++)
    if (strcmp(json_string_value(value), names[k]) == 0) return;
  fail_msg("%s", json_string_value(value));
}

static void check_row(json_t *row) {
  json_t *quantity = json_object_get(row, "quantity"), *test;
  bool bias = strcmp(json_string_value(quantity), "bias") == 0;
  size_t index, keys = check_keys(row, row_keys) + check_keys(row, added_keys);
  if (bias) keys += check_keys(row, bias_keys);
  assert_int_equal(json_object_size(row), keys);
  assert_one_of(quantity, (const char *[]){"variance", "bias"}, 2);
  assert_one_of(json_object_get(row, "verdict"),
                (const char *[]){"agree", "disagree", "not-detected", "not-resolvable"}, 4);
  json_array_foreach(json_object_get(row, "tests"), index, test) {
    assert_int_equal(json_object_size(test), check_keys(test, test_keys));
    assert_one_of(json_object_get(test, "verdict"), (const char *[]){"agree", "disagree"}, 2);
  }
}

// Agreement, a bias not detected, one run, disagreement.
static void test_schema(void **state) {
  (void)state;
  struct synthetic s[] = {base, base, base, base};
  s[1].curvature = 0, s[2].runs = 1, s[3].factor = 0.5;
  for (int k = 0; k < 4; k++) {
    struct fit fit = synthetic_fit(&s[k], 1, &arena);
    json_t *root = json_loads(written(&fit, fit_write_json), JSON_REJECT_DUPLICATES, NULL), *row;
    size_t index;
    assert_int_equal(json_object_size(root), check_keys(root, top_keys));
    json_array_foreach(json_object_get(root, "cells"), index, row) check_row(row);
    assert_int_equal(index, 2);
    json_decref(root);
  }
}

// A rate goes with agreement or disagreement, never with another verdict.
static void test_no_rate_without_verdict(void **state) {
  (void)state;
  struct synthetic s = base;
  s.curvature = 0;
  struct fit fit = synthetic_fit(&s, 1, &arena);
  json_t *root = json_loads(written(&fit, fit_write_json), 0, NULL);
  json_t *row = json_array_get(json_object_get(root, "cells"), 1);
  assert_string_equal(json_string_value(json_object_get(row, "verdict")), "not-detected");
  json_t *ci = json_object_get(row, "rate_ci95");
  assert_true(json_is_null(json_object_get(row, "rate")));
  assert_true(json_is_null(json_object_get(row, "rate_se")));
  assert_true(json_is_null(json_array_get(ci, 0)) && json_is_null(json_array_get(ci, 1)));
  assert_true(json_is_real(json_object_get(row, "upper_bound")));
  json_decref(root);
}

// Before any scene is read.
static void test_value_that_is_not_finite(void **state) {
  (void)state;
  struct moments iteration[] = {{2, 1, 0.5, 0, 0}, {2, NAN, NAN, NAN, NAN}};
  struct series series = {.n_iterations = 2, .iteration = iteration};
  struct probe probe = {.x = 3, .y = 5}, *probes[] = {&probe};
  struct cell cell = {.scene_path = "none.pbrt"};
  struct results results = {.directory = "somewhere",
                            .experiment = {.cell = &cell, .n_cells = 1},
                            .probe = probes,
                            .series = &series,
                            .n_series = 1};
  struct fit fit;
  struct problem problem = {0};
  assert_false(fit_results(&results, &arena, &fit, &problem));
  assert_string_equal(problem.text,
                      "somewhere/log.csv: cell 0, probe 3,5, iteration 2 is not finite");
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

// The c-th point of a curve.
static const struct fit_point *point_at(const struct fit *fit, enum quantity quantity,
                                        enum curve_series series, int c) {
  for (int p = 0; p < fit->n_points; p++) {
    const struct fit_point *point = &fit->point[p];
    if (point->row->quantity == quantity && point->series == series && c-- == 0) return point;
  }
  fail_msg("no such point");
  return NULL;
}

// Checkpoints at N / 2 and N, for variance and bias, of single iterations and their average.
static void test_curves(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  const char *text = written(&fit, fit_write_curves);
  assert_int_equal(count_lines(text), 1 + 8);
  for (int k = 0; k < CELL_KEYS; k++) { // the first columns, in this order
    size_t length = strlen(cell_keys[k].name);
    assert_memory_equal(text, cell_keys[k].name, length);
    assert_int_equal(text[length], ',');
    text += length + 1;
  }
  const char *rest = "x,y,quantity,series,first,N,measured,lower,upper,pooled,predicted\n";
  assert_memory_equal(text, rest, strlen(rest));
  assert_non_null(strstr(text, ",variance,iteration,151,300,"));
  assert_non_null(strstr(text, ",bias,average,1,300,"));
  assert_int_equal(fit.n_points, 8);
  for (int p = 0; p < 8; p++) {
    const struct fit_point *point = &fit.point[p];
    assert_true(point->lower < point->measured && point->measured < point->upper);
  }
}

// Averages are made of their iterations: with m of them in a bin, the bias of the average is the
// sum of m bias / N, and its variance, as independent iterations have it, that of m variance / N^2.
static void test_bins_make_the_average(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  double variance = 0, bias = 0;
  for (int c = 0; c < 2; c++) {
    const struct fit_point *of_variance = point_at(&fit, QUANTITY_VARIANCE, CURVE_ITERATION, c);
    const struct fit_point *of_bias = point_at(&fit, QUANTITY_BIAS, CURVE_ITERATION, c);
    const struct fit_point *average = point_at(&fit, QUANTITY_VARIANCE, CURVE_AVERAGE, c);
    double n = (double)of_bias->n;
    assert_true(of_bias->first == (c == 0 ? 1 : 151) && of_variance->first == of_bias->first);
    assert_true(average->first == 1 && average->n == of_variance->n);
    variance += (n - (double)of_variance->first + 1) * of_variance->measured;
    bias += (n - (double)of_bias->first + 1) * of_bias->measured;
    assert_true(fabs(variance / (n * n) / average->pooled - 1) < 1e-12);
    double measured = point_at(&fit, QUANTITY_BIAS, CURVE_AVERAGE, c)->measured;
    assert_true(fabs(bias / n / measured - 1) < 1e-12);
  }
}

static double late(double alpha, double rho, uint64_t i) {
  (void)alpha;
  return i <= 150 ? 1e-12 : rho;
}

// At the first checkpoint no photon was found, and the fit begins later.
static void test_curve_that_begins_dark(void **state) {
  (void)state;
  struct synthetic s = base;
  s.closed_form = false, s.r2 = late;
  struct prediction theory = synthetic_prediction(&s, &arena);
  theory.first = 200;
  struct fit fit = synthetic_fit_with(&s, &theory, 1, &arena);
  for (int k = 0; k < N_CURVE_SERIES; k++) {
    const struct fit_point *dark = point_at(&fit, QUANTITY_VARIANCE, k, 0);
    const struct fit_point *lit = point_at(&fit, QUANTITY_VARIANCE, k, 1);
    assert_true(dark->measured == 0 && isnan(dark->lower));
    assert_true(lit->lower < lit->measured);
  }
  assert_int_equal(fit.row[0].first, 201);
  // This bin begins at 151, before what is predicted.
  assert_true(isnan(point_at(&fit, QUANTITY_VARIANCE, CURVE_ITERATION, 1)->predicted));
}

// A photon that was hardly to be expected (0.002 in all): no interval rather than one without it.
static void test_interval_of_a_lucky_photon(void **state) {
  (void)state;
  struct synthetic s = base;
  s.name = "fit: lucky", s.photons_1 = 1e-4, s.iterations = 10, s.runs = 2, s.curvature = 0;
  int found = 0;
  for (uint64_t e = 1; e <= 3000; e++) {
    struct arena scratch = arena;
    struct fit fit = synthetic_fit(&s, e, &scratch);
    for (int p = 0; p < fit.n_points; p++) {
      const struct fit_point *point = &fit.point[p];
      assert_false(point->measured < point->lower || point->measured > point->upper);
      found += point->row->quantity == QUANTITY_VARIANCE && point->measured > 0;
    }
  }
  assert_true(found > 0);
}

// With two runs of one iteration the variance has one degree of freedom, nearly: the interval is
// Cauchy's, 12.7 standard errors to either side, and not 1.96.
static void test_interval_of_two_values(void **state) {
  (void)state;
  struct synthetic s = base;
  s.gaussian = true, s.iterations = 1, s.runs = 2, s.photons_1 = 1e4;
  struct fit fit = synthetic_fit(&s, 1, &arena);
  for (int k = 0; k < N_CURVE_SERIES; k++) {
    const struct fit_point *point = point_at(&fit, QUANTITY_BIAS, k, 0);
    double se = sqrt(point_at(&fit, QUANTITY_VARIANCE, k, 0)->measured / 2);
    assert_true(fabs((point->upper - point->lower) / 2 / se - 12.706) < 0.01);
  }
}

// The predicted curves are theory 3.2's: (A S- + C N) / N^2 and b_1 S+ / N, for the quadratic
// profile; of the m single iterations of a bin (A (S- from first to N) + C m) / m and the like. C =
// (R_2 Laplacian / 4 q - mu^2) / N_e; with r_1 = 1 and E = 1 - d^2 / 2 the box has A = 1 /
// lambda_1, b_1 = -1/4 and the middle term -A / 4; mu^2 / N_e is 1e-9.
static void test_predicted_curves(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  const struct law *law = law_find("knaus-zwicker");
  for (int p = 0; p < 8; p++) {
    const struct fit_point *point = &fit.point[p];
    double m = (double)(point->n - point->first + 1), minus = 0, plus = 0;
    for (uint64_t i = point->first; i <= point->n; i++) {
      minus += 1 / law->rho(base.alpha, i);
      plus += law->rho(base.alpha, i);
    }
    double variance = (minus - m / 4) / 50 / m;
    if (point->series == CURVE_AVERAGE) variance /= m;
    double expected = point->row->quantity == QUANTITY_BIAS ? -0.25 * plus / m : variance;
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
  assert_non_null(strstr(text, "fit: written: agree (2 agree; family-wise level 0.01"));
  assert_null(strstr(text, "kernel")); // the same in all rows
  for (const char *line = text; *line; line = strchr(line, '\n') + 1)
    assert_true(strchr(line, '\n') - line <= 110);
  free(text);
}

// The words of a line.
static int count_words(const char *line) {
  int words = 0;
  for (; *line != '\n'; line++) words += *line != ' ' && (line[1] == ' ' || line[1] == '\n');
  return words;
}

// Two cells that differ in one key only: the table has a column more than one of equal cells.
static void test_table_tells_cells_apart(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  struct cell cell = *fit.row[0].cell, other[CELL_KEYS];
  for (int k = 0; k < CELL_KEYS; k++) other[k] = cell;
  struct integrator_type integrator = *cell.integrator;
  integrator.name = "another";
  int k = 0;
  other[k++].number++, other[k++].scene = "another", other[k++].integrator = &integrator;
  other[k++].kernel = kernel_find("cone"), other[k++].law = law_find("power");
  other[k++].alpha = 0.66667, other[k++].reference_radius = &reference_radii[1];
  other[k++].radius = 1.0000005, other[k++].k++, other[k++].photons++;
  other[k++].iterations++, other[k++].runs++, other[k++].seed++, other[k++].direct = DIRECT_NEE;
  other[k++].left_out = 1;
  other[k++].depth++, other[k++].footprint = true, other[k++].hit_points = 4;
  assert_int_equal(k, CELL_KEYS);
  fit.row[1] = fit.row[0];
  char *same = table_of(&fit);
  for (k = 0; k < CELL_KEYS; k++) {
    assert_non_null(other[k].law);
    fit.row[1].cell = &other[k];
    char *text = table_of(&fit), *first = strchr(text, '\n') + 1, *second = strchr(first, '\n') + 1;
    assert_non_null(strstr(text, cell_keys[k].name));
    assert_int_equal(count_words(text), count_words(same) + !cell_keys[k].always);
    assert_memory_not_equal(first, second, (size_t)(second - first));
    for (int c = 0; c < CELL_KEYS; c++) {
      char one[CELL_KEY_SIZE], two[CELL_KEY_SIZE];
      bool differ =
          strcmp(cell_keys[c].text(&cell, 17, one), cell_keys[c].text(&other[k], 17, two));
      assert_int_equal(differ, c == k);
    }
    free(text);
  }
  free(same);
}

// What there is no fit for says why, and the last line counts the verdicts.
static void test_table_says_why(void **state) {
  (void)state;
  struct synthetic s = base;
  s.runs = 1;
  struct fit fit = synthetic_fit(&s, 1, &arena);
  char *text = table_of(&fit);
  assert_non_null(strstr(text, "not-resolvable: one run"));
  assert_non_null(strstr(text, ": not-resolvable (2 not-resolvable; family-wise"));
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
      {"fit.json has these keys and no others", test_schema, 0, 0, 0},
      {"a bias that is not detected has no rate", test_no_rate_without_verdict, 0, 0, 0},
      {"a value that is not finite is a problem with its place", test_value_that_is_not_finite, 0,
       0, 0},
      {"what is not known is null", test_unknown_is_null, 0, 0, 0},
      {"the same results give the same bytes", test_same_bytes, 0, 0, 0},
      {"curves.csv has a line per checkpoint, quantity and series", test_curves, 0, 0, 0},
      {"the bins of single iterations make up the average", test_bins_make_the_average, 0, 0, 0},
      {"a curve may begin before any light", test_curve_that_begins_dark, 0, 0, 0},
      {"an interval holds what was measured or is not stated", test_interval_of_a_lucky_photon, 0,
       0, 0},
      {"two values have Cauchy's interval", test_interval_of_two_values, 0, 0, 0},
      {"the predicted curves are those of theory 3.2", test_predicted_curves, 0, 0, 0},
      {"the table has a line per row, no colour in a file, at most 110 columns", test_table, 0, 0,
       0},
      {"the table tells cells apart by the key that differs", test_table_tells_cells_apart, 0, 0,
       0},
      {"the table says why there is no fit", test_table_says_why, 0, 0, 0},
      {"the level is divided over all tests of the run", test_level, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fit", tests, make_folder, remove_folder);
}
