#include "analysis/pace.h"

#include "analysis/special.h"

#include <math.h>

bool pace_span(const struct pace *pace, struct pace_span *span) {
  int n = pace->n_points;
  *span = (struct pace_span){0, INFINITY};
  for (int k = 0; n && k < pace->n_runs; k++) {
    span->from_s = fmax(span->from_s, pace->time_s[k * n]);
    span->to_s = fmin(span->to_s, pace->time_s[k * n + n - 1]);
  }
  return n && span->from_s <= span->to_s;
}

bool pace_common(const struct pace *a, const struct pace *b, struct pace_span *span) {
  struct pace_span other;
  if (!pace_span(a, span) || !pace_span(b, &other)) return false;
  *span = (struct pace_span){fmax(span->from_s, other.from_s), fmin(span->to_s, other.to_s)};
  return span->from_s <= span->to_s;
}

static double run_at(const double *time_s, const double *error, int n, double at_s) {
  if (n == 1) return error[0];
  int j = 1;
  while (j < n - 1 && time_s[j] < at_s) j++;
  double share = log(at_s / time_s[j - 1]) / log(time_s[j] / time_s[j - 1]);
  return exp((1 - share) * log(error[j - 1]) + share * log(error[j]));
}

struct pace_error pace_at(const struct pace *pace, double time_s) {
  int n = pace->n_points, runs = pace->n_runs;
  double sum = 0, square = 0, first = run_at(pace->time_s, pace->error, n, time_s);
  for (int k = 0; k < runs; k++) { // relative to the first, so that a small spread keeps its digits
    double x = run_at(pace->time_s + k * n, pace->error + k * n, n, time_s) - first;
    sum += x;
    square += x * x;
  }
  double variance = fmax(0, square - sum * sum / runs) / (runs - 1);
  return (struct pace_error){first + sum / runs, sqrt(variance / runs)};
}

// Of two means: the logarithm of their ratio, and how many standard errors that is from 0 by how
// many are significant. Above 1 the second has the smaller error, below -1 the first.
struct contrast {
  double ratio, significance;
};

static struct contrast contrast_at(const struct pace *a, const struct pace *b, double time_s) {
  struct pace_error x = pace_at(a, time_s), y = pace_at(b, time_s);
  double u = pow(x.se / x.mean, 2), v = pow(y.se / y.mean, 2), ratio = log(x.mean / y.mean);
  if (u + v == 0) return (struct contrast){ratio, ratio == 0 ? 0 : copysign(2, ratio)};
  // Welch and Satterthwaite
  double dof = pow(u + v, 2) / (u * u / (a->n_runs - 1) + v * v / (b->n_runs - 1));
  return (struct contrast){ratio, ratio / sqrt(u + v) / special_t_quantile(0.025, dof)};
}

// Contrasts at times that rise evenly in the logarithm, linear between them.
enum { STEPS = 512 };
struct contrasts {
  double log_time[STEPS + 1];
  struct contrast at[STEPS + 1];
};

static struct contrasts contrasts_of(const struct pace *a, const struct pace *b,
                                     struct pace_span span) {
  struct contrasts grid;
  double from = log(span.from_s), width = log(span.to_s / span.from_s);
  for (int k = 0; k <= STEPS; k++) {
    grid.log_time[k] = from + width * k / STEPS;
    grid.at[k] = contrast_at(a, b, exp(grid.log_time[k]));
  }
  return grid;
}

// 0, 1, or -1: neither is ahead.
static int ahead_at(const struct contrasts *grid, int k) {
  double significance = grid->at[k].significance;
  return significance >= 1 ? 1 : significance <= -1 ? 0 : -1;
}

// The time between points k and k + 1 where a quantity that is x and then y is at `level`.
static double time_of(const struct contrasts *grid, int k, double x, double y, double level) {
  double t = grid->log_time[k];
  return exp(t + (grid->log_time[k + 1] - t) * (level - x) / (y - x));
}

// Where a lead begins or ends between k and k + 1.
static double edge(const struct contrasts *grid, int k, int ahead) {
  return time_of(grid, k, grid->at[k].significance, grid->at[k + 1].significance, ahead ? 1 : -1);
}

static double lead_begins(const struct contrasts *grid, int k) {
  return k ? edge(grid, k - 1, ahead_at(grid, k)) : exp(grid->log_time[0]);
}

static double lead_ends(const struct contrasts *grid, int k) {
  int ahead = ahead_at(grid, k);
  bool on = k == STEPS || ahead_at(grid, k + 1) == ahead;
  return on ? exp(grid->log_time[k]) : edge(grid, k, ahead);
}

static bool crosses(const struct contrasts *grid, int k) { // between k - 1 and k
  return k && (grid->at[k].ratio > 0) != (grid->at[k - 1].ratio > 0);
}

int pace_leads(const struct pace *a, const struct pace *b, struct pace_lead lead[PACE_LEADS]) {
  struct pace_span span;
  int n = 0;
  double crossed_s = NAN;
  if (!pace_common(a, b, &span)) return 0;
  struct contrasts grid = contrasts_of(a, b, span);
  for (int k = 0; k <= STEPS; k++) {
    int ahead = ahead_at(&grid, k);
    if (crosses(&grid, k))
      crossed_s = time_of(&grid, k - 1, grid.at[k - 1].ratio, grid.at[k].ratio, 0);
    if (ahead < 0) continue;
    if (!n || lead[n - 1].ahead != ahead) {
      if (n == PACE_LEADS) return n;
      lead[n] = (struct pace_lead){ahead, lead_begins(&grid, k), 0, n ? crossed_s : NAN};
      n++;
    }
    lead[n - 1].to_s = lead_ends(&grid, k);
  }
  return n;
}
