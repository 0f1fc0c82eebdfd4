// Pixel filters: how a pixel's samples are distributed around its centre. A sample's weight is 1,
// so pixels stay independent of each other; what a filter mixes is the same as in pbrt-v4. All are
// products of one density in x and one in y.
#include "numeric/elementary.h"
#include "scene/scene.h"

#include <string.h>

static void read_radius(struct filter *filter, struct params *params, double fallback) {
  static const char *const names[] = {"xradius", "yradius"};
  for (int k = 0; k < 2; k++) {
    filter->radius[k] = params_float(params, names[k], fallback);
    if (!(filter->radius[k] > 0))
      params_complain(params, names[k], "%s must be positive", names[k]);
  }
}

// ---- box ----
static bool box_read(struct filter *filter, struct params *params) {
  read_radius(filter, params, 0.5);
  return !params->problem->text[0];
}

static void box_sample(const struct filter *filter, const double u[2], double offset[2]) {
  for (int k = 0; k < 2; k++) offset[k] = filter->radius[k] * (2 * u[k] - 1);
}

static double box_density(const struct filter *filter, int axis, double offset) {
  double r = filter->radius[axis];
  return offset >= -r && offset < r ? 0.5 / r : 0;
}

// ---- triangle ----
static bool triangle_read(struct filter *filter, struct params *params) {
  read_radius(filter, params, 2);
  return !params->problem->text[0];
}

static void triangle_sample(const struct filter *filter, const double u[2], double offset[2]) {
  for (int k = 0; k < 2; k++) {
    double x = u[k] < 0.5 ? sqrt(2 * u[k]) - 1 : 1 - sqrt(2 * (1 - u[k]));
    offset[k] = filter->radius[k] * x;
  }
}

static double triangle_density(const struct filter *filter, int axis, double offset) {
  double r = filter->radius[axis], left = r - fabs(offset);
  return left > 0 ? left / (r * r) : 0;
}

// ---- gaussian ----
// exp(-t^2) - exp(-R^2) within |t| <= R, t = x / (sigma sqrt(2)).
struct gauss {
  double end, floor; // R, exp(-R^2)
};

static struct gauss gauss_of(const struct filter *filter, int axis) {
  double end = filter->radius[axis] / (filter->sigma * sqrt(2));
  return (struct gauss){end, num_exp(-end * end)};
}

// From 0 to t.
static double gauss_integral(struct gauss g, double t) {
  return 0x1.c5bf891b4ef6ap-1 * num_erf(t) - g.floor * t; // sqrt(pi) / 2
}

// The t >= 0 below which lies the share v of one half: Newton's steps, which would leave the
// bracket where the density is nearly 0, else halves of it. They begin at a triangle's t. A step of
// size s leaves an error of about s^2 / 2 times the relative slope of the density, which is
// 1 / (R - t) near the end and about t before it.
static double gauss_quantile(struct gauss g, double v) {
  double lo = 0, hi = g.end, target = v * gauss_integral(g, g.end);
  double t = g.end * (1 - sqrt(1 - v));
  for (int step = 0; step < 100; step++) {
    double too_much = gauss_integral(g, t) - target;
    if (too_much == 0) return t;
    if (too_much > 0)
      hi = t;
    else
      lo = t;
    double next = t - too_much / (num_exp(-t * t) - g.floor);
    bool inside = next > lo && next < hi;
    double room = g.end - next < 0.25 ? g.end - next : 0.25;
    if (inside && fabs(next - t) <= 0x1p-26 * room) return next;
    t = inside ? next : 0.5 * (lo + hi);
  }
  return t;
}

static bool gaussian_read(struct filter *filter, struct params *params) {
  read_radius(filter, params, 1.5);
  filter->sigma = params_float(params, "sigma", 0.5);
  if (!(filter->sigma > 0)) return params_complain(params, "sigma", "sigma must be positive");
  // In the floats of pbrt little would be left of the difference, in our doubles half the digits.
  for (int k = 0; k < 2; k++)
    if (filter->sigma > 1000 * filter->radius[k])
      return params_complain(params, "sigma",
                             "sigma is more than 1000 times the radius, where the filter is the "
                             "difference of two equal numbers; use a smaller one");
  return !params->problem->text[0];
}

static void gaussian_sample(const struct filter *filter, const double u[2], double offset[2]) {
  for (int k = 0; k < 2; k++) {
    bool right = u[k] >= 0.5;
    struct gauss g = gauss_of(filter, k);
    double t = gauss_quantile(g, right ? 2 * u[k] - 1 : 1 - 2 * u[k]);
    double x = filter->radius[k] * (t / g.end);
    offset[k] = right ? x : -x;
  }
}

static double gaussian_density(const struct filter *filter, int axis, double offset) {
  struct gauss g = gauss_of(filter, axis);
  double t = offset / filter->radius[axis] * g.end, above = num_exp(-t * t) - g.floor;
  if (!(fabs(t) < g.end && above > 0)) return 0;
  return above / (2 * gauss_integral(g, g.end)) * (g.end / filter->radius[axis]);
}

static const struct filter_type
    box = {"box", "the same everywhere; radius 0.5", box_read, box_sample, box_density},
    gaussian = {"gaussian", "a Gaussian minus its value at the radius; radius 1.5, sigma 0.5",
                gaussian_read, gaussian_sample, gaussian_density},
    triangle = {"triangle", "falls linearly to the radius, 2", triangle_read, triangle_sample,
                triangle_density};

const struct filter_type *const filter_types[] = {&box, &gaussian, &triangle, NULL};

const struct filter_type *filter_find(const char *name) {
  for (int k = 0; filter_types[k]; k++)
    if (!strcmp(filter_types[k]->name, name)) return filter_types[k];
  return NULL;
}
