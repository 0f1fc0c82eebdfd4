// Ordinary least squares of ln |y| against ln N, over the last two decades of the curves of the
// averages, measured and predicted.
#include "analysis/fit_methods.h"

#include <math.h>

struct line {
  double n, x, y, xx, xy, yy; // sums
};

static void line_add(struct line *line, double x, double y) {
  line->n++, line->x += x, line->y += y;
  line->xx += x * x, line->xy += x * y, line->yy += y * y;
}

static double line_slope(const struct line *line, double *se) {
  double n = line->n, xx = line->xx - line->x * line->x / n;
  double xy = line->xy - line->x * line->y / n, yy = line->yy - line->y * line->y / n;
  double left = yy - xy * xy / xx; // below zero by rounding only
  *se = n > 2 ? sqrt((left > 0 ? left : 0) / (n - 2) / xx) : NAN;
  return n > 1 ? xy / xx : NAN;
}

static bool drawn(const struct fit_point *point, const struct fit_row *row, uint64_t last) {
  return point->row == row && point->series == CURVE_AVERAGE && point->n >= row->first &&
         100 * point->n >= last && point->measured != 0;
}

static void forget(struct fit_row *row) {
  row->n_tests = 0;
  row->resolved = row->detected = false;
  row->rate_theory = row->rate = row->rate_se = row->rate_lo = row->rate_hi = NAN;
  row->coefficient_theory = row->coefficient = row->coefficient_se = NAN;
  row->snr = row->expected_snr = row->upper_bound = NAN;
}

// Points at 0 do not show on a paper's axes, and are left out of both lines.
static void draw_lines(const struct fit *fit, uint64_t last, struct fit_row *row) {
  struct line measured = {0}, exact = {0};
  double unused;
  forget(row);
  for (int p = 0; p < fit->n_points; p++) {
    const struct fit_point *point = &fit->point[p];
    if (!drawn(point, row, last)) continue;
    line_add(&measured, log((double)point->n), log(fabs(point->measured)));
    line_add(&exact, log((double)point->n), log(fabs(point->predicted)));
  }
  row->rate = 0 - line_slope(&measured, &row->rate_se); // never -0
  row->rate_theory = 0 - line_slope(&exact, &unused);
}

void fit_series_ols(const struct results *results, const struct series *series,
                    const struct prediction *theory, struct arena scratch, struct fit *fit) {
  int first = fit->n_rows;
  fit_series(results, series, theory, scratch, fit);
  for (int r = first; r < fit->n_rows; r++) draw_lines(fit, series->n_iterations, &fit->row[r]);
}
