// bench [--csv FILE] [--perf DIR] [--folder DIR] [--repetitions N] [PART[/ROW]]
#include "base/problem.h"
#include "tests/bench/report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

enum { MOST_ROWS = 256 };

static bool begins(const char *text, const char *with) {
  return strncmp(text, with, strlen(with)) == 0;
}

bool bench_wants(const struct bench *bench, const char *part, const char *name) {
  char full[128];
  snprintf(full, sizeof full, "%s/%s", part, name ? name : "");
  return begins(full, bench->filter) || begins(bench->filter, full);
}

void bench_add(struct bench *bench, const char *part, struct row row) {
  char full[128];
  snprintf(full, sizeof full, "%s/%s", part, row.name);
  if (!begins(full, bench->filter)) return;
  if (bench->n_rows == MOST_ROWS) die("bench: more than %d rows in %s", MOST_ROWS, part);
  bench->row[bench->n_rows++] = row;
}

void bench_check(bool same, const char *what, const char *name) {
  if (!same) die("bench: %s: %s; so nothing is timed", name, what);
}

uint64_t bench_hash(const void *bytes, size_t n) { return XXH64(bytes, n, 0); }

// ---- one part ----
// Once untimed; returns the hash every repetition must leave.
static uint64_t warm_up(const struct row *row) {
  if (row->kind == COUNT) return 0;
  clock_pin(row->threads <= 1);
  row->body(row->data, -1);
  return row->hash ? row->hash(row->data) : 0;
}

static void repeat(const struct row *row, int k, uint64_t hash, struct repetition *out) {
  if (row->kind == COUNT) return;
  clock_pin(row->threads <= 1);
  double before = clock_calibrate();
  struct seconds begin = clock_now();
  row->body(row->data, k);
  struct seconds time = clock_since(begin);
  *out = (struct repetition){time, 0.5 * (before + clock_calibrate())};
  bench_check(!row->hash || row->hash(row->data) == hash, "repetitions differ", row->name);
}

static int row_named(const struct bench *bench, const char *name) {
  for (int r = 0; name && r < bench->n_rows; r++)
    if (strcmp(bench->row[r].name, name) == 0) return r;
  return -1;
}

static void report(const struct bench *bench, const struct part_type *part,
                   struct repetition (*done)[MOST_REPETITIONS], int n, FILE *csv) {
  static struct figure figure[MOST_ROWS];
  if (bench->row[0].pair)
    report_pairs_header(part);
  else
    report_table_header(part);
  for (int r = 0; r < bench->n_rows; r++) {
    const struct row *row = &bench->row[r];
    int b = row_named(bench, row->base);
    figure[r] = figure_of(row, done[r], n, b < 0 ? NULL : &bench->row[b], b < 0 ? NULL : done[b]);
    if (!row->pair)
      report_table(row, &figure[r]);
    else if (b >= 0)
      report_pair(row, &figure[r], &figure[b]);
    if (csv) report_csv(csv, part->name, row, &figure[r]);
  }
}

// False: none of its rows was asked for, or its scenes are not there.
static bool run(struct bench *bench, const struct part_type *part, FILE *csv) {
  static struct repetition done[MOST_ROWS][MOST_REPETITIONS];
  uint64_t hash[MOST_ROWS];
  if (!bench_wants(bench, part->name, NULL)) return false;
  int n = bench->repetitions ? bench->repetitions : part->repetitions;
  clock_pin(false);
  bench->n_rows = 0;
  part->rows(bench);
  if (bench->n_rows == 0) return false;
  for (int r = 0; r < bench->n_rows; r++) hash[r] = warm_up(&bench->row[r]);
  for (int k = 0; k < n; k++)
    for (int r = 0; r < bench->n_rows; r++) repeat(&bench->row[r], k, hash[r], &done[r][k]);
  report(bench, part, done, n, csv);
  return true;
}

static const char *option(int *argc, char ***argv) {
  if (*argc < 2) die("bench: %s: a value is missing", (*argv)[0]);
  (*argc)--, (*argv)++;
  return (*argv)[0];
}

static void options(struct bench *bench, const char **csv, int argc, char **argv) {
  for (argc--, argv++; argc > 0; argc--, argv++) {
    if (!strcmp(*argv, "--csv"))
      *csv = option(&argc, &argv);
    else if (!strcmp(*argv, "--perf"))
      bench->perf = option(&argc, &argv);
    else if (!strcmp(*argv, "--folder"))
      bench->folder = option(&argc, &argv);
    else if (!strcmp(*argv, "--repetitions"))
      bench->repetitions = atoi(option(&argc, &argv));
    else
      bench->filter = *argv;
  }
  if (bench->repetitions < 0 || bench->repetitions > MOST_REPETITIONS)
    die("bench: 1 to %d repetitions", MOST_REPETITIONS);
}

static void begin_report(FILE *out, const char *prefix) {
  report_machine(out, prefix);
  report_load(out, prefix, "before");
}

int main(int argc, char **argv) {
  static struct row row[MOST_ROWS];
  struct arena arena = arena_reserve();
  struct bench bench = {
      .filter = "", .perf = "", .folder = "build/bench", .arena = &arena, .row = row};
  const char *path = NULL;
  int ran = 0;
  options(&bench, &path, argc, argv);
  FILE *csv = path ? fopen(path, "w") : NULL;
  if (path && !csv) die("bench: cannot write %s", path);
  begin_report(stdout, "");
  if (csv) begin_report(csv, "# "), report_csv_header(csv);
  for (int p = 0; part_types[p]; p++) ran += run(&bench, part_types[p], csv);
  if (ran == 0) die("bench: no row begins with '%s' (or its scenes are not there)", bench.filter);
  printf("\n");
  report_load(stdout, "", "after");
  return csv && fclose(csv) != 0;
}
