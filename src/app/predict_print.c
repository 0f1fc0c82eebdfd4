// One prediction: its curve and what follows from it.
#include "app/predict.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const struct curve_point *last(const struct predicted *p) {
  return &p->curve.point[p->curve.n - 1];
}

static void print_point(const struct predicted *p, const struct curve_point *point, FILE *out) {
  const double value[] = {point->rho,      point->radius,       point->plus,
                          point->minus,    point->variance_one, point->bias_one,
                          point->variance, point->bias,         point->rmse};
  fprintf(out, "%12" PRIu64, point->n);
  for (int k = 0; k < 9; k++) {
    char text[PREDICT_TEXT];
    predict_number(text, k >= 4 && p->curve.shape ? NAN : value[k]);
    fprintf(out, "  %10s", text);
  }
  fputc('\n', out);
}

// Two points a decade and the last.
static void print_curve(const struct predicted *p, FILE *out) {
  fprintf(out, "%60s  %22s  %34s\n", "", "iteration N alone", "average of N iterations");
  static const char *const heads[] = {"rho",  "radius",   "S+",   "S-",  "variance",
                                      "bias", "variance", "bias", "rmse"};
  fprintf(out, "%12s", "N");
  for (int k = 0; k < 9; k++) fprintf(out, "  %10s", heads[k]);
  fputc('\n', out);
  double next = 1;
  for (int k = 0; k < p->curve.n; k++) {
    const struct curve_point *point = &p->curve.point[k];
    if ((double)point->n + 0.5 < next && point != last(p)) continue;
    print_point(p, point, out);
    next *= sqrt(10);
  }
}

static void print_rates(const struct predicted *p, FILE *out) {
  char variance[PREDICT_TEXT], bias[PREDICT_TEXT];
  predict_text(p, "variance tends to", variance);
  predict_text(p, "bias tends to", bias);
  fprintf(out, "N to infinity   variance of the average %s, bias %s\n", variance, bias);
  predict_text(p, "var. line", variance);
  predict_text(p, "bias line", bias);
  fprintf(out, "straight line   over N = %" PRIu64 "..%" PRIu64 ", log-log: variance %s, bias %s\n",
          p->from, last(p)->n, variance, bias);
}

static void print_best(const struct predicted *p, FILE *out) {
  const struct rates *rates = &p->rates;
  char radius[PREDICT_TEXT], rmse[PREDICT_TEXT], alpha[PREDICT_TEXT];
  predict_text(p, "best r1", radius);
  predict_number(rmse, rates->best_rmse);
  predict_text(p, "best alpha", alpha);
  if (isfinite(rates->best_radius))
    fprintf(out,
            "best r1         %s at N = %" PRIu64 ": rmse %s, %.4g times that of the best constant "
            "radius; variance = %.3g bias^2\n",
            radius, last(p)->n, rmse, rates->penalty, 4.0 / p->model.d);
  if (!isfinite(rates->best_alpha)) return;
  fprintf(out, "best alpha      %.4f for the fastest fall at a fixed r1", rates->best_alpha);
  if (isfinite(rates->best_alpha_at_n))
    fprintf(out, ", %s for the least error at N = %" PRIu64 " with this r1", alpha, last(p)->n);
  fputc('\n', out);
}

static void print_balance(const struct predicted *p, FILE *out) {
  const struct rates *rates = &p->rates;
  const char *larger = rates->bias_last ? "bias^2" : "variance";
  if (isnan(p->model.light.curvature) || rates->bias.constant == 0) return;
  if (rates->crossover)
    fprintf(out, "balance         bias^2 = variance at N = %" PRIu64 "; later %s is larger\n",
            rates->crossover, larger);
  else
    fprintf(out, "balance         %s is larger at every N\n", larger);
}

static void print_notes(const struct predicted *p, FILE *out) {
  double edge = p->model.law->measure_exponent(p->model.alpha) / p->model.d;
  if (edge > 0)
    fprintf(out, "at hard edges   bias^2 summed over an image falls only as N^-%.4f\n", edge);
  if (p->rates.pooled_bias != 1)
    fprintf(out,
            "pooled photons  (weights rho_i instead of equal ones): variance x %.4g, bias x %.4g\n",
            p->rates.pooled_variance, p->rates.pooled_bias);
}

static void print_units(const struct predicted *p, FILE *out) {
  if (p->probe)
    fputs("variance, bias and rmse are luminances of radiance\n\n", out);
  else
    fputs("variance, bias and rmse are relative to the light at the point\n\n", out);
}

static void print_reservations(const struct predicted *p, int n, FILE *out) {
  int shapes = 0, local = 0;
  for (int k = 0; k < n; k++) {
    shapes += p[k].curve.shape;
    local += p[k].model.law->count != NULL;
  }
  if (shapes)
    fprintf(out,
            "no closed form  for %d of %d: exponents and slopes are predicted, constants not\n",
            shapes, n);
  if (local)
    fprintf(
        out,
        "local law       of %d of %d: radii follow the photons found; limits and optima are those "
        "of many in the first disc\n",
        local, n);
}

void predict_print(const struct predicted *p, int n, FILE *out) {
  predict_print_common(p, n, out);
  print_units(p, out);
  if (n > 1) {
    predict_print_table(p, n, out);
  } else {
    print_curve(p, out);
    fputc('\n', out);
    print_rates(p, out);
    print_best(p, out);
    print_balance(p, out);
    print_notes(p, out);
  }
  print_reservations(p, n, out);
}
