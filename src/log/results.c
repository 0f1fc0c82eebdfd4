#include "log/results.h"

#include "base/file.h"

#include <errno.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

// A reader over the fields of one line of a CSV file without quotes.
struct csv {
  const char *path;
  char *at;
  int line;
  struct problem *problem;
};

static bool csv_bad(struct csv *csv, const char *what) {
  struct place place = {csv->path, csv->line, 1};
  return problem_at(csv->problem, place, "%s: the file is damaged, run the experiment again", what);
}

static char *csv_field(struct csv *csv) {
  char *field = csv->at;
  size_t length = strcspn(field, ",\n");
  csv->at += length + (field[length] != 0);
  field[length] = 0;
  return field;
}

static double csv_number(struct csv *csv) {
  char *field = csv_field(csv), *end;
  double value = strtod(field, &end);
  if (end == field || *end) csv_bad(csv, "a number is missing");
  return value;
}

static bool csv_open(struct csv *csv, const char *path, const char *header, struct arena *arena,
                     struct problem *problem) {
  struct text text;
  if (!file_read(path, arena, &text, problem)) return false;
  *csv = (struct csv){path, text.data, 1, problem};
  size_t length = strcspn(text.data, "\n");
  if (length != strlen(header) || memcmp(text.data, header, length) != 0)
    return csv_bad(csv, "unexpected columns");
  csv->at += length + (text.data[length] != 0);
  csv->line = 2;
  return true;
}

static char *log_header(struct arena *arena) {
  char *header = arena_string(arena, "", 0);
  for (int k = 0; k < n_log_columns; k++)
    header = arena_format(arena, "%s%s%s", header, k ? "," : "", log_columns[k].name);
  return header;
}

// ---- probes.csv ----

static struct probe read_probe(struct csv *csv) {
  struct probe probe = {0};
  probe.x = (int)csv_number(csv);
  probe.y = (int)csv_number(csv);
  probe.hit = csv_number(csv) != 0;
  double *const number[] = {&probe.p.x,          &probe.p.y,          &probe.p.z,
                            &probe.n.x,          &probe.n.y,          &probe.n.z,
                            &probe.scale_rgb[0], &probe.scale_rgb[1], &probe.scale_rgb[2],
                            &probe.emitted,      &probe.reference,    &probe.reference_se};
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) *number[k] = csv_number(csv);
  probe.scale = luminance(probe.scale_rgb, 3);
  return probe;
}

static bool read_probes(const char *path, struct arena *arena, struct results *results,
                        struct problem *problem) {
  struct csv csv;
  if (!csv_open(&csv, path, probes_header, arena, problem)) return false;
  int n_cells = results->experiment.n_cells;
  results->probe = arena_new(arena, struct probe *, n_cells);
  results->n_probes = arena_new(arena, int, n_cells);
  for (; *csv.at && !problem->text[0]; csv.line++) {
    int cell = (int)csv_number(&csv), probe = (int)csv_number(&csv);
    if (cell < 0 || cell >= n_cells || probe != results->n_probes[cell])
      return csv_bad(&csv, "a row is out of order");
    int have = results->n_probes[cell]++;
    results->probe[cell] = arena_grow(arena, results->probe[cell], have, have + 1,
                                      sizeof(struct probe), alignof(struct probe));
    results->probe[cell][probe] = read_probe(&csv);
  }
  return !problem->text[0];
}

// ---- log.csv ----

static void series_reserve(struct results *results, struct arena *arena) {
  for (int c = 0; c < results->experiment.n_cells; c++) results->n_series += results->n_probes[c];
  results->series = arena_new(arena, struct series, results->n_series);
  struct series *series = results->series;
  for (int c = 0; c < results->experiment.n_cells; c++)
    for (int p = 0; p < results->n_probes[c]; p++, series++) {
      uint64_t n = results->experiment.cell[c].iterations;
      *series = (struct series){.cell = c, .probe = p, .n_iterations = n};
      series->iteration = arena_new(arena, struct moments, (ptrdiff_t)n);
      series->checkpoint = arena_new(arena, uint64_t, (ptrdiff_t)n);
      series->average = arena_new(arena, struct moments, (ptrdiff_t)n);
    }
}

static struct series *series_find(struct results *results, int cell, int probe) {
  struct series *series = results->series;
  for (int c = 0; c < results->experiment.n_cells; c++) {
    if (c == cell && probe >= 0 && probe < results->n_probes[c]) return series + probe;
    series += results->n_probes[c];
  }
  return NULL;
}

static bool read_row(struct csv *csv, struct results *results) {
  int cell = (int)csv_number(csv);
  csv_field(csv); // scene
  int probe = (int)csv_number(csv);
  for (int skipped = 0; skipped < 4; skipped++) csv_field(csv); // integrator ... alpha
  bool average = strcmp(csv_field(csv), "average") == 0;
  double i = csv_number(csv);
  csv_number(csv); // radius follows from the law
  struct moments m;
  double *const number[] = {&m.n, &m.mean, &m.m2, &m.m3, &m.m4};
  for (size_t k = 0; k < sizeof number / sizeof *number; k++) *number[k] = csv_number(csv);
  struct series *series = series_find(results, cell, probe);
  if (!series || i < 1 || i > (double)series->n_iterations)
    return csv_bad(csv, "a row of an unknown cell, probe or iteration");
  if (!average) {
    series->iteration[(uint64_t)i - 1] = m;
  } else {
    series->checkpoint[series->n_checkpoints] = (uint64_t)i;
    series->average[series->n_checkpoints++] = m;
  }
  return true;
}

static bool read_log(const char *path, struct arena *arena, struct results *results,
                     struct problem *problem) {
  struct csv csv;
  if (!csv_open(&csv, path, log_header(arena), arena, problem)) return false;
  series_reserve(results, arena);
  for (; *csv.at && !problem->text[0]; csv.line++)
    if (!read_row(&csv, results)) return false;
  for (int k = 0; k < results->n_series && !problem->text[0]; k++)
    for (uint64_t i = 0; i < results->series[k].n_iterations; i++)
      if (results->series[k].iteration[i].n == 0) return csv_bad(&csv, "an iteration is missing");
  return !problem->text[0];
}

// ---- manifest.json ----

static bool read_manifest(const char *path, struct arena *arena, struct results *results,
                          const char **quality, const char **file, struct problem *problem) {
  json_error_t error;
  json_t *root = json_load_file(path, 0, &error);
  if (!root) {
    struct place place = {path, error.line, error.column};
    return problem_at(problem, place, "%s (is this a results directory of photonlab run?)",
                      error.text);
  }
  const char *text = json_string_value(json_object_get(root, "quality"));
  const char *name = json_string_value(json_object_get(root, "experiment"));
  json_t *cells = json_object_get(root, "cells");
  size_t n = json_array_size(cells);
  results->scene_hash = arena_new(arena, uint64_t, (ptrdiff_t)n);
  bool ok = text && name && json_is_array(cells);
  for (size_t c = 0; c < n && ok; c++) {
    const char *hash = json_string_value(json_object_get(json_array_get(cells, c), "scene_hash"));
    ok = hash != NULL;
    if (ok) results->scene_hash[c] = strtoull(hash, NULL, 16);
  }
  if (ok) *quality = arena_string(arena, text, (ptrdiff_t)strlen(text));
  if (ok) *file = arena_format(arena, "%s/%s.yaml", results->directory, name);
  json_decref(root);
  return ok || problem_set(problem, "%s: not a manifest of photonlab run", path);
}

bool results_read(const char *directory, struct arena *arena, struct results *results,
                  struct problem *problem) {
  *results = (struct results){.directory = directory};
  const char *quality, *file;
  return read_manifest(arena_format(arena, "%s/manifest.json", directory), arena, results, &quality,
                       &file, problem) &&
         experiment_read(file, quality, arena, &results->experiment, problem) &&
         read_probes(arena_format(arena, "%s/probes.csv", directory), arena, results, problem) &&
         read_log(arena_format(arena, "%s/log.csv", directory), arena, results, problem);
}
