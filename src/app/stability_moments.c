// Moments over runs: a mean 1e12 times the spread, and 1e12 times the bias.
#include "app/stability.h"
#include "moments/moments.h"

#include <math.h>
#include <stddef.h>

// Numbers of up to 53 bits: their mean and spread are known exactly.
enum { N_VALUES = 1024, HALF = N_VALUES / 2 };
static const double middle = 0x1p52;

// -HALF..-1 and 1..HALF in a scattered order.
static double deviation(int j) {
  int k = j * 389 % N_VALUES - HALF;
  return k < 0 ? k : k + 1;
}

static double power_sum(int power) {
  double sum = 0;
  for (int k = 1; k <= HALF; k++) sum += 2 * (power == 2 ? 1.0 * k * k : 1.0 * k * k * k * k);
  return sum; // below 2^53: exact
}

// What a deviation is multiplied by, so that the mean is `ratio` standard deviations, 10 or more.
static double spread(double ratio) {
  return floor(middle / (ratio * sqrt(power_sum(2) / N_VALUES)));
}

// j, step: value j. By the tree of runs.
static struct moments moments_by_tree(double (*value)(int j, double step), double step) {
  struct arena arena = arena_reserve(), scratch = arena;
  struct moments_tree tree = moments_tree_new(1, &scratch);
  struct moments root;
  for (int j = 0; j < N_VALUES; j++) {
    struct moments leaf = moments_of(value(j, step));
    moments_tree_push(&tree, &leaf, &scratch);
  }
  moments_tree_root(&tree, &root);
  arena_release(arena);
  return root;
}

static double around_middle(int j, double step) { return middle + step * deviation(j); }

static double variance(double unused, double ratio) {
  (void)unused;
  double step = spread(ratio);
  return fabs(moments_by_tree(around_middle, step).m2 / (step * step * power_sum(2)) - 1);
}

static double fourth_moment(double unused, double ratio) {
  (void)unused;
  double step = spread(ratio), step2 = step * step;
  return fabs(moments_by_tree(around_middle, step).m4 / (step2 * step2 * power_sum(4)) - 1);
}

static double variance_of_squares(double unused, double ratio) {
  (void)unused;
  double step = spread(ratio), sum = 0, squares = 0;
  for (int j = 0; j < N_VALUES; j++) {
    double x = around_middle(j, step);
    sum += x;
    squares += x * x;
  }
  return fabs((squares - sum * sum / N_VALUES) / (step * step * power_sum(2)) - 1);
}

// Pairwise updates lose log2(n) u kappa (Chan, Golub, LeVeque 1983), kappa^2 = 1 + (mean / sd)^2.
static double variance_bound(double unused, double ratio) {
  (void)unused;
  return 10 * 0x1p-53 * sqrt(1 + ratio * ratio);
}

// Of a difference from the mean, x^4 has twice the relative error that x^2 has.
static double fourth_moment_bound(double unused, double ratio) {
  return 2 * variance_bound(unused, ratio);
}

// A bias of 1 / ratio of the mean; values are scattered over middle + [0, 2^51), and their sum is
// known.
static uint64_t bits_of_value(int j) {
  return stability_term(2 * (uint64_t)j) << 19 | stability_term(2 * (uint64_t)j + 1) >> 13;
}

static double scattered(int j, double unused) {
  (void)unused;
  return middle + (double)(int64_t)bits_of_value(j);
}

static double mean_beyond_middle(void) {
  uint64_t sum = 0; // of 61 bits
  for (int j = 0; j < N_VALUES; j++) sum += bits_of_value(j);
  return (double)(int64_t)sum / N_VALUES;
}

static double bias(double unused, double ratio) {
  (void)unused;
  double mean = moments_by_tree(scattered, 0).mean;
  return fabs(mean - middle - mean_beyond_middle()) / middle * ratio;
}

static double bias_in_float(double unused, double ratio) {
  (void)unused;
  float sum = 0;
  for (int j = 0; j < N_VALUES; j++) sum += (float)scattered(j, 0);
  return fabs((double)sum / N_VALUES - middle - mean_beyond_middle()) / middle * ratio;
}

// Three roundings of at most an ulp of 2^52, which is 1, in each of the tree's ten levels.
static double bias_bound(double unused, double ratio) {
  (void)unused;
  return 3 * 10 / middle * ratio;
}

// clang-format off
const struct stress stress_moments[] = {
  {"moments", "variance of runs", "mean/sd", 10, 1e12, 10, 0, variance, variance_bound, NULL},
  {"moments", "fourth moment of runs", "mean/sd", 10, 1e12, 10, 0,
   fourth_moment, fourth_moment_bound, NULL},
  {"moments", "squares less the square", "mean/sd", 10, 1e12, 10, 0,
   variance_of_squares, NULL, NULL},
  {"moments", "bias of runs", "mean/bias", 10, 1e12, 10, 0, bias, bias_bound, NULL},
  {"moments", "bias of floats", "mean/bias", 10, 1e12, 10, 0, bias_in_float, NULL, NULL},
  {0},
};
// clang-format on
