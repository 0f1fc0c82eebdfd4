// photonlab compare: errors of images, of independent runs where there are several.
#include "analysis/image_error.h"
#include "app/cli.h"
#include "moments/moments.h"

#include <math.h>
#include <stdalign.h>
#include <stdio.h>
#include <string.h>

static void print_metrics(const struct moments *over_images, int n) {
  for (int m = 0; m < IMAGE_METRICS; m++) {
    printf("%-8s %.6g", image_metrics[m].name, over_images[m].mean);
    if (n > 1) printf(" +- %.2g", sqrt(moments_se2(over_images[m])));
    printf("   %s\n", image_metrics[m].definition);
  }
  if (n > 1) printf("means of %d images and their standard errors\n", n);
}

// Runs of one seed have the same bits, and say nothing of each other's spread.
static bool check_apart(const struct cli *cli, const double (*value)[IMAGE_METRICS], int k,
                        struct problem *problem) {
  for (int j = 1; j < k; j++)
    if (memcmp(value[j], value[k], sizeof value[k]) == 0)
      return problem_set(problem,
                         "%s and %s have the same errors to the last bit: they are no independent "
                         "runs (--seed)",
                         cli->arguments[j], cli->arguments[k]);
  return true;
}

static int compare(struct cli *cli, struct problem *problem) {
  struct image reference;
  struct moments over_images[IMAGE_METRICS] = {{0}};
  int n = cli->n_arguments - 1;
  if (n < 1) return problem_set(problem, "compare: a reference and at least one image"), EXIT_USAGE;
  if (!image_read(cli->argument, cli->arena, &reference, problem)) return 1;
  double(*value)[IMAGE_METRICS] = arena_alloc(cli->arena, n + 1, sizeof *value, alignof(double));
  for (int k = 1; k <= n; k++) {
    struct arena own = *cli->arena;
    struct image image;
    if (!image_read(cli->arguments[k], &own, &image, problem) ||
        !image_error(&image, cli->arguments[k], &reference, cli->argument, value[k], problem) ||
        !check_apart(cli, value, k, problem))
      return 1;
    for (int m = 0; m < IMAGE_METRICS; m++)
      over_images[m] = moments_merge(over_images[m], moments_of(value[k][m]));
  }
  print_metrics(over_images, n);
  return 0;
}

const struct command command_compare = {
    "compare", "REFERENCE IMAGE...",
    "errors of images (exr, pfm, hdr) against a reference; of several: their mean over runs", "",
    compare};
