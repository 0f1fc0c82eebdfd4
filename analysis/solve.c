#include "analysis/solve.h"

#include <float.h>
#include <math.h>

// h = l l', after scaling to a unit diagonal so that units do not matter. A pivot that is lost in
// the rounding of the diagonal it came from is none.
static bool factor(const struct normal_equations *eq, double scale[SOLVE_MAX],
                   double l[SOLVE_MAX][SOLVE_MAX]) {
  for (int a = 0; a < eq->n; a++) {
    if (!(eq->h[a][a] > 0) || !isfinite(eq->h[a][a])) return false;
    scale[a] = 1 / sqrt(eq->h[a][a]);
  }
  for (int a = 0; a < eq->n; a++)
    for (int b = 0; b <= a; b++) {
      double sum = eq->h[a][b] * scale[a] * scale[b];
      for (int k = 0; k < b; k++) sum -= l[a][k] * l[b][k];
      if (a == b && !(sum > 64 * DBL_EPSILON)) return false;
      l[a][b] = a == b ? sqrt(sum) : sum / l[b][b];
    }
  return true;
}

static void back_substitute(int n, double l[SOLVE_MAX][SOLVE_MAX], double x[SOLVE_MAX]) {
  for (int a = 0; a < n; a++) {
    for (int k = 0; k < a; k++) x[a] -= l[a][k] * x[k];
    x[a] /= l[a][a];
  }
  for (int a = n - 1; a >= 0; a--) {
    for (int k = a + 1; k < n; k++) x[a] -= l[k][a] * x[k];
    x[a] /= l[a][a];
  }
}

bool normal_solve(const struct normal_equations *eq, double x[SOLVE_MAX],
                  double inverse[SOLVE_MAX][SOLVE_MAX]) {
  double scale[SOLVE_MAX], l[SOLVE_MAX][SOLVE_MAX];
  if (!factor(eq, scale, l)) return false;
  for (int a = 0; a < eq->n; a++) x[a] = eq->g[a] * scale[a];
  back_substitute(eq->n, l, x);
  for (int a = 0; a < eq->n; a++) x[a] *= scale[a];
  for (int b = 0; inverse && b < eq->n; b++) {
    double unit[SOLVE_MAX] = {0};
    unit[b] = scale[b];
    back_substitute(eq->n, l, unit);
    for (int a = 0; a < eq->n; a++) inverse[a][b] = unit[a] * scale[a];
  }
  return true;
}
