// Gauss and Newton's steps on data made independent by the inverse of Omega's root.
#include "analysis/gls.h"

#include <float.h>
#include <math.h>
#include <stddef.h>

bool gls_factor(int n, double *omega) {
  for (int a = 0; a < n; a++)
    for (int b = 0; b <= a; b++) {
      double sum = omega[a * n + b], whole = sum;
      for (int k = 0; k < b; k++) sum -= omega[a * n + k] * omega[b * n + k];
      if (a == b && !(sum > 64 * DBL_EPSILON * whole)) return false;
      omega[a * n + b] = a == b ? sqrt(sum) : sum / omega[b * n + b];
    }
  return true;
}

static void make_independent(const struct gls_model *model, double *v) {
  for (int a = 0; a < model->n; a++) {
    for (int k = 0; k < a; k++) v[a] -= model->root[a * model->n + k] * v[k];
    v[a] /= model->root[a * model->n + a];
  }
}

bool gls_evaluate(const struct gls_model *model, int n_free, const double *x,
                  struct normal_equations *eq, double *chi2) {
  if (!model->at(model->of, x, model->f, model->by)) return false;
  for (int k = 0; k < model->n; k++) model->f[k] = model->y[k] - model->f[k];
  make_independent(model, model->f);
  for (int a = 0; a < n_free; a++) make_independent(model, model->by + a * model->n);
  *eq = (struct normal_equations){.n = n_free};
  *chi2 = 0;
  for (int k = 0; k < model->n; k++) {
    double row[SOLVE_MAX];
    for (int a = 0; a < n_free; a++) row[a] = model->by[a * model->n + k];
    normal_add(eq, row, model->f[k], 1);
    *chi2 += model->f[k] * model->f[k];
  }
  return isfinite(*chi2);
}

// Halves the step until chi-squared falls. Within 1e-3 standard errors of the bottom its fall is
// lost in rounding, and the whole step is taken.
static bool descend_once(const struct gls_model *model, int n_free, const double *step, bool near,
                         struct gls_solution *at, struct normal_equations *eq) {
  for (double length = 1; length > 0x1p-40; length /= 2) {
    double x[SOLVE_MAX], chi2;
    struct normal_equations next;
    for (int a = 0; a < model->n_parameters; a++)
      x[a] = at->x[a] + (a < n_free ? length * step[a] : 0);
    if (!gls_evaluate(model, n_free, x, &next, &chi2) || (!near && chi2 > at->chi2)) continue;
    for (int a = 0; a < model->n_parameters; a++) at->x[a] = x[a];
    at->chi2 = chi2, *eq = next;
    return true;
  }
  return false;
}

bool gls_descend(const struct gls_model *model, int n_free, struct gls_solution *at) {
  struct normal_equations eq;
  double step[SOLVE_MAX];
  if (!gls_evaluate(model, n_free, at->x, &eq, &at->chi2)) return false;
  for (int round = 0; round < 100; round++) {
    if (!normal_solve(&eq, step, at->covariance)) return false;
    double worth = 0;
    for (int a = 0; a < n_free; a++) worth += step[a] * eq.g[a];
    if (worth < 1e-12) return true; // the step is less than 1e-6 standard errors
    if (!descend_once(model, n_free, step, worth < 1e-6, at, &eq)) return false;
  }
  return false;
}

// ---- models that are linear in all but the last parameter ----

// One step is enough. Moves x there.
static double least_at(const struct gls_model *model, double last, double *x) {
  int n_free = model->n_parameters - 1;
  struct normal_equations eq;
  double step[SOLVE_MAX], chi2;
  x[n_free] = last;
  if (!gls_evaluate(model, n_free, x, &eq, &chi2) || !normal_solve(&eq, step, NULL))
    return INFINITY;
  for (int a = 0; a < n_free; a++) chi2 -= step[a] * eq.g[a];
  for (int a = 0; a < n_free; a++) x[a] += step[a];
  return chi2;
}

double gls_profile(const struct gls_model *model, const double *x, double last) {
  double moved[SOLVE_MAX];
  for (int a = 0; a < model->n_parameters; a++) moved[a] = x[a];
  return least_at(model, last, moved);
}

// Golden section around the least of SCAN + 1, to 1e-6; none where that is at an end.
static bool search(const struct gls_model *model, double lo, double hi, struct gls_solution *at) {
  enum { SCAN = 24 };
  const double golden = 0.6180339887498949, step = (hi - lo) / SCAN;
  double chi2[SCAN + 1];
  int lowest = 0;
  for (int k = 0; k <= SCAN; k++) {
    chi2[k] = gls_profile(model, at->x, lo + k * step);
    if (chi2[k] < chi2[lowest]) lowest = k;
  }
  if (lowest == 0 || lowest == SCAN) return false;
  double left = lo + (lowest - 1) * step, right = left + 2 * step;
  while (right - left > 1e-6) {
    double a = right - golden * (right - left), b = left + golden * (right - left);
    if (gls_profile(model, at->x, a) < gls_profile(model, at->x, b))
      right = b;
    else
      left = a;
  }
  least_at(model, (left + right) / 2, at->x);
  struct normal_equations eq;
  double unused[SOLVE_MAX];
  return gls_evaluate(model, model->n_parameters, at->x, &eq, &at->chi2) &&
         normal_solve(&eq, unused, at->covariance);
}

// Where residuals are large and the model bends, Gauss and Newton's steps overshoot for ever.
bool gls_best(const struct gls_model *model, double lo, double hi, struct gls_solution *at) {
  struct gls_solution from = *at;
  if (gls_descend(model, model->n_parameters, at)) return true;
  *at = from;
  return search(model, lo, hi, at);
}
