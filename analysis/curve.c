#include "analysis/curve.h"

#include "analysis/sums.h"
#include "run/plan.h"

#include <math.h>

static double rmse(double variance, double bias) { return sqrt(variance + bias * bias); }

static struct curve curve_new(uint64_t n, struct arena *arena) {
  struct curve curve = {0};
  uint64_t *checkpoint = plan_checkpoints(n, &curve.n, arena);
  curve.point = arena_new(arena, struct curve_point, curve.n);
  for (int k = 0; k < curve.n; k++) curve.point[k].n = checkpoint[k];
  return curve;
}

struct curve curve_of_model(const struct model *model, double radius, uint64_t n,
                            struct arena *arena) {
  struct curve curve = curve_new(n, arena);
  for (int k = 0; k < curve.n; k++) {
    struct curve_point *point = &curve.point[k];
    const struct law *law = model->law;
    double alpha = model->alpha;
    point->rho = law->rho(alpha, point->n);
    point->radius = law_radius(law, alpha, radius, model->d, point->n);
    point->plus = sums_law(law, alpha, 1, point->n);
    point->minus = sums_law(law, alpha, -1, point->n);
    point->variance_one = expansion_value(&model->variance, point->rho);
    point->bias_one = expansion_value(&model->bias, point->rho);
    point->variance = model_variance(model, point->n);
    point->bias = model_bias(model, point->n);
    point->rmse = rmse(point->variance, point->bias);
  }
  return curve;
}

struct curve curve_of_prediction(const struct prediction *p, const struct cell *cell,
                                 struct arena *arena) {
  struct curve curve = curve_new(p->n, arena);
  curve.shape = !p->closed_form;
  double radius = cell_radius_is_known(cell) ? p->radius : NAN;
  double plus = 0, minus = 0, variance = 0, bias = 0;
  uint64_t j = 0;
  for (int k = 0; k < curve.n; k++) {
    struct curve_point *point = &curve.point[k];
    for (; j < point->n; j++) {
      double rho = p->family.rho[j], rest = p->closed_form ? p->rest[j] : 0;
      plus += rho, minus += 1 / rho;
      point->variance_one = p->divergent[j] + rest;
      point->bias_one = p->unbiased ? 0 : p->bias[j];
      variance += point->variance_one, bias += point->bias_one;
      point->rho = rho;
    }
    double count = (double)point->n;
    point->radius = radius * pow(point->rho, 1.0 / p->d);
    point->plus = plus, point->minus = minus;
    point->variance = variance / (count * count);
    point->bias = bias / count;
    point->rmse = rmse(point->variance, point->bias);
  }
  return curve;
}

// ---- slopes ----

static double variance_of(const struct curve_point *point) { return point->variance; }
static double bias_of(const struct curve_point *point) { return point->bias; }

// Over points first..last.
static double slope(const struct curve *curve, int first, int last,
                    double (*of)(const struct curve_point *)) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, count = last - first + 1;
  if (count < 2) return NAN;
  double x0 = log((double)curve->point[first].n), y0 = log(fabs(of(&curve->point[first])));
  if (!isfinite(y0)) return NAN;
  for (int k = first; k <= last; k++) {
    double x = log((double)curve->point[k].n) - x0, y = log(fabs(of(&curve->point[k]))) - y0;
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (sxy - sx * sy / count) / (sxx - sx * sx / count);
}

static struct slopes slopes_over(const struct curve *curve, int first, int last) {
  return (struct slopes){slope(curve, first, last, variance_of),
                         slope(curve, first, last, bias_of)};
}

struct slopes curve_slopes(const struct curve *curve, uint64_t from) {
  int first = 0;
  while (first < curve->n && curve->point[first].n < from) first++;
  return slopes_over(curve, first, curve->n - 1);
}

struct slopes curve_local_slopes(const struct curve *curve, int point) {
  if (point == 0) return (struct slopes){NAN, NAN};
  return slopes_over(curve, point - 1, point);
}
