// What the fit writes: JSON another program can read, a table a person can read; and how verdicts
// are put together.
#define _GNU_SOURCE // mkdtemp
#include "fit_fixture.h"

#include <jansson.h>

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

enum kind { STRING, REASON, NUMBER, PAIR, COUNT, TRUTH, LIST };
struct key {
  const char *name;
  enum kind kind;
};
#define END                                                                                        \
  { NULL, STRING }

static const struct key top_keys[] = {
    {"experiment", STRING}, {"quality", STRING}, {"method", STRING}, {"level", NUMBER},
    {"test_level", NUMBER}, {"verdict", STRING}, {"cells", LIST},    END};
static const struct key row_keys[] = {{"cell", COUNT},
                                      {"scene", STRING},
                                      {"probe", PAIR},
                                      {"integrator", STRING},
                                      {"kernel", STRING},
                                      {"law", STRING},
                                      {"alpha", NUMBER},
                                      {"reference-radius", STRING},
                                      {"radius", NUMBER},
                                      {"radius-volume", NUMBER},
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
static const struct key added_keys[] = {
    {"closed_form", TRUTH}, {"first_iteration", COUNT}, {"why", REASON}, END};
static const struct key bias_keys[] = {
    {"snr", NUMBER}, {"expected_snr", NUMBER}, {"upper_bound", NUMBER}, END};
static const struct key test_keys[] = {
    {"name", STRING}, {"statistic", NUMBER}, {"p", NUMBER}, {"verdict", STRING}, END};

static bool is_number(json_t *value) { return json_is_number(value) || json_is_null(value); }

static bool is_kind(json_t *value, enum kind kind) {
  switch (kind) {
  case STRING:
    return json_is_string(value);
  case REASON:
    return json_is_string(value) || json_is_null(value);
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
  assert_string_equal(json_string_value(json_object_get(row, "why")), "one run");
  assert_string_equal(json_string_value(json_object_get(row, "verdict")), "not-resolvable");
  json_decref(root);
}

static void test_same_bytes(void **state) {
  (void)state;
  struct fit once = synthetic_fit(&base, 1, &arena), again = synthetic_fit(&base, 1, &arena);
  assert_string_equal(written(&once, fit_write_json), written(&again, fit_write_json));
  assert_string_equal(written(&once, fit_write_curves), written(&again, fit_write_curves));
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
  other[k++].radius = 1.0000005, other[k++].radius_volume = 0.3, other[k++].k++,
  other[k++].photons++;
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

static void table_says(struct synthetic s, const char *says) {
  struct fit fit = synthetic_fit(&s, 1, &arena);
  char *text = table_of(&fit);
  if (!strstr(text, says)) fail_msg("expected '%s' in\n%s", says, text);
  free(text);
}

// What has no rate says why, and the last line counts the verdicts.
static void test_table_says_why(void **state) {
  (void)state;
  struct synthetic one = base, few = base, single = base;
  one.runs = 1;
  table_says(one, "not-resolvable: one run");
  table_says(one, ": not-resolvable (2 not-resolvable; family-wise");
  few.runs = 4, few.iterations = 9; // standard errors of rates above 0.3
  table_says(few, "not-resolvable: too little data (photonlab plan: how many runs)");
  single.iterations = 1;
  table_says(single, "not-resolvable: one iteration");
}

// No bias is detected, but that is not all: the variance's rate is not known either.
static void test_not_detected_is_not_all(void **state) {
  (void)state;
  struct synthetic s = base;
  s.curvature = 0, s.runs = 4, s.iterations = 9;
  struct fit fit = synthetic_fit(&s, 1, &arena);
  assert_int_equal(fit.row[0].verdict, VERDICT_NOT_RESOLVABLE);
  assert_int_equal(fit.row[1].verdict, VERDICT_NOT_DETECTED);
  assert_int_equal(fit.verdict, VERDICT_NOT_RESOLVABLE);
}

// Sidak: the chance that none of n independent tests rejects is 0.99.
static void test_level(void **state) {
  (void)state;
  struct fit fit = synthetic_fit(&base, 1, &arena);
  int n = fit.row[0].n_tests + fit.row[1].n_tests;
  assert_int_equal(n, 8);
  assert_true(fabs(pow(1 - fit.test_level, n) - 0.99) < 1e-12);
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
      {"the table has a line per row, no colour in a file, at most 110 columns", test_table, 0, 0,
       0},
      {"the table tells cells apart by the key that differs", test_table_tells_cells_apart, 0, 0,
       0},
      {"the table says why there is no rate", test_table_says_why, 0, 0, 0},
      {"a run is not-detected only if all of it is", test_not_detected_is_not_all, 0, 0, 0},
      {"the level is divided over all tests of the run", test_level, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("fit", tests, make_folder, remove_folder);
}
