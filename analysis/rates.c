#include "analysis/rates.h"

#include "analysis/sums.h"

#include <math.h>

// ---- alpha ----

// The error falls fastest where N^-(1 - e) and (N^-(2 e / d))^2 do so alike: e = d / (d + 4). The
// exponent of a law falls with alpha, or is the same for all.
static double best_alpha(const struct model *model) {
  double (*exponent)(double) = model->law->measure_exponent, want = model->d / (model->d + 4.0);
  double lo = 0, hi = 1;
  if (!(exponent(lo) > want && exponent(hi) < want)) return NAN;
  while (lo < (lo + hi) / 2 && (lo + hi) / 2 < hi) {
    double middle = (lo + hi) / 2;
    *(exponent(middle) > want ? &lo : &hi) = middle;
  }
  return hi;
}

static double square_error(const struct model *model, uint64_t n) {
  double bias = model_bias(model, n), error = model_variance(model, n) + bias * bias;
  return error < INFINITY ? error : INFINITY; // a law may have no radii at alpha = 0
}

static double error_at_alpha(const struct model *model, double alpha, uint64_t n) {
  struct model other = *model;
  other.alpha = alpha;
  return square_error(&other, n);
}

// By golden section around the least of 33; an end of [0, 1] counts as well.
static double best_alpha_at(const struct model *model, uint64_t n) {
  enum { PARTS = 32 };
  int best = 0;
  double least = INFINITY;
  for (int k = 0; k <= PARTS; k++) {
    double error = error_at_alpha(model, (double)k / PARTS, n);
    if (error < least) least = error, best = k;
  }
  if (best == 0 || best == PARTS) return best / PARTS;
  const double golden = (sqrt(5) - 1) / 2;
  double lo = (best - 1.0) / PARTS, hi = (best + 1.0) / PARTS;
  while (hi - lo > 1e-5) { // an error within 1e-9 of the least
    double a = hi - golden * (hi - lo), b = lo + golden * (hi - lo);
    if (error_at_alpha(model, a, n) < error_at_alpha(model, b, n))
      hi = b;
    else
      lo = a;
  }
  return (lo + hi) / 2;
}

// ---- radius ----

// The same light seen by a first disc `scale` times as wide.
static struct model scaled(const struct model *model, double scale) {
  struct local_light light = model->light;
  light.lambda *= pow(scale, model->d);
  light.curvature *= scale * scale;
  light.bicurvature *= scale * scale * scale * scale;
  return model_new(model->law, model->kernel, model->alpha, model->d, light);
}

// Of the leading terms variance s^-d + bias^2 s^4: where variance is 4/d of bias^2.
static void set_best_radius(const struct model *model, uint64_t n, struct rates *rates) {
  int d = model->d;
  double minus = sums_law(model->law, model->alpha, -1, n);
  double plus = sums_law(model->law, model->alpha, 2.0 / d, n);
  double variance = model->variance.term[0].factor * minus,
         bias = model->bias.term[0].factor * plus;
  if (!(bias * bias > 0)) return;
  rates->best_radius = pow(d * variance / (4 * bias * bias), 1.0 / (d + 4));
  struct model best = scaled(model, rates->best_radius);
  if (best.light.lambda <= best.light.photons) rates->best_rmse = sqrt(square_error(&best, n));
  double square = pow(minus / (double)n, 4.0 / (d + 4)) * pow(plus / (double)n, 2.0 * d / (d + 4));
  rates->penalty = sqrt(square);
}

// ---- crossover ----

static bool bias_dominates(const struct model *model, uint64_t n) {
  double bias = model_bias(model, n);
  return bias * bias > model_variance(model, n);
}

// One place a decade up to 1e14; then the first n where it is as later.
static void set_crossover(const struct model *model, struct rates *rates) {
  uint64_t before = 0, after = 0;
  bool was = bias_dominates(model, 1);
  for (uint64_t n = 10; n <= UINT64_C(100000000000000); n *= 10) {
    bool is = bias_dominates(model, n);
    if (is != was) before = n / 10, after = n;
    was = is;
  }
  rates->bias_last = was;
  while (after - before > 1) {
    uint64_t middle = before + (after - before) / 2;
    *(bias_dominates(model, middle) == was ? &after : &before) = middle;
  }
  rates->crossover = after;
}

// ---- pooling ----

static void set_pooled(const struct model *model, uint64_t n, struct rates *rates) {
  double step = 2.0 / model->d, count = (double)n;
  double plus = sums_law(model->law, model->alpha, 1, n);
  double minus = sums_law(model->law, model->alpha, -1, n);
  rates->pooled_variance = count * count / (plus * minus);
  rates->pooled_bias = count * sums_law(model->law, model->alpha, 1 + step, n) /
                       (plus * sums_law(model->law, model->alpha, step, n));
}

struct rates rates_new(const struct model *model, uint64_t n) {
  struct rates rates = {
      .variance = expansion_asymptote(&model->variance, model->law, model->alpha, 2),
      .bias = expansion_asymptote(&model->bias, model->law, model->alpha, 1),
      .best_alpha = best_alpha(model),
      .best_alpha_at_n = NAN,
      .best_radius = NAN,
      .best_rmse = NAN,
      .penalty = NAN,
  };
  set_pooled(model, n, &rates);
  if (isnan(model->light.lambda) || isnan(model->light.curvature)) return rates;
  if (isfinite(rates.best_alpha) && n > 1) rates.best_alpha_at_n = best_alpha_at(model, n);
  set_best_radius(model, n, &rates);
  set_crossover(model, &rates);
  return rates;
}
