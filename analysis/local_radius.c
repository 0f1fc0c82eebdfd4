#include "analysis/local_radius.h"

#include "analysis/special.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

// W is smooth in ln s and ln N, so it is kept on a grid of both, and between its nodes polynomials
// through POINTS x POINTS of them stand for it. Half the step changes no mean of lambda = 1..400 by
// more than 1e-6, and no deviation by more than 1 % of itself.
enum { POINTS = 6 };
static const double step = 0.2;

// Sums over m are direct where few m matter, else by Gauss' rule for the binomial distribution,
// exact for polynomials in m of degree 2 NODES - 1.
enum { NODES = 10 };
static const double few = 6; // mean of m

// How far from what mean counts would do the grid reaches: e^-1.7 in s, e^1.5 in N, which is 7
// deviations of ln s at lambda = 1. Beyond it W is as at its edge.
static const double reach_s = 1.7, reach_n = 1.5;

struct grid {
  int n_s, n_n; // nodes; state n * n_s + s, and one more: nothing was found yet
  double log_n; // of the first row
};

// A row of the recursion's matrix at a time, dense, then packed.
struct entries {
  struct entry {
    int state;
    double weight;
  } * item;
  ptrdiff_t count, capacity;
};
struct matrix {
  struct grid grid;
  ptrdiff_t *end; // [states] of the row, in entries
  struct entries entries;
};

static int states(const struct grid *grid) { return grid->n_s * grid->n_n + 1; }

struct stencil {
  int first;
  double weight[POINTS];
};

// Lagrange's polynomial at `place`, in steps from the first of n nodes.
static struct stencil stencil_at(double place, int n) {
  place = fmin(fmax(place, 0), n - 1);
  struct stencil at;
  at.first = (int)fmin(fmax(floor(place) - (POINTS / 2 - 1), 0), n - POINTS);
  for (int k = 0; k < POINTS; k++) {
    at.weight[k] = 1;
    for (int j = 0; j < POINTS; j++)
      if (j != k) at.weight[k] *= (place - at.first - j) / (k - j);
  }
  return at;
}

// ---- one row ----

struct row {
  const struct local_radius *radius;
  const struct grid *grid;
  int power;
  double n, s, *dense;
};

// m photons are found with this probability.
static void find(const struct row *row, double m, double probability) {
  const struct grid *grid = row->grid;
  double ratio, n = row->radius->law->count(row->radius->alpha, row->n, m, &ratio);
  if (n == 0) {
    row->dense[states(grid) - 1] += probability;
    return;
  }
  struct stencil at_n = stencil_at((log(n) - grid->log_n) / step, grid->n_n);
  struct stencil at_s = stencil_at(-log(row->s * ratio) / step, grid->n_s);
  for (int j = 0; j < POINTS; j++)
    for (int k = 0; k < POINTS; k++)
      row->dense[(at_n.first + j) * grid->n_s + at_s.first + k] +=
          probability * (row->power == 1 ? ratio : ratio * ratio) * at_n.weight[j] * at_s.weight[k];
}

// Nine deviations on both sides, and nine more for small means, leave out less than 1e-15.
static void find_each(const struct row *row, double p) {
  double trials = row->radius->emitted, mean = trials * p, far = 9 * sqrt(mean) + 9;
  double last = fmin(trials, floor(mean + far));
  for (double m = fmax(0, ceil(mean - far)); m <= last; m++)
    find(row, m, special_binomial(m, p, trials));
}

static void find_smooth(const struct row *row, double p) {
  double m[NODES], weight[NODES];
  special_gauss_binomial(NODES, p, row->radius->emitted, m, weight);
  for (int k = 0; k < NODES; k++) find(row, m[k], weight[k]);
}

static void pack(struct matrix *matrix, int state, double *dense, struct arena *arena) {
  int n = states(&matrix->grid);
  for (int k = 0; k < n; k++)
    if (dense[k] != 0) *arena_push(arena, &matrix->entries) = (struct entry){k, dense[k]};
  matrix->end[state] = matrix->entries.count;
  memset(dense, 0, (size_t)n * sizeof *dense);
}

static void matrix_fill(struct matrix *matrix, const struct local_radius *radius, int power,
                        struct arena *arena) {
  const struct grid *grid = &matrix->grid;
  struct row row = {.radius = radius, .grid = grid, .power = power};
  row.dense = arena_new(arena, double, states(grid));
  matrix->end = arena_new(arena, ptrdiff_t, states(grid));
  for (int state = 0; state < states(grid); state++) {
    bool nothing = state == states(grid) - 1;
    row.n = nothing ? 0 : exp(grid->log_n + step * (state / grid->n_s));
    row.s = nothing ? 1 : exp(-step * (state % grid->n_s));
    double p = radius->fraction(radius->of, row.s);
    if (nothing || radius->emitted * p < few || radius->emitted < 2 * NODES)
      find_each(&row, p);
    else
      find_smooth(&row, p);
    pack(matrix, state, row.dense, arena);
  }
}

// ---- the recursion ----

// Wide enough for n passes: what mean counts would do, and the reach.
static struct grid grid_for(const struct local_radius *radius, uint64_t n) {
  double s = 1, count = 0, ratio;
  for (uint64_t i = 1; i < n; i++) {
    double m = radius->emitted * radius->fraction(radius->of, s);
    count = radius->law->count(radius->alpha, count, m, &ratio);
    s *= ratio;
  }
  double mean = radius->emitted * radius->fraction(radius->of, 1);
  double least = fmax(1, floor(mean - 9 * sqrt(mean) - 9));
  double log_n = log(radius->law->count(radius->alpha, 0, least, &ratio));
  return (struct grid){.n_s = POINTS + 1 + (int)((reach_s - log(s)) / step),
                       .n_n = POINTS + 1 + (int)((fmax(log(count) - log_n, 0) + reach_n) / step),
                       .log_n = log_n};
}

static void multiply(const struct matrix *matrix, const double *from, double *to) {
  ptrdiff_t k = 0;
  for (int state = 0; state < states(&matrix->grid); state++) {
    double sum = 0;
    for (; k < matrix->end[state]; k++)
      sum += matrix->entries.item[k].weight * from[matrix->entries.item[k].state];
    to[state] = sum;
  }
}

void local_radius_moment(const struct local_radius *radius, int power, uint64_t n, double *moment,
                         struct arena scratch) {
  assert(radius->law->count && radius->alpha > 0);
  struct matrix matrix = {.grid = grid_for(radius, n)};
  int size = states(&matrix.grid);
  double *now = arena_new(&scratch, double, size), *next = arena_new(&scratch, double, size);
  matrix_fill(&matrix, radius, power, &scratch);
  for (int state = 0; state < size; state++) now[state] = 1;
  for (uint64_t i = 1; i <= n; i++) {
    moment[i - 1] = now[size - 1];
    multiply(&matrix, now, next);
    double *swap = now;
    now = next, next = swap;
  }
}
