// Least squares on the running averages with their covariance (theory 4.4b).
#include "analysis/averages.h"
#include "analysis/fit_methods.h"
#include "analysis/special.h"

#include <math.h>

// The logarithm of a variance is nearly normal from so many runs.
static const double least_runs = 10;

static const char *variance(const struct prediction *theory, const struct series *series,
                            const double *weights, struct variance_fit *v, struct arena scratch) {
  if (series->iteration[0].n < least_runs) return "fewer than 10 runs: ln S^2 is not normal";
  struct averages of = averages_of_variance(theory, series, weights, v->dispersion, &scratch);
  if (of.n <= of.n_terms) return "too few averages with 20 photons";
  if (!gls_factor(of.n, of.omega)) return "averages tell nothing apart";
  struct gls_model gls = averages_model(&of, &scratch);
  struct gls_solution held = {.x = {v->coefficient}};
  held.x[of.n_terms] = theory->family.theory;
  if (!gls_descend(&gls, of.n_terms, &held)) return "the fit does not converge";
  v->coefficient = held.x[0];
  v->coefficient_se = sqrt(held.covariance[0][0]);
  v->null_se = v->coefficient_se / v->coefficient;
  v->rate = NAN, v->rate_se = INFINITY;
  // Logarithms of variances are too skewed for their chi-squared to be one.
  v->lack_of_fit = (struct chi2){0, 0};
  struct gls_solution best = held;
  if (gls_descend(&gls, of.n_terms + 1, &best)) {
    v->rate = best.x[of.n_terms];
    v->rate_se = sqrt(best.covariance[of.n_terms][of.n_terms]);
  }
  variance_fit_judge(v, theory);
  return NULL;
}

// ---- bias ----

static const double least_rate = -1, largest_rate = 2; // that are searched

// Where the profile rises to `level` on the side of `step`; false: nowhere.
static bool find_end(const struct gls_model *gls, const struct gls_solution *best, double level,
                     double step, double *end) {
  double inside = best->x[gls->n_parameters - 1], outside = inside + step;
  while (gls_profile(gls, best->x, outside) < level) {
    if (outside < least_rate || outside > largest_rate) return false;
    inside = outside, outside += step;
  }
  while (fabs(outside - inside) > 1e-6) {
    double middle = (inside + outside) / 2;
    *(gls_profile(gls, best->x, middle) < level ? &inside : &outside) = middle;
  }
  *end = (inside + outside) / 2;
  return true;
}

static bool find_rate(const struct gls_model *gls, const struct gls_solution *held, double dof,
                      struct gls_solution *best, struct bias_fit *b) {
  int at = gls->n_parameters - 1;
  *best = *held;
  if (!gls_best(gls, least_rate, largest_rate, best)) return false;
  double quantile = special_t_quantile(0.025, dof), level = best->chi2 + quantile * quantile;
  double se = sqrt(best->covariance[at][at]), gain = held->chi2 - best->chi2;
  if (!find_end(gls, best, level, -se, &b->rate_lo)) return false;
  if (!find_end(gls, best, level, se, &b->rate_hi)) return false;
  b->rate = best->x[at], b->rate_se = se;
  double deviate = gain > 0 ? sqrt(gain) : 0; // below zero by rounding only
  b->rate_deviate = b->rate > held->x[at] ? deviate : -deviate;
  return true;
}

// Standard error of the rate with the others at their best for theory's.
static double rate_se_at(const struct gls_model *gls, const struct gls_solution *held) {
  struct normal_equations eq;
  double unused[SOLVE_MAX], covariance[SOLVE_MAX][SOLVE_MAX], chi2;
  return gls_evaluate(gls, gls->n_parameters, held->x, &eq, &chi2) &&
                 normal_solve(&eq, unused, covariance)
             ? sqrt(covariance[eq.n - 1][eq.n - 1])
             : INFINITY;
}

static void bias(const struct prediction *theory, const struct series *series,
                 const double *weights, const struct variance_fit *v, struct bias_fit *b,
                 struct arena scratch) {
  (void)v;
  struct averages of = averages_of_bias(theory, series, weights, &scratch);
  struct gls_model gls = averages_model(&of, &scratch);
  double rate = bias_theory_rate(theory);
  struct gls_solution held = {.x = {0}}, best;
  held.x[of.n_terms] = isnan(rate) ? 0 : rate;
  b->measured =
      of.n >= of.n_terms && gls_factor(of.n, of.omega) && gls_descend(&gls, of.n_terms, &held);
  if (!b->measured) return;
  b->coefficient = held.x[0];
  b->coefficient_se = sqrt(held.covariance[0][0]);
  b->snr = fabs(b->coefficient) / b->coefficient_se;
  b->lack_of_fit = (struct chi2){held.chi2, of.n - of.n_terms};
  b->rate_found = false;
  if (theory->unbiased || isnan(rate)) return;
  b->rate_se_theory = rate_se_at(&gls, &held);
  b->rate_found = find_rate(&gls, &held, b->dof, &best, b);
  if (b->rate_found) b->lack_of_fit = (struct chi2){best.chi2, of.n - of.n_terms - 1};
}

const struct fit_estimators fit_gls_estimators = {variance, bias};

void fit_series_gls(const struct results *results, const struct series *series,
                    const struct prediction *theory, struct arena scratch, struct fit *fit) {
  fit_series_by(&fit_gls_estimators, results, series, theory, scratch, fit);
}
