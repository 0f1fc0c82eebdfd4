#include "log/runs.h"

#include "log/csv.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const char header[] = "cell,probe,series,i,run,value";
enum { COLUMNS = 6 };

bool runs_are_kept(const struct experiment *experiment) {
  for (int c = 0; c < experiment->n_cells; c++)
    if (experiment->cell[c].keeps_runs) return true;
  return false;
}

void runs_write_header(FILE *out) { fprintf(out, "%s\n", header); }

void runs_write(FILE *out, const struct series *series, const char *name, uint64_t run,
                const double *value) {
  for (int c = 0; c < series->n_checkpoints; c++)
    fprintf(out, "%d,%d,%s,%" PRIu64 ",%" PRIu64 ",%.17g\n", series->cell, series->probe, name,
            series->checkpoint[c], run, value[c]);
}

static double *reserve(const struct series *series, uint64_t runs, struct arena *arena) {
  ptrdiff_t n = (ptrdiff_t)runs * series->n_checkpoints;
  double *value = arena_new(arena, double, n);
  for (ptrdiff_t k = 0; k < n; k++) value[k] = NAN;
  return value;
}

static void reserve_all(struct results *results, struct arena *arena) {
  for (int s = 0; s < results->n_series; s++) {
    struct series *series = &results->series[s];
    const struct cell *cell = &results->experiment.cell[series->cell];
    if (!cell->keeps_runs) continue;
    series->run_average = reserve(series, cell->runs, arena);
    if (series->richardson) series->run_richardson = reserve(series, cell->runs, arena);
  }
}

static struct series *find_series(const struct results *results, uint64_t cell, uint64_t probe) {
  for (int s = 0; s < results->n_series; s++)
    if ((uint64_t)results->series[s].cell == cell && (uint64_t)results->series[s].probe == probe)
      return &results->series[s];
  return NULL;
}

static int find_checkpoint(const struct series *series, uint64_t i) {
  int c = 0;
  while (c < series->n_checkpoints && series->checkpoint[c] != i) c++;
  return c;
}

static bool read_row(struct csv *csv, struct results *results) {
  char *field[COLUMNS];
  uint64_t cell, probe, i, run, most = UINT64_C(1) << 52;
  double value;
  if (!csv_row(csv, COLUMNS, field) || !csv_whole(csv, field[0], 0, most, &cell) ||
      !csv_whole(csv, field[1], 0, most, &probe) || !csv_whole(csv, field[3], 1, most, &i))
    return false;
  struct series *series = find_series(results, cell, probe);
  if (!series || !series->run_average) return csv_bad(csv, "a row of runs that were not kept");
  uint64_t runs = results->experiment.cell[cell].runs;
  int c = find_checkpoint(series, i);
  if (c == series->n_checkpoints) return csv_bad(csv, "no average is kept there");
  if (!csv_whole(csv, field[4], 1, runs, &run) ||
      !csv_numbers(csv, field + 5, 1, (double *[]){&value}))
    return false;
  double *list = strcmp(field[2], "average") == 0      ? series->run_average
                 : strcmp(field[2], "richardson") == 0 ? series->run_richardson
                                                       : NULL;
  if (!list) return csv_bad(csv, "a row of an unknown series");
  double *at = &list[(uint64_t)c * runs + run - 1];
  if (!isfinite(value) || !isnan(*at)) return csv_bad(csv, "a value stands twice or is none");
  *at = value;
  return true;
}

static bool all_there(const struct results *results, const struct series *series,
                      const double *value) {
  uint64_t runs = results->experiment.cell[series->cell].runs;
  for (uint64_t k = 0; value && k < runs * (uint64_t)series->n_checkpoints; k++)
    if (isnan(value[k])) return false;
  return true;
}

bool runs_read(const char *path, uint64_t sum, struct arena *arena, struct results *results,
               struct problem *problem) {
  struct csv csv;
  if (!csv_open(&csv, path, header, arena, problem)) return false;
  reserve_all(results, arena);
  while (*csv.at)
    if (!read_row(&csv, results)) return false;
  for (int s = 0; s < results->n_series; s++)
    if (!all_there(results, &results->series[s], results->series[s].run_average) ||
        !all_there(results, &results->series[s], results->series[s].run_richardson))
      return csv_bad(&csv, "a run is missing");
  return csv_close(&csv, sum);
}
