// photonlab efficiency: errors of images against the CPU time they took, of methods that were run
// with several seeds: who is ahead when, and what a CPU second buys.
#include "app/cli.h"
#include "app/race.h"
#include "base/file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

// ---- files ----
// errors.csv and references.csv are the same bits everywhere, the others hold times.

static void write_errors(FILE *out, const struct race *race) {
  fputs("scene,method,cell,N,relmse\n", out);
  for (int f = 0; f < race->n_fields; f++)
    for (int m = 0; m < race->field[f].n_methods; m++) {
      const struct method *method = &race->field[f].method[m];
      for (int k = 0; k < method->n_runs; k++)
        for (int j = 0; j < method->n_points; j++)
          fprintf(out, "%s,%s,%d,%" PRIu64 ",%.17g\n", race->field[f].scene, method->name,
                  method->cell[k]->number, method->cell[k]->image[j],
                  method->error[k * method->n_points + j]);
    }
}

static void write_references(FILE *out, const struct race *race) {
  fputs("scene,integrator,runs,noise,bias\n", out);
  for (int f = 0; f < race->n_fields; f++) {
    const struct field *field = &race->field[f];
    fprintf(out, "%s,%s,%" PRIu64 ",%.17g,%.17g\n", field->scene, field->truth->integrator->name,
            field->truth->runs, field->reference.noise, field->reference.bias);
  }
}

static void write_curves(FILE *out, const struct race *race) {
  fputs("scene,method,N,cpu_s,relmse,se,counts\n", out);
  for (int f = 0; f < race->n_fields; f++)
    for (int m = 0; m < race->field[f].n_methods; m++) {
      const struct method *method = &race->field[f].method[m];
      for (int j = 0; j < method->n_points; j++) {
        struct pace_error at = method_point(method, j);
        fprintf(out, "%s,%s,%" PRIu64 ",%.9g,%.9g,%.9g,%d\n", race->field[f].scene, method->name,
                method->cell[0]->image[j], method_time(method, j), at.mean, at.se,
                j < method->n_counted);
      }
    }
}

static void write_efficiency(FILE *out, const struct race *race) {
  fputs("scene,method,cpu_s,relmse,se,efficiency,efficiency_se\n", out);
  for (int f = 0; f < race->n_fields; f++) {
    const struct field *field = &race->field[f];
    for (int m = 0; m < field->n_methods; m++) {
      if (isnan(field->last_s) || !field->method[m].n_counted) continue;
      struct pace_error at = pace_at(&field->method[m].pace, field->last_s);
      double efficiency = 1 / (at.mean * field->last_s);
      fprintf(out, "%s,%s,%.9g,%.9g,%.9g,%.9g,%.9g\n", field->scene, field->method[m].name,
              field->last_s, at.mean, at.se, efficiency, efficiency * at.se / at.mean);
    }
  }
}

static const char *ahead_name(const struct method *a, const struct method *b, int ahead) {
  return ahead ? b->name : a->name;
}

static void write_leads(FILE *out, const struct race *race) {
  fputs("scene,one,other,ahead,from_s,to_s,crossed_s,crossed_relmse\n", out);
  for (int f = 0; f < race->n_fields; f++) {
    const struct field *field = &race->field[f];
    for (int i = 0; i < field->n_methods; i++)
      for (int j = i + 1; j < field->n_methods; j++) {
        const struct method *a = &field->method[i], *b = &field->method[j];
        struct pace_lead lead[PACE_LEADS];
        int n = pace_leads(&a->pace, &b->pace, lead);
        for (int k = 0; k < n; k++)
          fprintf(out, "%s,%s,%s,%s,%.9g,%.9g,%.9g,%.9g\n", field->scene, a->name, b->name,
                  ahead_name(a, b, lead[k].ahead), lead[k].from_s, lead[k].to_s, lead[k].crossed_s,
                  k ? pace_at(&a->pace, lead[k].crossed_s).mean : NAN);
        if (!n) fprintf(out, "%s,%s,%s,neither,nan,nan,nan,nan\n", field->scene, a->name, b->name);
      }
  }
}

static const struct {
  const char *name;
  void (*write)(FILE *, const struct race *);
} files[] = {{"errors.csv", write_errors},
             {"references.csv", write_references},
             {"curves-time.csv", write_curves},
             {"efficiency.csv", write_efficiency},
             {"leads.csv", write_leads}};

static bool write_files(const struct race *race, struct arena scratch, struct problem *problem) {
  for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
    struct file_out out;
    char *path = arena_format(&scratch, "%s/%s", race->results->directory, files[k].name);
    if (!file_begin(&out, path, problem)) return false;
    files[k].write(out.stream, race);
    if (!file_commit(&out, problem)) return false;
  }
  return true;
}

// ---- the table ----

static void print_methods(const struct field *field) {
  printf("  %-32s %9s %8s  %-20s", "method", "N", "CPU s", "relmse");
  if (isnan(field->last_s))
    printf("  (no time that all have reached)\n");
  else
    printf("  1/(relmse s) at %.3g s\n", field->last_s);
  for (int m = 0; m < field->n_methods; m++) {
    const struct method *method = &field->method[m];
    int last = method->n_counted ? method->n_counted - 1 : 0;
    struct pace_error at = method_point(method, last);
    char error[64];
    snprintf(error, sizeof error, "%.3g +- %.1g", at.mean, at.se);
    printf("  %-32s %9" PRIu64 " %8.3g  %-20s", method->name, method->cell[0]->image[last],
           method_time(method, last), error);
    if (!isnan(field->last_s) && method->n_counted) {
      struct pace_error then = pace_at(&method->pace, field->last_s);
      double efficiency = 1 / (then.mean * field->last_s);
      printf("  %.3g +- %.1g", efficiency, efficiency * then.se / then.mean);
    }
    if (!method->n_counted)
      printf("  not above the reference's error");
    else if (method->n_counted < method->n_points)
      printf("  (curve ends: reference)");
    putchar('\n');
  }
}

// Returns how many leads there are.
static int print_crossovers(const struct method *a, const struct method *b) {
  struct pace_lead lead[PACE_LEADS];
  int n = pace_leads(&a->pace, &b->pace, lead);
  for (int k = 1; k < n; k++)
    printf("  %s passes %s at %.3g s, between %.3g and %.3g\n", ahead_name(a, b, lead[k].ahead),
           ahead_name(a, b, !lead[k].ahead), lead[k].crossed_s, lead[k - 1].to_s, lead[k].from_s);
  return n;
}

static void print_reference(const struct field *field) {
  const struct reference_image *reference = &field->reference;
  printf("%s: reference by %s, %" PRIu64 " runs, its own relmse %.2g of noise", field->scene,
         field->truth->integrator->name, field->truth->runs, reference->noise);
  if (reference->bias > 0) printf(", at most %.2g of bias", reference->bias);
  putchar('\n');
  for (int m = 0; m < field->n_methods && field->truth->integrator->photons; m++) {
    const struct method *method = &field->method[m];
    struct pace_error off = method_mean(field, method);
    if (!method->cell[0]->integrator->photons)
      printf("  mean of the picture by %s, less the reference's: %+.2g +- %.1g %%\n", method->name,
             100 * off.mean, 100 * off.se);
  }
}

static void print_field(const struct field *field) {
  int one_lead = 0, none = 0;
  print_reference(field);
  print_methods(field);
  for (int i = 0; i < field->n_methods; i++)
    for (int j = i + 1; j < field->n_methods; j++) {
      int n = print_crossovers(&field->method[i], &field->method[j]);
      one_lead += n == 1;
      none += n == 0;
    }
  printf("  of the other pairs %d do not change places within the range, %d cannot be told apart "
         "(leads.csv)\n\n",
         one_lead, none);
}

static int efficiency(struct cli *cli, struct problem *problem) {
  struct results results;
  struct race race;
  if (!results_read(cli->argument, cli->arena, &results, problem) ||
      !race_read(&results, cli->arena, &race, problem) || !write_files(&race, *cli->arena, problem))
    return 1;
  for (int f = 0; f < race.n_fields; f++) print_field(&race.field[f]);
  printf("relmse: mean of (x - r)^2 / (r^2 + 0.01) over pixels and channels, +- over runs of other "
         "seeds.\nEnds of intervals: from where on a lead is significant (t-test at each time, 5 "
         "%%).\nA curve ends where its error is below %d times the reference's. Few samples of an "
         "unbiased method may\nmiss what they rarely find: a low mean with a small +-.\n",
         REFERENCE_MARGIN);
  return 0;
}

const struct command command_efficiency = {
    "efficiency", "DIR", "errors against CPU time: who is ahead when, and what a second buys", "",
    efficiency};
