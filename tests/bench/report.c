#include "tests/bench/report.h"

#include "base/simd.h"
#include "base/version.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static void processor(char *name, size_t size) {
  char line[512];
  snprintf(name, size, "unknown");
  FILE *file = fopen("/proc/cpuinfo", "r");
  while (file && fgets(line, sizeof line, file)) {
    char *value = strstr(line, ": ");
    if (strncmp(line, "model name", 10) != 0 || !value) continue;
    value[strcspn(value, "\n")] = 0;
    snprintf(name, size, "%s", value + 2);
    break;
  }
  if (file) fclose(file);
}

static double fastest_calibration(void) {
  double least = INFINITY;
  for (int k = 0; k < 20; k++) {
    double t = clock_calibrate();
    least = t < least ? t : least;
  }
  return least;
}

void report_machine(FILE *out, const char *prefix) {
  char name[256], date[32];
  time_t now = time(NULL);
  processor(name, sizeof name);
  strftime(date, sizeof date, "%Y-%m-%d", gmtime(&now));
  fprintf(out, "%sprocessor: %s, %ld cores\n", prefix, name, sysconf(_SC_NPROCESSORS_ONLN));
  fprintf(out, "%scompiler: %s\n", prefix, photonlab_compiler);
  fprintf(out, "%sflags: %s\n", prefix, photonlab_flags);
  fprintf(out, "%sSIMD level: %s\n", prefix, simd_names[simd_chosen()]);
  fprintf(out, "%sprogram: %s, %s\n", prefix, photonlab_version, date);
  fprintf(out, "%scalibration: %.2f ms, the unit of time of `calibrated`\n", prefix,
          1e3 * fastest_calibration());
}

void report_load(FILE *out, const char *prefix, const char *when) {
  char load[64] = "unknown";
  FILE *file = fopen("/proc/loadavg", "r");
  if (file && !fgets(load, sizeof load, file)) strcpy(load, "unknown");
  if (file) fclose(file);
  char *third = strchr(load, ' ');
  if (third && (third = strchr(third + 1, ' ')) && (third = strchr(third + 1, ' '))) *third = 0;
  fprintf(out, "%sload %s (1, 5, 15 minutes): %s\n", prefix, when, load);
}

void report_csv_header(FILE *out) {
  fprintf(out, "part,row,kind,unit,value,low,high,relative,repetitions,cpu_s,wall_s,base,ratio\n");
}

static const char *const kind_name[] = {[RATE] = "rate", [COST] = "cost", [COUNT] = "count"};

void report_csv(FILE *out, const char *part, const struct row *row, const struct figure *f) {
  fprintf(out, "%s,%s,%s,%s,%.6g,%.6g,%.6g,%.6g,%d,%.4f,%.4f,", part, row->name,
          kind_name[row->kind], row->unit, f->value, f->low, f->high, f->relative, f->repetitions,
          f->time.cpu, f->time.wall);
  if (isnan(f->ratio))
    fprintf(out, ",\n");
  else
    fprintf(out, "%s,%.4f\n", row->base, f->ratio);
}

void report_table_header(const struct part_type *part) {
  printf("\n%s: %s\n  %-46s %10s %21s %-12s %10s  %s\n", part->name, part->about, "", "value",
         "quartiles", "unit", "calibrated", "ratio");
}

void report_table(const struct row *row, const struct figure *f) {
  char spread[48] = "", calibrated[24] = "", ratio[96] = "";
  if (row->kind != COUNT) {
    snprintf(spread, sizeof spread, "%.4g .. %.4g", f->low, f->high);
    snprintf(calibrated, sizeof calibrated, "%.4g", f->relative);
  }
  if (!isnan(f->ratio)) snprintf(ratio, sizeof ratio, "%.2f of %s", f->ratio, row->base);
  printf("  %-46s %10.*g %21s %-12s %10s  %s\n", row->name, row->kind == COUNT ? 6 : 4, f->value,
         spread, row->unit, calibrated, ratio);
  fflush(stdout);
}

void report_pairs_header(const struct part_type *part) {
  printf("\n%s: %s\n  %-42s %12s %12s  %s\n", part->name, part->about, "", "skipped, s", "not, s",
         "ratio, quartiles");
}

void report_pair(const struct row *row, const struct figure *f, const struct figure *base) {
  printf("  %-42s %12.4g %12.4g  %.2f, %.2f .. %.2f\n", row->base, base->value, f->value, f->ratio,
         f->ratio_low, f->ratio_high);
  fflush(stdout);
}
