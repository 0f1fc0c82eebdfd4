#include "tests/conformance/compare.h"

#include "analysis/special.h"

#include <assert.h>
#include <math.h>

struct estimate estimate_of(const double *value, int n) {
  assert(n > 1);
  double mean = 0, m2 = 0;
  for (int k = 0; k < n; k++) mean += value[k] / n;
  for (int k = 0; k < n; k++) m2 += (value[k] - mean) * (value[k] - mean);
  return (struct estimate){.mean = mean, .se2 = m2 / (n - 1) / n, .dof = n - 1};
}

struct estimate estimate_extended(struct estimate first, int n, double mean_of_more, int more) {
  double share = (double)n / (n + more);
  first.mean = share * first.mean + (1 - share) * mean_of_more;
  first.se2 *= share;
  return first;
}

struct estimate estimate_weighted(const struct estimate *part, const double *weight, int n) {
  struct estimate out = {0};
  double total = 0, fourths = 0;
  for (int k = 0; k < n; k++) total += weight[k];
  for (int k = 0; k < n; k++) {
    double share = weight[k] / total, se2 = share * share * part[k].se2;
    if (share == 0) continue;
    out.mean += share * part[k].mean;
    out.rounding += share * part[k].rounding;
    out.se2 += se2;
    fourths += se2 * se2 / part[k].dof;
  }
  out.dof = fourths > 0 ? out.se2 * out.se2 / fourths : 1;
  return out;
}

struct estimate estimate_pooled(const double *mean, const double *se, int n, double dof) {
  struct estimate out = {.dof = dof};
  double squares = 0, fourths = 0;
  for (int k = 0; k < n; k++) {
    out.mean += mean[k] / n;
    squares += se[k] * se[k];
    fourths += se[k] * se[k] * se[k] * se[k];
  }
  if (fourths > 0) out.dof = dof * squares * squares / fourths;
  out.se2 = squares / n / n;
  return out;
}

struct estimate estimate_with_excess(struct estimate a, double excess) {
  double half = excess / 2 * fabs(a.mean);
  a.mean -= half;
  a.rounding += half;
  return a;
}

static double welch_dof(struct estimate a, struct estimate b) {
  double se2 = a.se2 + b.se2;
  return se2 * se2 / (a.se2 * a.se2 / a.dof + b.se2 * b.se2 / b.dof);
}

double compare_z(struct estimate a, struct estimate b) {
  double difference = a.mean - b.mean, se2 = a.se2 + b.se2;
  double excess = fabs(difference) - a.rounding - b.rounding;
  if (excess <= 0) return 0;
  if (se2 == 0) return copysign(INFINITY, difference);
  double p = special_t_two_sided(excess / sqrt(se2), welch_dof(a, b));
  return copysign(special_normal_quantile(p / 2), difference);
}

double compare_threshold(double level, long tests) {
  double each = -expm1(log1p(-level) / (double)tests);
  return special_normal_quantile(each / 2);
}

double compare_power(struct estimate a, struct estimate b, double shift, double threshold) {
  double excess = fabs(shift) - a.rounding - b.rounding, se2 = a.se2 + b.se2;
  if (excess <= 0) return 0;
  if (se2 == 0) return 1;
  double critical = special_t_quantile(special_two_sided(threshold) / 2, welch_dof(a, b));
  double missing = critical - excess / sqrt(se2); // standard errors that chance has to add
  double tail = special_two_sided(missing) / 2;
  return missing > 0 ? tail : 1 - tail;
}

double compare_smallest(struct estimate a, struct estimate b, double threshold, double power) {
  double se2 = a.se2 + b.se2, rounding = a.rounding + b.rounding;
  if (se2 == 0) return rounding;
  double critical = special_t_quantile(special_two_sided(threshold) / 2, welch_dof(a, b));
  return rounding + sqrt(se2) * (critical + special_normal_quantile(1 - power));
}

// ---- regions of images ----

static int blocks_across(int pixels, int side) { return (pixels + side - 1) / side; }

int region_count(const struct image *image, int side) {
  return blocks_across(image->width, side) * blocks_across(image->height, side);
}

struct region region_block(const struct image *image, int side, int number) {
  int columns = blocks_across(image->width, side);
  struct region region = {number % columns * side, number / columns * side, side, side};
  if (region.width > image->width - region.x) region.width = image->width - region.x;
  if (region.height > image->height - region.y) region.height = image->height - region.y;
  return region;
}

struct region region_quadrant(const struct image *image, int number) {
  int x = image->width / 2, y = image->height / 2;
  bool right = number % 2, bottom = number / 2;
  return (struct region){right ? x : 0, bottom ? y : 0, right ? image->width - x : x,
                         bottom ? image->height - y : y};
}

bool region_overlap(struct region a, struct region b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

static double pixel_mean(const struct image *image, int x, int y) {
  int channels = image->n_channels < 3 ? 1 : 3, at = y * image->width + x;
  double sum = 0;
  for (int c = 0; c < channels; c++) sum += (double)image->plane[c][at];
  return sum / channels;
}

double region_mean(const struct image *image, struct region region) {
  double sum = 0;
  for (int y = region.y; y < region.y + region.height; y++)
    for (int x = region.x; x < region.x + region.width; x++) sum += pixel_mean(image, x, y);
  return sum / region.width / region.height;
}

enum { SEEDS = 8 };

// The bias of a mean of rounded values. Noise of a standard deviation of one spacing leaves less
// than exp(-2 pi^2) of it: such rounding is part of the noise. Else it may be half a spacing, and a
// half float's spacing is at most 2^-10 of the value.
static double half_float_bias(double mean, double se) {
  double spacing = ldexp(mean, -10);
  return se * sqrt(SEEDS) < spacing ? spacing / 2 : 0;
}

// The standard error of a mean of three channels is at most the mean of the three, which is
// reached if their noise is the same; pbrt-v4's colour noise makes it up to a fifth smaller.
struct estimate region_reference(const struct image *mean, const struct image *se,
                                 struct region region, struct arena scratch) {
  int n = 0, pixels = region.width * region.height;
  double *value = arena_new(&scratch, double, pixels);
  double *error = arena_new(&scratch, double, pixels);
  double rounding = 0;
  for (int y = region.y; y < region.y + region.height; y++)
    for (int x = region.x; x < region.x + region.width; x++, n++) {
      value[n] = pixel_mean(mean, x, y);
      error[n] = pixel_mean(se, x, y);
      rounding += half_float_bias(value[n], error[n]) / pixels;
    }
  struct estimate out = estimate_pooled(value, error, n, SEEDS - 1);
  out.rounding = rounding;
  return out;
}
