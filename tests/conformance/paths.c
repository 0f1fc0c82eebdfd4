// Path tracing against the stored images. Two tests a scene:
// - every block of 8 x 8 pixels, at a family-wise level of 0.01 over all blocks of all scenes;
// - the mean of the image, |z| < 4.
// z is Welch's t between two means as a normal deviate. Ours: batches of independent seeds. The
// reference's: 8 seeds a pixel, pooled over the region. Heavy tails do it no harm: our own renders
// in the reference's place (8 x 16 samples against 32 batches of 4, 20 times) gave |z| > 1.96
// in 5.1 % of blocks for c01, in 5.7 % for c04 with its caustics and in 5.4 % for c05, each +- 0.6
// %. Two more on the test itself:
// - split: our even against our odd batches, every block, at the same level. Should light be found
//   so rarely that errors from batches do not hold, this finds it without a reference.
// - planted: each quadrant of ours times 1.02 must be rejected wherever the errors of both sides
//   make that as good as certain.
#include "tests/conformance/parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 8 };
static const double family_level = 0.01, mean_limit = 4, plant = 0.02, certain = 0.9999;

// pbrt-v4's image and its standard error.
struct reference {
  struct image mean, se;
  const struct doubt *doubt;
};

struct judged {
  struct estimate ours, reference;
  double z, *block_z, worst_z, split_z;
  struct region worst;
  double error_ratio; // ours over the reference's, of the median block
  int planted, found; // quadrants in which the plant is as good as certain to be seen; and was
};

static struct estimate reference_region(const struct reference *reference, struct region at,
                                        struct arena scratch) {
  struct estimate region = region_reference(&reference->mean, &reference->se, at, scratch);
  const struct doubt *doubt = reference->doubt;
  if (!doubt || !region_overlap(at, doubt->where)) return region;
  return estimate_with_excess(region, doubt->excess);
}

// ---- how many samples ----

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The median over blocks of our variance over the reference's; 1 where neither has any.
static double variance_ratio(const struct batches *batches, const struct reference *reference,
                             struct arena scratch) {
  int blocks = region_count(&reference->mean, SIDE), n = 0;
  double *ratio = arena_new(&scratch, double, blocks);
  for (int b = 0; b < blocks; b++) {
    struct region at = region_block(&reference->mean, SIDE, b);
    double ours = batches_region(batches, at, 0, 1, scratch).se2;
    double theirs = reference_region(reference, at, scratch).se2;
    if (ours > 0 && theirs > 0) ratio[n++] = ours / theirs;
  }
  if (!n) return 1;
  qsort(ratio, (size_t)n, sizeof *ratio, ascending);
  return ratio[n / 2];
}

// Full: as many as make our error in the median block the reference's, from a pilot that is then
// forgotten; at most MOST. Glance: 64 a pixel, whatever error that leaves.
static struct batches render(const struct options *options, const struct subject *subject,
                             const struct reference *reference, struct arena *arena,
                             struct arena scratch) {
  enum { PILOT_BATCHES = 16, PILOT_SAMPLES = 8, BATCHES = 64, MOST = 16384, GLANCE = 32 };
  if (!options->full) return batches_render(subject, "glance", GLANCE, 64 / GLANCE, arena);
  struct batches pilot = batches_render(subject, "pilot", PILOT_BATCHES, PILOT_SAMPLES, &scratch);
  double wanted = (double)pilot.samples * variance_ratio(&pilot, reference, scratch);
  if (wanted > MOST) wanted = MOST;
  return batches_render(subject, "batch", BATCHES, (uint64_t)(wanted / BATCHES) + 1, arena);
}

// ---- the tests ----

static void judge_blocks(const struct batches *batches, const struct reference *reference,
                         struct judged *judged, struct arena *arena, struct arena scratch) {
  int blocks = region_count(&reference->mean, SIDE);
  judged->block_z = arena_new(arena, double, blocks);
  for (int b = 0; b < blocks; b++) {
    struct region at = region_block(&reference->mean, SIDE, b);
    struct estimate ours = batches_region(batches, at, 0, 1, scratch);
    judged->block_z[b] = compare_z(ours, reference_region(reference, at, scratch));
    double split = compare_z(batches_region(batches, at, 0, 2, scratch),
                             batches_region(batches, at, 1, 2, scratch));
    if (fabs(split) > fabs(judged->split_z)) judged->split_z = split;
    if (b && !(fabs(judged->block_z[b]) > fabs(judged->worst_z))) continue;
    judged->worst_z = judged->block_z[b];
    judged->worst = at;
  }
}

static bool inside(struct region block, struct region quadrant) {
  return block.x >= quadrant.x && block.x + block.width <= quadrant.x + quadrant.width &&
         block.y >= quadrant.y && block.y + block.height <= quadrant.y + quadrant.height;
}

// 2 % more light in one quadrant of ours.
static void plant_quadrant(const struct batches *batches, const struct reference *reference,
                           struct region quadrant, double threshold, struct judged *judged,
                           struct arena scratch) {
  double unseen = 1;
  bool found = false;
  for (int b = 0; b < region_count(&reference->mean, SIDE); b++) {
    struct region at = region_block(&reference->mean, SIDE, b);
    if (!inside(at, quadrant)) continue;
    struct estimate ours = batches_region(batches, at, 0, 1, scratch);
    struct estimate theirs = reference_region(reference, at, scratch);
    unseen *= 1 - compare_power(ours, theirs, plant * theirs.mean, threshold);
    ours.mean *= 1 + plant;
    ours.se2 *= (1 + plant) * (1 + plant);
    found |= fabs(compare_z(ours, theirs)) > threshold;
  }
  if (1 - unseen < certain) return;
  judged->planted++;
  judged->found += found;
}

static struct judged judge(const struct batches *batches, const struct reference *reference,
                           double threshold, struct arena *arena, struct arena scratch) {
  struct region all = {0, 0, reference->mean.width, reference->mean.height};
  struct judged judged = {.ours = batches_region(batches, all, 0, 1, scratch),
                          .reference =
                              region_reference(&reference->mean, &reference->se, all, scratch),
                          .error_ratio = sqrt(variance_ratio(batches, reference, scratch))};
  judged.z = compare_z(judged.ours, judged.reference);
  judge_blocks(batches, reference, &judged, arena, scratch);
  for (int q = 0; q < 4; q++)
    plant_quadrant(batches, reference, region_quadrant(&reference->mean, q), threshold, &judged,
                   scratch);
  return judged;
}

static bool passes(const struct judged *judged, double threshold) {
  return fabs(judged->z) < mean_limit && fabs(judged->worst_z) < threshold &&
         fabs(judged->split_z) < threshold && judged->found == judged->planted;
}

static bool read_reference(const struct options *options, const struct conformance_scene *row,
                           struct reference *reference, struct arena *arena,
                           struct problem *problem) {
  const char *stem = arena_format(arena, "%s/%s", options->conformance, row->name);
  reference->doubt = row->doubt;
  return image_read(arena_format(arena, "%s.mean.pfm", stem), arena, &reference->mean, problem) &&
         image_read(arena_format(arena, "%s.se.pfm", stem), arena, &reference->se, problem);
}

static bool same_size(const struct scene *scene, const struct reference *reference,
                      struct problem *problem) {
  const struct image *mean = &reference->mean, *se = &reference->se;
  int width = scene->camera.width, height = scene->camera.height;
  if (mean->width == width && mean->height == height && se->width == width && se->height == height)
    return true;
  return problem_set(problem, "the reference has %d x %d pixels, the film %d x %d", mean->width,
                     mean->height, width, height);
}

static void print_row(struct report *report, bool passed, const char *name,
                      const struct batches *batches, const struct judged *judged) {
  report_line(report, passed ? PASSED : FAILED,
              "%-24s %6" PRIu64 " %9.6f %9.6f %8.5f %6.2f %7.2f @%2d,%-2d %6.2f %4d/%d %6.2f %6.1f",
              name, batches->samples, judged->ours.mean, judged->reference.mean,
              judged->ours.mean / judged->reference.mean, judged->z, judged->worst_z,
              judged->worst.x, judged->worst.y, judged->split_z, judged->found, judged->planted,
              judged->error_ratio, batches->seconds);
}

static void check_subject(const struct options *options, struct report *report,
                          const struct subject *subject, const struct reference *reference,
                          double threshold, struct arena arena) {
  struct arena scratch = arena_reserve();
  struct batches batches = render(options, subject, reference, &arena, scratch);
  struct judged judged = judge(&batches, reference, threshold, &arena, scratch);
  bool passed = passes(&judged, threshold);
  print_row(report, passed, subject->name, &batches, &judged);
  if (options->always_pictures || (!passed && options->output)) {
    struct image ours = batches_mean(&batches, &arena);
    picture_write(options, subject->name, &ours, &reference->mean, judged.block_z, SIDE, scratch);
  }
  arena_release(scratch);
}

static void check_scene(const struct options *options, struct report *report,
                        const struct conformance_scene *row, double threshold, struct arena arena) {
  struct problem problem = {0};
  struct subject *subject = arena_new(&arena, struct subject, 1);
  struct reference reference;
  const char *path = arena_format(&arena, "%s/%s.pbrt", options->conformance, row->name);
  if (!subject_load(row->name, path, &arena, subject, &problem))
    refused(report, row->name, &problem);
  else if (!read_reference(options, row, &reference, &arena, &problem) ||
           !same_size(&subject->scene, &reference, &problem))
    report_line(report, FAILED, "%-24s %s", row->name, problem.text);
  else
    check_subject(options, report, subject, &reference, threshold, arena);
}

// Of all scenes, whether they are selected or can be read or not.
static long count_blocks(const struct options *options, struct arena scratch) {
  long count = 0;
  for (const struct conformance_scene *row = conformance_scenes; row->name; row++) {
    struct problem ignored = {0};
    struct reference reference;
    if (read_reference(options, row, &reference, &scratch, &ignored))
      count += region_count(&reference.mean, SIDE);
  }
  return count;
}

void paths_check(const struct options *options, struct report *report) {
  struct arena arena = arena_reserve();
  long blocks = count_blocks(options, arena);
  double threshold = compare_threshold(family_level, blocks ? blocks : 1);
  report_heading(report,
                 "path against pbrt-v4: |z of the mean| < %.0f, |z| of each of %ld blocks < %.2f",
                 mean_limit, blocks, threshold);
  report_heading(report, "%-24s %6s %9s %9s %8s %6s %14s %6s %6s %6s %6s", "scene", "spp", "ours",
                 "pbrt-v4", "ratio", "z", "worst block", "split", "plants", "error", "s");
  for (int s = 0; conformance_scenes[s].name; s++)
    if (selected(options, conformance_scenes[s].name)) {
      struct arena of_scene = arena_reserve();
      check_scene(options, report, &conformance_scenes[s], threshold, of_scene);
      arena_release(of_scene);
    }
  arena_release(arena);
}
