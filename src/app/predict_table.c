// What is said of a prediction, in columns.
#include "app/predict.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

static const struct curve_point *last(const struct predicted *p) {
  return &p->curve.point[p->curve.n - 1];
}

// What is not known is a dash; a curve without constants is not shown.
void predict_number(char text[PREDICT_TEXT], double x) {
  if (isfinite(x))
    snprintf(text, PREDICT_TEXT, "%.4g", x);
  else
    strcpy(text, "-");
}

// What was asked must show its differences.
static void asked_number(char *text, double x) {
  predict_number(text, x);
  if (isfinite(x)) snprintf(text, PREDICT_TEXT, "%.6g", x);
}

static void curve_number(const struct predicted *p, char *text, double x) {
  predict_number(text, p->curve.shape ? NAN : x);
}

static void count(char *text, uint64_t n) { snprintf(text, PREDICT_TEXT, "%" PRIu64, n); }

// ---- columns: what was asked, then what follows ----

static void print_scene(const struct predicted *p, char *text) {
  snprintf(text, PREDICT_TEXT, "%s", p->probe ? p->cell->scene : "-");
}
static void print_integrator(const struct predicted *p, char *text) {
  snprintf(text, PREDICT_TEXT, "%s", p->probe ? p->cell->integrator->name : "-");
}
static void print_probe(const struct predicted *p, char *text) {
  strcpy(text, "-");
  if (p->probe) snprintf(text, PREDICT_TEXT, "%d,%d", p->probe->x, p->probe->y);
}
// Path tracing has no use for what follows.
static bool has_photons(const struct predicted *p) {
  return !p->probe || p->cell->integrator->photons;
}
static void print_law(const struct predicted *p, char *text) {
  snprintf(text, PREDICT_TEXT, "%s", has_photons(p) ? p->model.law->name : "-");
}
static void print_kernel(const struct predicted *p, char *text) {
  snprintf(text, PREDICT_TEXT, "%s", has_photons(p) ? p->model.kernel->name : "-");
}
static void print_dimension(const struct predicted *p, char *text) {
  count(text, (uint64_t)p->model.d);
}
static void print_alpha(const struct predicted *p, char *text) {
  asked_number(text, has_photons(p) ? p->model.alpha : NAN);
}
static void print_photons(const struct predicted *p, char *text) {
  strcpy(text, "-");
  if (has_photons(p)) count(text, p->cell->photons);
}
static double first_radius(const struct predicted *p) {
  return p->probe ? probe_radius(p->cell, p->probe) : p->cell->radius;
}
static void print_radius(const struct predicted *p, char *text) {
  asked_number(text, has_photons(p) && first_radius(p) > 0 ? first_radius(p) : NAN);
}
static void print_lambda(const struct predicted *p, char *text) {
  asked_number(text, p->model.light.lambda);
}
static void print_curvature(const struct predicted *p, char *text) {
  asked_number(text, has_photons(p) ? p->model.light.curvature : NAN);
}
static void print_mu(const struct predicted *p, char *text) {
  asked_number(text, p->probe ? p->model.light.mu : NAN);
}
static void print_n(const struct predicted *p, char *text) { count(text, last(p)->n); }
static void print_from(const struct predicted *p, char *text) { count(text, p->from); }

static void print_variance(const struct predicted *p, char *text) {
  curve_number(p, text, last(p)->variance);
}
static void print_bias(const struct predicted *p, char *text) {
  curve_number(p, text, last(p)->bias);
}
static void print_rmse(const struct predicted *p, char *text) {
  curve_number(p, text, last(p)->rmse);
}

// "0.00677 N^-0.6667"; only the power where the constant is not known.
static void print_asymptote(struct asymptote a, char *text) {
  char constant[PREDICT_TEXT / 2] = "", power[PREDICT_TEXT / 2 - 8] = "";
  if (isfinite(a.constant)) snprintf(constant, sizeof constant, "%.4g", a.constant);
  if (a.exponent != 0) snprintf(power, sizeof power, "N^-%.4f", a.exponent);
  if (isnan(a.exponent))
    strcpy(text, "-");
  else if (a.constant == 0)
    strcpy(text, "0");
  else if (!*constant && !*power)
    strcpy(text, "constant");
  else
    snprintf(text, PREDICT_TEXT, "%s%s%s%s", constant, *constant && *power ? " " : "", power,
             a.logarithm ? " ln N" : "");
}
static void print_variance_limit(const struct predicted *p, char *text) {
  print_asymptote(p->rates.variance, text);
}
static void print_bias_limit(const struct predicted *p, char *text) {
  print_asymptote(p->rates.bias, text);
}
static void print_slope(char *text, double slope) {
  strcpy(text, "-");
  if (isfinite(slope)) snprintf(text, PREDICT_TEXT, "%.4f", slope);
  if (strcmp(text, "-0.0000") == 0) strcpy(text, "0.0000");
}
static void print_variance_slope(const struct predicted *p, char *text) {
  print_slope(text, p->slopes.variance);
}
static void print_bias_slope(const struct predicted *p, char *text) {
  print_slope(text, p->slopes.bias);
}
static void print_best_radius(const struct predicted *p, char *text) {
  predict_number(text, p->rates.best_radius * first_radius(p));
}
static void print_best_alpha(const struct predicted *p, char *text) {
  predict_number(text, p->rates.best_alpha_at_n);
}
static void print_crossover(const struct predicted *p, char *text) {
  strcpy(text, "-");
  if (p->rates.crossover) count(text, p->rates.crossover);
}

// Those `asked` are said once where all lines have the same; the others are columns always.
static const struct column {
  const char *head;
  bool asked, left;
  void (*print)(const struct predicted *, char text[PREDICT_TEXT]);
} columns[] = {
    {"scene", true, true, print_scene},
    {"probe", true, false, print_probe},
    {"integrator", true, true, print_integrator},
    {"law", true, true, print_law},
    {"kernel", true, true, print_kernel},
    {"d", true, false, print_dimension},
    {"alpha", true, false, print_alpha},
    {"photons", true, false, print_photons},
    {"r1", true, false, print_radius},
    {"lambda", true, false, print_lambda},
    {"curvature", true, false, print_curvature},
    {"mu", true, false, print_mu},
    {"N", true, false, print_n},
    {"line from", true, false, print_from},
    {"variance", false, false, print_variance},
    {"bias", false, false, print_bias},
    {"rmse", false, false, print_rmse},
    {"variance tends to", false, true, print_variance_limit},
    {"bias tends to", false, true, print_bias_limit},
    {"var. line", false, false, print_variance_slope},
    {"bias line", false, false, print_bias_slope},
    {"best r1", false, false, print_best_radius},
    {"best alpha", false, false, print_best_alpha},
    {"bias^2 = var.", false, false, print_crossover},
};
enum { N_COLUMNS = sizeof columns / sizeof *columns };

void predict_text(const struct predicted *p, const char *head, char text[PREDICT_TEXT]) {
  for (int c = 0; c < N_COLUMNS; c++) {
    if (strcmp(columns[c].head, head) != 0) continue;
    columns[c].print(p, text);
    return;
  }
  assert(false && "a column");
}

static int column_width(const struct column *column, const struct predicted *p, int n) {
  char text[PREDICT_TEXT];
  size_t width = strlen(column->head);
  for (int k = 0; k < n; k++) {
    column->print(&p[k], text);
    if (strlen(text) > width) width = strlen(text);
  }
  return (int)width;
}

static bool is_same(const struct column *column, const struct predicted *p, int n) {
  char first[PREDICT_TEXT], other[PREDICT_TEXT];
  column->print(&p[0], first);
  for (int k = 1; k < n; k++) {
    column->print(&p[k], other);
    if (strcmp(first, other) != 0) return false;
  }
  return true;
}

void predict_print_common(const struct predicted *p, int n, FILE *out) {
  const char *separator = "";
  for (int c = 0; c < N_COLUMNS; c++) {
    char text[PREDICT_TEXT];
    columns[c].print(&p[0], text);
    if (!columns[c].asked || !is_same(&columns[c], p, n) || strcmp(text, "-") == 0) continue;
    fprintf(out, "%s%s %s", separator, columns[c].head, text);
    separator = ", ";
  }
  fputc('\n', out);
}

// The heads where there is no prediction.
static void print_line(const struct predicted *p, const int *width, FILE *out) {
  const char *separator = "";
  for (int c = 0; c < N_COLUMNS; c++) {
    char text[PREDICT_TEXT];
    if (!width[c]) continue;
    strcpy(text, columns[c].head);
    if (p) columns[c].print(p, text);
    fprintf(out, columns[c].left ? "%s%-*s" : "%s%*s", separator, width[c], text);
    separator = "  ";
  }
  fputc('\n', out);
}

void predict_print_table(const struct predicted *p, int n, FILE *out) {
  int width[N_COLUMNS];
  for (int c = 0; c < N_COLUMNS; c++) {
    bool shown = !columns[c].asked || !is_same(&columns[c], p, n);
    width[c] = shown ? column_width(&columns[c], p, n) : 0;
  }
  print_line(NULL, width, out);
  for (int k = 0; k < n; k++) print_line(&p[k], width, out);
}
