// ln rho_i(alpha) is analytic in alpha up to alpha = -1, so polynomial interpolation at N Chebyshev
// points of [0, 1] errs by (3 + sqrt 8)^-N: 7e-10 for the 12 points used.
#include "analysis/family.h"

#include <math.h>
#include <stdbool.h>

static const double pi = 3.14159265358979323846;

static double node(int k) { return (1 - cos(pi * (k + 0.5) / FAMILY_NODES)) / 2; }

static bool alpha_is_rate(const struct law *law) {
  for (double alpha = 0.125; alpha < 1; alpha += 0.25)
    if (fabs(law->measure_exponent(alpha) - (1 - alpha)) > 1e-12) return false;
  return true;
}

struct family_table family_table_new(const struct law *law, uint64_t n, struct arena *arena) {
  struct family_table table = {.law = law, .n = n};
  if (!law || !alpha_is_rate(law)) return table;
  double *log_rho = arena_new(arena, double, FAMILY_NODES *(ptrdiff_t)n);
  for (int k = 0; k < FAMILY_NODES; k++)
    for (uint64_t i = 1; i <= n; i++) log_rho[(uint64_t)k * n + i - 1] = log(law->rho(node(k), i));
  table.log_rho = log_rho;
  return table;
}

struct family family_new(const struct family_table *table, double alpha, struct arena *arena) {
  const struct law *law = table->law;
  double *rho = arena_new(arena, double, (ptrdiff_t)table->n);
  for (uint64_t i = 1; i <= table->n; i++) rho[i - 1] = law ? law->rho(alpha, i) : 1;
  double theory = law ? 1 - law->measure_exponent(alpha) : 1;
  return (struct family){.table = table, .n = table->n, .theory = theory, .rho = rho};
}

// Lagrange's polynomials of the nodes and their derivatives at x in [0, 1].
static void lagrange(double x, double value[FAMILY_NODES], double slope[FAMILY_NODES]) {
  double at[FAMILY_NODES];
  for (int k = 0; k < FAMILY_NODES; k++) at[k] = node(k);
  for (int k = 0; k < FAMILY_NODES; k++) {
    value[k] = 1, slope[k] = 0;
    for (int j = 0; j < FAMILY_NODES; j++) {
      if (j == k) continue;
      double step = 1 / (at[k] - at[j]);
      slope[k] = (slope[k] * (x - at[j]) + value[k]) * step;
      value[k] *= (x - at[j]) * step;
    }
  }
}

// Beyond [0, 1] the tangent at the end.
static void weights(double rate, double value[FAMILY_NODES], double slope[FAMILY_NODES]) {
  double inside = rate < 0 ? 0 : rate > 1 ? 1 : rate;
  lagrange(inside, value, slope);
  for (int k = 0; k < FAMILY_NODES; k++) value[k] += (rate - inside) * slope[k];
}

static void power_ratio(const struct family *family, double rate, double *log_ratio,
                        double *slope) {
  for (uint64_t j = 0; j < family->n; j++) {
    slope[j] = log((double)(j + 1));
    log_ratio[j] = (rate - family->theory) * slope[j];
  }
}

void family_ratio(const struct family *family, double rate, double *log_ratio, double *slope) {
  const double *log_rho = family->table->log_rho;
  if (!log_rho) {
    power_ratio(family, rate, log_ratio, slope);
    return;
  }
  double here[FAMILY_NODES], d_here[FAMILY_NODES], there[FAMILY_NODES], d_there[FAMILY_NODES];
  weights(rate, here, d_here);
  weights(family->theory, there, d_there);
  for (uint64_t j = 0; j < family->n; j++) log_ratio[j] = slope[j] = 0;
  for (int k = 0; k < FAMILY_NODES; k++) {
    const double *row = log_rho + (uint64_t)k * family->n;
    double difference = here[k] - there[k];
    for (uint64_t j = 0; j < family->n; j++) {
      log_ratio[j] += difference * row[j];
      slope[j] += d_here[k] * row[j];
    }
  }
}
