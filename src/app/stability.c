#include "app/stability.h"

#include <math.h>

static const struct stress *const tables[] = {stress_laws, stress_sums, stress_moments,
                                              stress_places};
enum { N_TABLES = sizeof tables / sizeof tables[0] };

struct outcome {
  double level, error, bound; // where error / bound is largest, without a bound: error
  int measured, refused, failed;
};

static const char *verdict_of(const struct stress *row, double error, double bound, bool refused) {
  if (!row->bound) return "not used";
  return refused ? "refused" : error <= bound ? "ok" : "FAIL";
}

// A NaN, or closer to the bound or further beyond it.
static bool is_worst(const struct outcome *worst, double error, double bound) {
  if (worst->measured == 1 || error != error) return true;
  if (worst->error != worst->error) return false;
  return error * worst->bound > worst->error * bound;
}

static void take(struct outcome *worst, const struct stress *row, double level, double error,
                 double bound) {
  worst->measured++;
  worst->failed += row->bound && !(error <= bound);
  if (is_worst(worst, error, bound))
    worst->level = level, worst->error = error, worst->bound = bound;
}

static struct outcome measure(const struct stress *row, FILE *csv) {
  struct outcome worst = {0};
  for (double level = row->from; level <= row->to * 1.001; level *= row->factor) {
    bool refused = row->refused && row->refused(level);
    double error = refused ? NAN : row->error(row->parameter, level);
    double bound = row->bound ? row->bound(row->parameter, level) : 1;
    worst.refused += refused;
    if (!refused) take(&worst, row, level, error, bound);
    if (csv)
      fprintf(csv, "%s,%s,%.6g,%.3g,%.3g,%s\n", row->family, row->what, level, error,
              row->bound ? bound : NAN, verdict_of(row, error, bound, refused));
  }
  return worst;
}

static void print_row(FILE *out, const struct stress *row, const struct outcome *worst) {
  char what[128], at[64];
  snprintf(what, sizeof what, "%s: %s", row->family, row->what);
  snprintf(at, sizeof at, "%s = %.3g", row->level, worst->level);
  fprintf(out, "%-60s %-24s  %8.1e  ", what, at, worst->error);
  if (row->bound)
    fprintf(out, "%8.1e  %s", worst->bound, worst->failed ? "FAIL" : "ok");
  else
    fprintf(out, "%8s  not used", "-");
  if (worst->refused) fprintf(out, ", beyond it %d refused", worst->refused);
  fputc('\n', out);
}

bool stability_run(FILE *out, FILE *csv) {
  int rows = 0, failures = 0;
  if (csv) fprintf(csv, "family,what,stress,error,bound,verdict\n");
  fprintf(out, "%-60s %-24s  %8s  %8s\n", "error of", "worst at", "is", "at most");
  for (int t = 0; t < N_TABLES; t++)
    for (const struct stress *row = tables[t]; row->family; row++) {
      struct outcome worst = measure(row, csv);
      print_row(out, row, &worst);
      rows += row->bound != NULL;
      failures += worst.failed > 0;
    }
  if (failures == 0)
    fprintf(out, "all %d within their bounds\n", rows);
  else
    fprintf(out, "%d of %d FAIL\n", failures, rows);
  return failures == 0;
}
