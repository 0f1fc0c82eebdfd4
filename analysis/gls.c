// Gauss and Newton's steps on data made independent by the inverse of Omega's root.
#include "analysis/gls.h"

#include <float.h>
#include <math.h>

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
