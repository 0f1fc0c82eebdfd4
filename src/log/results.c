#include "log/results.h"

#include "base/file.h"
#include "log/csv.h"
#include "log/runs.h"

#include <assert.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

static char *log_header(struct arena *arena) {
  char *header = arena_string(arena, "", 0);
  for (int k = 0; k < n_log_columns; k++)
    header = arena_format(arena, "%s%s%s", header, k ? "," : "", log_columns[k].name);
  return header;
}

// ---- probes.csv ----

enum { PROBE_COLUMNS = 17, MOST_PIXELS = 1 << 30 };

static bool read_probe(struct csv *csv, char *const *field, struct probe *probe) {
  uint64_t x, y, hit;
  double *const number[] = {&probe->p.x,          &probe->p.y,          &probe->p.z,
                            &probe->n.x,          &probe->n.y,          &probe->n.z,
                            &probe->scale_rgb[0], &probe->scale_rgb[1], &probe->scale_rgb[2],
                            &probe->emitted,      &probe->reference,    &probe->reference_se};
  if (!csv_whole(csv, field[0], 0, MOST_PIXELS, &x) ||
      !csv_whole(csv, field[1], 0, MOST_PIXELS, &y) || !csv_whole(csv, field[2], 0, 7, &hit) ||
      !csv_numbers(csv, field + 3, sizeof number / sizeof *number, number))
    return false;
  probe->x = (int)x;
  probe->y = (int)y;
  probe->hit = hit & 1;
  probe->volume = hit & 2;
  probe->ends = hit & 4;
  probe->scale = luminance(probe->scale_rgb, 3);
  return true;
}

static bool read_probe_row(struct csv *csv, struct arena *arena, struct results *results) {
  char *field[PROBE_COLUMNS];
  uint64_t cell, probe;
  if (!csv_row(csv, PROBE_COLUMNS, field) ||
      !csv_whole(csv, field[0], 0, (uint64_t)results->experiment.n_cells - 1, &cell) ||
      !csv_whole(csv, field[1], 0, MOST_PIXELS, &probe))
    return false;
  int have = results->n_probes[cell]++;
  if (probe != (uint64_t)have) return csv_bad(csv, "a row is out of order");
  results->probe[cell] = arena_grow(arena, results->probe[cell], have, have + 1,
                                    sizeof(struct probe), alignof(struct probe));
  return read_probe(csv, field + 2, &results->probe[cell][probe]);
}

static bool read_probes(const char *path, uint64_t sum, struct arena *arena,
                        struct results *results, struct problem *problem) {
  struct csv csv;
  if (!csv_open(&csv, path, probes_header, arena, problem)) return false;
  int n_cells = results->experiment.n_cells;
  results->probe = arena_new(arena, struct probe *, n_cells);
  results->n_probes = arena_new(arena, int, n_cells);
  while (*csv.at)
    if (!read_probe_row(&csv, arena, results)) return false;
  return csv_close(&csv, sum);
}

// ---- log.csv ----

enum { LOG_COLUMNS = 15, LOG_CELL = 0, LOG_PROBE = 2, LOG_SERIES = 7, LOG_I = 8, LOG_N = 10 };

// Series of cells before `cell`.
static int series_before(const struct results *results, int cell) {
  int n = 0;
  for (int c = 0; c < cell; c++) n += results->n_probes[c];
  return n;
}

static void series_reserve(struct results *results, struct arena *arena) {
  results->n_series = series_before(results, results->experiment.n_cells);
  results->series = arena_new(arena, struct series, results->n_series);
  struct series *series = results->series;
  for (int c = 0; c < results->experiment.n_cells; c++)
    for (int p = 0; p < results->n_probes[c]; p++, series++) {
      uint64_t n = results->experiment.cell[c].iterations;
      *series = (struct series){.cell = c, .probe = p, .n_iterations = n};
      series->iteration = arena_new(arena, struct moments, (ptrdiff_t)n);
      series->checkpoint = arena_new(arena, uint64_t, (ptrdiff_t)n);
      series->average = arena_new(arena, struct moments, (ptrdiff_t)n);
      if (results->experiment.cell[c].integrator->local)
        series->radius2 = arena_new(arena, struct moments, (ptrdiff_t)n);
      if (cell_has_companion(&results->experiment.cell[c]))
        series->richardson = arena_new(arena, struct moments, (ptrdiff_t)n);
    }
}

// Into the list of moments by iteration.
static bool keep_iteration(struct csv *csv, struct moments *list, uint64_t i, struct moments m) {
  if (list[i - 1].n > 0) return csv_bad(csv, "an iteration stands twice");
  list[i - 1] = m;
  return true;
}

static bool keep_average(struct csv *csv, struct series *series, uint64_t i, struct moments m) {
  int n = series->n_checkpoints;
  if (n > 0 && i <= series->checkpoint[n - 1]) return csv_bad(csv, "averages do not ascend");
  series->checkpoint[n] = i;
  series->average[n] = m;
  series->n_checkpoints++;
  return true;
}

static bool keep_moments(struct csv *csv, struct series *series, const char *name, uint64_t i,
                         struct moments m) {
  if (strcmp(name, "iteration") == 0) return keep_iteration(csv, series->iteration, i, m);
  if (strcmp(name, "average") == 0) return keep_average(csv, series, i, m);
  if (series->radius2 && strcmp(name, "squared-radius") == 0)
    return keep_iteration(csv, series->radius2, i, m);
  if (series->richardson && strcmp(name, "richardson") == 0)
    return keep_iteration(csv, series->richardson, i, m);
  return csv_bad(csv, "a row of an unknown series");
}

static bool read_log_row(struct csv *csv, struct results *results) {
  char *field[LOG_COLUMNS];
  uint64_t cell, probe, i;
  if (!csv_row(csv, LOG_COLUMNS, field) ||
      !csv_whole(csv, field[LOG_CELL], 0, (uint64_t)results->experiment.n_cells - 1, &cell))
    return false;
  if (results->n_probes[cell] == 0) return csv_bad(csv, "a row of a cell without probes");
  if (!csv_whole(csv, field[LOG_PROBE], 0, (uint64_t)results->n_probes[cell] - 1, &probe))
    return false;
  struct series *series = &results->series[series_before(results, (int)cell) + (int)probe];
  struct moments m;
  if (!csv_whole(csv, field[LOG_I], 1, series->n_iterations, &i) ||
      !csv_numbers(csv, field + LOG_N, 5, (double *[]){&m.n, &m.mean, &m.m2, &m.m3, &m.m4}))
    return false;
  if (m.n != (double)results->experiment.cell[cell].runs)
    return csv_bad(csv, "a row of another number of runs");
  return keep_moments(csv, series, field[LOG_SERIES], i, m);
}

static bool series_is_complete(const struct series *series) {
  for (uint64_t i = 0; i < series->n_iterations; i++)
    if (series->iteration[i].n == 0 || (series->radius2 && series->radius2[i].n == 0) ||
        (series->richardson && series->richardson[i].n == 0))
      return false;
  int n = series->n_checkpoints;
  return n > 0 && series->checkpoint[n - 1] == series->n_iterations;
}

static bool read_log(const char *path, uint64_t sum, struct arena *arena, struct results *results,
                     struct problem *problem) {
  struct csv csv;
  assert(n_log_columns == LOG_COLUMNS);
  if (!csv_open(&csv, path, log_header(arena), arena, problem)) return false;
  series_reserve(results, arena);
  while (*csv.at)
    if (!read_log_row(&csv, results)) return false;
  for (int k = 0; k < results->n_series; k++)
    if (!series_is_complete(&results->series[k])) return csv_bad(&csv, "an iteration is missing");
  return csv_close(&csv, sum);
}

// ---- manifest.json ----

struct manifest {
  const char *name, *quality;
  int n_cells;
  uint64_t *scene_hash, *seed;            // by cell; the command line may have set the seed
  uint64_t *runs;                         // by cell: those made
  int *looks;                             // by cell
  uint64_t log_sum, probes_sum, runs_sum; // runs_sum: where runs are kept
  uint64_t experiment_sum;
};

static bool read_hex(json_t *object, const char *key, uint64_t *value) {
  const char *text = json_string_value(json_object_get(object, key));
  if (text) *value = strtoull(text, NULL, 16);
  return text != NULL;
}

static bool take_manifest(json_t *root, struct arena *arena, struct manifest *manifest) {
  const char *quality = json_string_value(json_object_get(root, "quality"));
  const char *name = json_string_value(json_object_get(root, "experiment"));
  json_t *cells = json_object_get(root, "cells");
  if (!quality || !name || !json_is_array(cells)) return false;
  int n = (int)json_array_size(cells);
  *manifest = (struct manifest){
      .name = arena_string(arena, name, (ptrdiff_t)strlen(name)),
      .quality = arena_string(arena, quality, (ptrdiff_t)strlen(quality)),
      .n_cells = n,
      .scene_hash = arena_new(arena, uint64_t, n),
      .seed = arena_new(arena, uint64_t, n),
      .runs = arena_new(arena, uint64_t, n),
      .looks = arena_new(arena, int, n),
  };
  for (int c = 0; c < n; c++) {
    json_t *cell = json_array_get(cells, (size_t)c);
    if (!read_hex(cell, "scene_hash", &manifest->scene_hash[c]) ||
        !read_hex(cell, "seed", &manifest->seed[c]))
      return false;
    json_t *runs = json_object_get(cell, "runs"), *looks = json_object_get(cell, "looks");
    if (json_integer_value(runs) < 1 || json_integer_value(looks) < 1) return false;
    manifest->runs[c] = (uint64_t)json_integer_value(runs);
    manifest->looks[c] = (int)json_integer_value(looks);
  }
  read_hex(root, "runs_hash", &manifest->runs_sum);
  return read_hex(root, "experiment_hash", &manifest->experiment_sum) &&
         read_hex(root, "log_hash", &manifest->log_sum) &&
         read_hex(root, "probes_hash", &manifest->probes_sum);
}

static bool read_manifest(const char *directory, struct arena *arena, struct manifest *manifest,
                          struct problem *problem) {
  char *path = arena_format(arena, "%s/manifest.json", directory);
  json_error_t error;
  if (!file_exists(path))
    return problem_set(problem, "%s: no manifest.json, so not finished results of photonlab run",
                       directory);
  json_t *root = json_load_file(path, 0, &error);
  if (!root) {
    struct place place = {path, error.line, error.column};
    return problem_at(problem, place, "%s", error.text);
  }
  bool ok = take_manifest(root, arena, manifest);
  json_decref(root);
  return ok || problem_set(problem, "%s: not a manifest of this version of photonlab run", path);
}

static bool read_experiment(const char *directory, const struct manifest *manifest,
                            struct arena *arena, struct experiment *experiment,
                            struct problem *problem) {
  const char *path = arena_format(arena, "%s/%s.yaml", directory, manifest->name);
  if (!experiment_read(path, manifest->quality, arena, experiment, problem)) return false;
  if (XXH64(experiment->text.data, (size_t)experiment->text.length, 0) !=
          manifest->experiment_sum ||
      experiment->n_cells != manifest->n_cells)
    return problem_set(problem, "%s: was changed after the run, run the experiment again", path);
  for (int c = 0; c < experiment->n_cells; c++) {
    experiment->cell[c].seed = manifest->seed[c];
    experiment->cell[c].runs = manifest->runs[c];
  }
  return true;
}

bool results_read(const char *directory, struct arena *arena, struct results *results,
                  struct problem *problem) {
  *results = (struct results){.directory = directory};
  struct manifest manifest = {0};
  if (!read_manifest(directory, arena, &manifest, problem) ||
      !read_experiment(directory, &manifest, arena, &results->experiment, problem))
    return false;
  results->scene_hash = manifest.scene_hash;
  results->looks = manifest.looks;
  return read_probes(arena_format(arena, "%s/probes.csv", directory), manifest.probes_sum, arena,
                     results, problem) &&
         read_log(arena_format(arena, "%s/log.csv", directory), manifest.log_sum, arena, results,
                  problem) &&
         (!runs_are_kept(&results->experiment) ||
          runs_read(arena_format(arena, "%s/runs.csv", directory), manifest.runs_sum, arena,
                    results, problem));
}

bool results_name(const char *directory, struct arena *arena, const char **name,
                  struct problem *problem) {
  struct manifest manifest = {0};
  bool ok = read_manifest(directory, arena, &manifest, problem);
  *name = manifest.name;
  return ok;
}
