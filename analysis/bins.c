#include "analysis/bins.h"

#include <stddef.h>

struct bins bins_new(const double *information, uint64_t first, uint64_t n, double enough,
                     struct arena *arena) {
  struct bins bins = {.end = arena_new(arena, uint64_t, (ptrdiff_t)n)};
  uint64_t start = first;
  double held = 0;
  for (uint64_t i = first + 1; i <= n; i++) {
    held += information[i - 1];
    if (4 * (i - start) < start || held < enough) continue;
    bins.end[bins.n++] = start = i;
    held = 0;
  }
  if (start == n) return bins;
  if (bins.n == 0) bins.n = 1;
  bins.end[bins.n - 1] = n; // what is left is too little for a bin of its own
  return bins;
}

struct chi2 bins_chi2(int n_bins, const double *deviate, const double (*direction)[SOLVE_MAX],
                      int n_parameters, const double prior[SOLVE_MAX]) {
  struct normal_equations eq = {.n = n_parameters};
  double total = 0, x[SOLVE_MAX];
  int free_parameters = 0;
  for (int a = 0; a < n_parameters; a++) {
    eq.h[a][a] = prior[a];
    free_parameters += prior[a] == 0;
  }
  for (int b = 0; b < n_bins; b++) {
    normal_add(&eq, direction[b], deviate[b], 1);
    total += deviate[b] * deviate[b];
  }
  if (!normal_solve(&eq, x, NULL)) return (struct chi2){0, 0};
  for (int a = 0; a < n_parameters; a++) total -= x[a] * eq.g[a];
  return (struct chi2){total, n_bins - free_parameters};
}
