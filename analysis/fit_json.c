// fit.json and curves.csv.
#include "analysis/fit_methods.h"
#include "analysis/fit_rows.h"

#include "base/file.h"
#include "experiment/cell_keys.h"
#include "log/cell_json.h"

#include <assert.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *number(double x) { return isfinite(x) ? json_real(x) : json_null(); }

static void set(json_t *object, const char *key, json_t *value) {
  int code = json_object_set_new(object, key, value);
  assert(code == 0);
  (void)code;
}

static const char *quantity_name(enum quantity quantity) {
  return quantity == QUANTITY_VARIANCE ? "variance" : "bias";
}

static json_t *tests_json(const struct fit_row *row) {
  json_t *array = json_array();
  for (int t = 0; t < row->n_tests; t++) {
    const struct fit_test *test = &row->test[t];
    json_t *object = json_object();
    set(object, "name", json_string(test->name));
    set(object, "statistic", number(test->statistic));
    set(object, "p", number(test->p));
    set(object, "verdict",
        json_string(verdict_names[test->rejects ? VERDICT_DISAGREE : VERDICT_AGREE]));
    json_array_append_new(array, object);
  }
  return array;
}

static void set_identity(json_t *object, const struct fit_row *row) {
  cell_json_set(object, row->cell);
  set(object, "probe", json_pack("[i, i]", row->probe->x, row->probe->y));
  set(object, "quantity", json_string(quantity_name(row->quantity)));
  set(object, "closed_form", json_boolean(row->closed_form));
  set(object, "first_iteration", json_integer((json_int_t)row->first));
}

static json_t *interval_json(double lo, double hi) {
  json_t *pair = json_array();
  json_array_append_new(pair, number(lo));
  json_array_append_new(pair, number(hi));
  return pair;
}

static json_t *row_json(const struct fit_row *row) {
  json_t *object = json_object();
  set_identity(object, row);
  set(object, "rate_theory", number(row->rate_theory));
  set(object, "rate", number(row->rate));
  set(object, "rate_se", number(row->rate_se));
  set(object, "rate_ci95", interval_json(row->rate_lo, row->rate_hi));
  set(object, "coefficient_theory", number(row->coefficient_theory));
  set(object, "coefficient", number(row->coefficient));
  set(object, "coefficient_se", number(row->coefficient_se));
  if (row->quantity == QUANTITY_BIAS) {
    set(object, "snr", number(row->snr));
    set(object, "expected_snr", number(row->expected_snr));
    set(object, "upper_bound", number(row->upper_bound));
  }
  set(object, "tests", tests_json(row));
  set(object, "verdict", json_string(verdict_names[row->verdict]));
  set(object, "why", row->why ? json_string(row->why) : json_null());
  return object;
}

bool fit_write_json(const struct fit *fit, const char *path, struct problem *problem) {
  json_t *root = json_object(), *cells = json_array();
  set(root, "experiment", json_string(fit->experiment->name));
  set(root, "quality", json_string(fit->experiment->quality));
  set(root, "method", json_string(fit->method->name));
  if (fit->method->caveat) set(root, "caveat", json_string(fit->method->caveat));
  set(root, "level", number(fit->level));
  set(root, "test_level", number(fit->test_level));
  set(root, "verdict", json_string(verdict_names[fit->verdict]));
  for (int r = 0; r < fit->n_rows; r++) json_array_append_new(cells, row_json(&fit->row[r]));
  set(root, "cells", cells);

  struct file_out out;
  bool begun = file_begin(&out, path, problem);
  if (begun) {
    json_dumpf(root, out.stream, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    fputc('\n', out.stream);
  }
  json_decref(root);
  return begun && file_commit(&out, problem);
}

// Our names need no quotes, but a scene's may: then a quote is doubled.
static void print_field(FILE *stream, const char *text) {
  if (!strpbrk(text, ",\"\n")) {
    fprintf(stream, "%s,", text);
    return;
  }
  fputc('"', stream);
  for (; *text; text++) {
    if (*text == '"') fputc('"', stream);
    fputc(*text, stream);
  }
  fputs("\",", stream);
}

void fit_print_keys(FILE *stream, const struct cell *cell) {
  char buffer[CELL_KEY_SIZE];
  for (int k = 0; k < CELL_KEYS; k++) print_field(stream, cell_keys[k].text(cell, 17, buffer));
}

static void print_point(FILE *stream, const struct fit_point *point) {
  const struct fit_row *row = point->row;
  // A curve that was fitted, not predicted, to a bias that was not found would only show noise.
  bool known = row->quantity == QUANTITY_VARIANCE || isfinite(row->coefficient_theory) ||
               row->verdict == VERDICT_AGREE || row->verdict == VERDICT_DISAGREE;
  fit_print_keys(stream, row->cell);
  fprintf(stream, "%d,%d,%s,%s,%llu,%llu", row->probe->x, row->probe->y,
          quantity_name(row->quantity), point->series == CURVE_AVERAGE ? "average" : "iteration",
          (unsigned long long)point->first, (unsigned long long)point->n);
  const double value[] = {point->measured, point->lower, point->upper, point->pooled,
                          known ? point->predicted : NAN};
  for (int k = 0; k < 5; k++)
    isfinite(value[k]) ? fprintf(stream, ",%.17g", value[k]) : fputs(",nan", stream);
  fputc('\n', stream);
}

bool fit_write_curves(const struct fit *fit, const char *path, struct problem *problem) {
  struct file_out out;
  if (!file_begin(&out, path, problem)) return false;
  for (int k = 0; k < CELL_KEYS; k++) fprintf(out.stream, "%s,", cell_keys[k].name);
  fputs("x,y,quantity,series,first,N,measured,lower,upper,pooled,predicted\n", out.stream);
  for (int p = 0; p < fit->n_points; p++) print_point(out.stream, &fit->point[p]);
  return file_commit(&out, problem);
}
