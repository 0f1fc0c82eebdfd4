// Fisher scoring: S_i^2 has mean V_i and variance phi_i V_i^2 with phi_i = 2/(K-1) + kappa_i/K.
// Weights come from the fitted V_i, never from S_i^2 itself, which is small where it happens to be
// small (theory 4.4).
#include "analysis/variance_model.h"

#include <math.h>

struct variance_row variance_model_row(const struct variance_model *model,
                                       const struct variance_point *at, uint64_t j) {
  const struct prediction *theory = model->theory;
  double divergent = theory->divergent[j] * exp(-model->log_ratio[j]);
  double rest = theory->rest ? theory->rest[j] : 0;
  struct variance_row row;
  row.by[0] = theory->closed_form ? divergent + rest : divergent;
  row.by[1] = rest;
  row.variance = at->coefficient[0] * row.by[0];
  if (model->n_coefficients == 2) row.variance += at->coefficient[1] * rest;
  row.by[model->n_coefficients] = -at->coefficient[0] * divergent * model->slope[j];
  return row;
}

// Score, information and value of the quasi-likelihood; false where a variance is not positive.
static bool evaluate(const struct variance_model *model, const struct variance_point *at,
                     bool free_rate, struct normal_equations *eq, double *value) {
  *eq = (struct normal_equations){.n = model->n_coefficients + free_rate};
  *value = 0;
  family_ratio(&model->theory->family, at->rate, model->log_ratio, model->slope);
  for (uint64_t j = model->theory->first; j < model->theory->n; j++) {
    struct variance_row row = variance_model_row(model, at, j);
    if (!(row.variance > 0)) return false;
    double ratio = model->measured[j] / row.variance, weight = 1 / model->dispersion[j];
    for (int a = 0; a < eq->n; a++) row.by[a] /= row.variance;
    normal_add(eq, row.by, ratio - 1, weight);
    *value -= weight * (ratio + log(row.variance));
  }
  return true;
}

static struct variance_point moved(const struct variance_model *model, struct variance_point from,
                                   const double *step, double length, bool free_rate) {
  for (int a = 0; a < model->n_coefficients; a++) from.coefficient[a] += length * step[a];
  if (free_rate) from.rate += length * step[model->n_coefficients];
  return from;
}

// Halves the step until the quasi-likelihood rises. Within 1e-3 standard errors of the top its
// rise is lost in rounding, and the whole step is taken.
static bool climb_once(const struct variance_model *model, bool free_rate, const double *step,
                       bool near, struct variance_point *at, struct normal_equations *eq,
                       double *value) {
  for (double length = 1; length > 0x1p-40; length /= 2) {
    struct variance_point next = moved(model, *at, step, length, free_rate);
    struct normal_equations next_eq;
    double next_value;
    if (!evaluate(model, &next, free_rate, &next_eq, &next_value)) continue;
    if (!near && next_value < *value) continue;
    *at = next, *eq = next_eq, *value = next_value;
    return true;
  }
  return false;
}

bool variance_model_climb(const struct variance_model *model, bool free_rate,
                          struct variance_point *at, struct normal_equations *eq) {
  double value, step[SOLVE_MAX];
  if (!evaluate(model, at, free_rate, eq, &value)) return false;
  for (int round = 0; round < 100; round++) {
    if (!normal_solve(eq, step, NULL)) return false;
    double worth = 0;
    for (int a = 0; a < eq->n; a++) worth += step[a] * eq->g[a];
    if (worth < 1e-12) return true; // the step is less than 1e-6 standard errors
    if (!climb_once(model, free_rate, step, worth < 1e-6, at, eq, &value)) return false;
  }
  return false;
}

struct variance_point variance_model_start(const struct variance_model *model) {
  double sum = 0, weight = 0;
  for (uint64_t j = model->theory->first; j < model->theory->n; j++) {
    double shape = model->theory->divergent[j];
    if (model->theory->closed_form) shape += model->theory->rest[j];
    sum += model->measured[j] / shape / model->dispersion[j];
    weight += 1 / model->dispersion[j];
  }
  return (struct variance_point){{sum / weight, 0}, model->theory->family.theory};
}

void variance_model_fill(const struct variance_model *model, const struct variance_point *at,
                         double *variance) {
  family_ratio(&model->theory->family, at->rate, model->log_ratio, model->slope);
  for (uint64_t j = 0; j < model->theory->n; j++)
    variance[j] =
        j < model->theory->first ? model->measured[j] : variance_model_row(model, at, j).variance;
}
