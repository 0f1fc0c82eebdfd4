#include "analysis/fit_radii.h"

#include "analysis/expected_radius.h"
#include "analysis/fit_rows.h"
#include "analysis/special.h"
#include "base/file.h"
#include "experiment/cell_keys.h"

#include <math.h>
#include <string.h>

static const double family_wise_level = 0.01;

// E and deviation of r_i^2; what rounding leaves of a deviation of zero may be negative.
static void expect(const struct scene *scene, struct radius_row *row, struct arena *arena) {
  uint64_t n = row->series->n_iterations;
  double r1 = sqrt(row->series->radius2[0].mean);
  double *mean = arena_new(arena, double, (ptrdiff_t)n);
  double *spread = arena_new(arena, double, (ptrdiff_t)n);
  row->first_disc = expected_first_disc(scene, row->cell, row->probe, r1, *arena);
  if (!expected_radius(scene, row->cell, row->probe, r1, 1, n, mean, *arena)) return;
  expected_radius(scene, row->cell, row->probe, r1, 2, n, spread, *arena);
  for (uint64_t j = 0; j < n; j++) {
    double variance = spread[j] - mean[j] * mean[j];
    spread[j] = variance > 0 ? sqrt(variance) : 0;
  }
  row->expected = mean, row->spread = spread;
}

static void test(struct radius_row *row) {
  uint64_t n = row->series->n_iterations;
  struct moments last = row->series->radius2[n - 1];
  double r1_2 = row->series->radius2[0].mean;
  row->mean = last.mean / r1_2;
  row->p = NAN;
  if (!row->expected || !(row->spread[n - 1] > 0)) return;
  row->se = row->spread[n - 1] / sqrt(last.n);
  row->p = special_two_sided((row->mean - row->expected[n - 1]) / row->se);
}

static void judge(struct fit_radii *fit) {
  int n_tests = 0;
  for (ptrdiff_t k = 0; k < fit->count; k++) n_tests += !isnan(fit->item[k].p);
  fit->test_level = special_sidak(family_wise_level, n_tests);
  for (ptrdiff_t k = 0; k < fit->count; k++) {
    struct radius_row *row = &fit->item[k];
    row->verdict = isnan(row->p)              ? VERDICT_NOT_RESOLVABLE
                   : row->p < fit->test_level ? VERDICT_DISAGREE
                                              : VERDICT_AGREE;
  }
}

bool fit_radii(const struct results *results, struct arena *arena, struct fit_radii *fit,
               struct problem *problem) {
  *fit = (struct fit_radii){0};
  const char *path = NULL;
  struct scene scene;
  for (int s = 0; s < results->n_series; s++) {
    const struct series *series = &results->series[s];
    const struct cell *cell = &results->experiment.cell[series->cell];
    if (!series->radius2 || !(series->radius2[0].mean > 0)) continue;
    if (!path || strcmp(path, cell->scene_path) != 0)
      if (!scene_read(cell->scene_path, arena, &scene, problem)) return false;
    path = cell->scene_path;
    struct radius_row *row = arena_push(arena, fit);
    *row = (struct radius_row){.cell = cell,
                               .probe = &results->probe[series->cell][series->probe],
                               .series = series,
                               .rho = arena_new(arena, double, (ptrdiff_t)series->n_iterations)};
    for (uint64_t i = 1; i <= series->n_iterations; i++)
      row->rho[i - 1] = cell->law->rho(cell->alpha, i);
    expect(&scene, row, arena);
    test(row);
  }
  judge(fit);
  return true;
}

static void print_number(FILE *stream, double x) {
  isfinite(x) ? fprintf(stream, ",%.9g", x) : fputs(",nan", stream);
}

static void write_one(const struct radius_row *row, FILE *stream) {
  const struct series *series = row->series;
  double r1_2 = series->radius2[0].mean;
  for (int c = 0; c < series->n_checkpoints; c++) {
    uint64_t i = series->checkpoint[c];
    struct moments m = series->radius2[i - 1];
    fit_print_keys(stream, row->cell);
    fprintf(stream, "%d,%d", row->probe->x, row->probe->y);
    print_number(stream, row->first_disc);
    fprintf(stream, ",%llu,%.0f", (unsigned long long)i, m.n);
    print_number(stream, m.mean / r1_2);
    print_number(stream, sqrt(moments_variance(m)) / r1_2);
    print_number(stream, row->rho[i - 1]);
    print_number(stream, row->expected ? row->expected[i - 1] : NAN);
    print_number(stream, row->spread ? row->spread[i - 1] : NAN);
    fputc('\n', stream);
  }
}

bool fit_radii_write(const struct fit_radii *fit, const char *path, struct problem *problem) {
  struct file_out out;
  if (!file_begin(&out, path, problem)) return false;
  for (int k = 0; k < CELL_KEYS; k++) fprintf(out.stream, "%s,", cell_keys[k].name);
  fputs("x,y,first_disc,i,runs,mean,sd,rho,expected,spread\n", out.stream);
  for (ptrdiff_t k = 0; k < fit->count; k++) write_one(&fit->item[k], out.stream);
  return file_commit(&out, problem);
}

// Those that were tested.
void fit_radii_print(const struct fit_radii *fit, FILE *stream) {
  int widest = 5, n_tests = 0;
  for (ptrdiff_t k = 0; k < fit->count; k++) {
    int length = (int)strlen(fit->item[k].cell->scene);
    n_tests += !isnan(fit->item[k].p);
    widest = length > widest ? length : widest;
  }
  if (n_tests == 0) return;
  fprintf(stream,
          "\nr^2 / (r_1^2 rho) of local statistics at the last iteration\n"
          "cell  %-*s  law        alpha   photons in disc 1  expected  measured            "
          "verdict\n",
          widest, "scene");
  for (ptrdiff_t k = 0; k < fit->count; k++) {
    const struct radius_row *row = &fit->item[k];
    uint64_t n = row->series->n_iterations;
    if (isnan(row->p)) continue;
    fprintf(stream, "%4d  %-*s  %-9s  %.4f  %17.4g  %8.4f  %.4f +- %.4f  %s\n", row->cell->number,
            widest, row->cell->scene, row->cell->law->name, row->cell->alpha, row->first_disc,
            row->expected[n - 1] / row->rho[n - 1], row->mean / row->rho[n - 1],
            row->se / row->rho[n - 1], verdict_names[row->verdict]);
  }
  fprintf(stream, "(family-wise level %g, each test at %.2g)\n", family_wise_level,
          fit->test_level);
}
