#include "analysis/image_error.h"

#include <math.h>
#include <string.h>

static double mse(double x, double r) { return (x - r) * (x - r); }

static double relmse(double x, double r) { return (x - r) * (x - r) / (r * r + 0.01); }

static double smape(double x, double r) { return x == r ? 0 : fabs(x - r) / (fabs(x) + fabs(r)); }

const struct image_metric image_metrics[IMAGE_METRICS] = {
    [IMAGE_MSE] = {"mse", "mean of (x - r)^2", mse},
    [IMAGE_RELMSE] = {"relmse", "mean of (x - r)^2 / (r^2 + 0.01)", relmse},
    [IMAGE_SMAPE] = {"smape", "mean of |x - r| / (|x| + |r|)", smape},
};

// Planes of R, G and B; a gray image has one, three times.
static bool find_planes(const struct image *image, const char *name, const float *plane[3],
                        struct problem *problem) {
  static const char *const wanted[] = {"R", "G", "B"};
  for (int c = 0; c < 3; c++) {
    plane[c] = NULL;
    for (int k = 0; k < image->n_channels; k++)
      if (!strcmp(image->name[k], wanted[c]) || (!plane[c] && !strcmp(image->name[k], "Y")))
        plane[c] = image->plane[k];
    if (!plane[c]) return problem_set(problem, "%s: has no channel %s", name, wanted[c]);
  }
  return true;
}

static bool check_finite(const struct image *image, const char *name, const float *plane[3],
                         struct problem *problem) {
  for (int j = 0; j < image->width * image->height; j++)
    for (int c = 0; c < 3; c++)
      if (!isfinite(plane[c][j]))
        return problem_set(problem, "%s: pixel [%d, %d] is not finite", name, j % image->width,
                           j / image->width);
  return true;
}

bool image_error(const struct image *image, const char *name, const struct image *reference,
                 const char *reference_name, double *value, struct problem *problem) {
  const float *x[3], *r[3];
  if (image->width != reference->width || image->height != reference->height)
    return problem_set(problem, "%s: has %d x %d pixels, %s %d x %d", name, image->width,
                       image->height, reference_name, reference->width, reference->height);
  if (!find_planes(image, name, x, problem) ||
      !find_planes(reference, reference_name, r, problem) ||
      !check_finite(image, name, x, problem) ||
      !check_finite(reference, reference_name, r, problem))
    return false;
  int n = image->width * image->height;
  for (int m = 0; m < IMAGE_METRICS; m++) {
    double sum = 0;
    for (int c = 0; c < 3; c++)
      for (int j = 0; j < n; j++) sum += image_metrics[m].of((double)x[c][j], (double)r[c][j]);
    value[m] = sum / (3.0 * n);
  }
  return true;
}
