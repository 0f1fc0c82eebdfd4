#include "analysis/reference_image.h"

#include <math.h>
#include <string.h>

static const char *const colours[] = {"R", "G", "B"};
static const char *const variances[] = {"variance.R", "variance.G", "variance.B"};

static const float *plane_of(const struct image *image, const char *name) {
  for (int c = 0; c < image->n_channels; c++)
    if (strcmp(image->name[c], name) == 0) return image->plane[c];
  return NULL;
}

static bool check(const struct moment_image *at, const struct moment_image *first,
                  struct problem *problem) {
  for (int c = 0; c < 3; c++)
    if (!plane_of(at->image, colours[c]) || !plane_of(at->image, variances[c]))
      return problem_set(problem, "%s: has no mean and variance of R, G and B", at->name);
  if (at->runs < 2) return problem_set(problem, "%s: one run has no spread", at->name);
  if (at->image->width != first->image->width || at->image->height != first->image->height)
    return problem_set(problem, "%s and %s differ in size", first->name, at->name);
  return true;
}

// A weighed sum of n images at pixel j of channel c, and its variance.
static double sum_at(const struct moment_image *at, const double *weight, int n, int c, int j,
                     double *variance) {
  double sum = 0;
  *variance = 0;
  for (int k = 0; k < n; k++) {
    sum += weight[k] * (double)plane_of(at[k].image, colours[c])[j];
    *variance +=
        weight[k] * weight[k] * (double)plane_of(at[k].image, variances[c])[j] / at[k].runs;
  }
  return sum;
}

// weight[n]: of the reference; change[n]: of what it moved by since twice the radius.
static bool combine(const struct moment_image *at, const double *weight, const double *change,
                    int n, struct arena *arena, struct reference_image *out,
                    struct problem *problem) {
  for (int k = 0; k < n; k++)
    if (!check(&at[k], &at[0], problem)) return false;
  int size = at[0].image->width * at[0].image->height;
  out->image = image_new(at[0].image->width, at[0].image->height, 3, colours, arena);
  out->noise = out->bias = 0;
  for (int c = 0; c < 3; c++)
    for (int j = 0; j < size; j++) {
      double variance, noise, r = sum_at(at, weight, n, c, j, &variance);
      double d = sum_at(at, change, n, c, j, &noise), scale = 3.0 * size * (r * r + 0.01);
      out->image.plane[c][j] = (float)r;
      out->noise += variance / scale;
      out->bias += 2 * (d * d - noise) / scale; // without the noise of d
    }
  if (!(out->noise >= 0 && isfinite(out->noise) && isfinite(out->bias)))
    return problem_set(problem, "%s: has values that are not finite", at[0].name);
  out->bias = out->bias > 0 ? out->bias : 0;
  return true;
}

bool reference_image_unbiased(const struct moment_image *at, struct arena *arena,
                              struct reference_image *out, struct problem *problem) {
  return combine(at, (const double[]){1}, (const double[]){0}, 1, arena, out, problem);
}

bool reference_image_extrapolated(const struct moment_image at[3], struct arena *arena,
                                  struct reference_image *out, struct problem *problem) {
  static const double weight[] = {4.0 / 3, -1.0 / 3, 0}, change[] = {4.0 / 3, -5.0 / 3, 1.0 / 3};
  return combine(at, weight, change, 3, arena, out, problem);
}
