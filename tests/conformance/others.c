// Scenes by others, coloured. pbrt-v4 is spectral, so image means may differ by 1 %: that is a
// margin, not an error. A scene fails if its mean is outside by more than four standard errors, and
// is said to agree only if it is inside by two.
#include "tests/conformance/parts.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const double margin = 0.01, limit = 4;

// The largest radius is about two pixels wide, as in agree.c.
struct other {
  const char *name;
  double radius;
};
static const struct other with_reference[] = {{"cornell-box", 0.037}, {"veach-bidir", 0.28}};

static struct runs_plan plan_of(const struct options *options, double radius) {
  return (struct runs_plan){.type = integrator_find("probabilistic"),
                            .radius = radius,
                            .n_emitted = options->full ? 25000 : 10000,
                            .iterations = options->full ? 8 : 1,
                            .runs = options->full ? 32 : 8,
                            .purpose = "photons"};
}

static void compare_means(struct report *report, const char *name, const char *how,
                          struct estimate ours, struct estimate theirs, double seconds) {
  double error = sqrt(ours.se2 + theirs.se2) / theirs.mean, ratio = ours.mean / theirs.mean;
  bool passed = fabs(ratio - 1) < margin + limit * error;
  bool agrees = fabs(ratio - 1) + 2 * error < margin;
  report_line(report, passed ? PASSED : FAILED, "%-24s %-8s %9.6f %9.6f %8.5f +- %.5f %-14s %6.1f",
              name, how, ours.mean, theirs.mean, ratio, error,
              agrees   ? "agrees"
              : passed ? "not resolvable"
                       : "disagrees",
              seconds);
}

static void compare_with(const struct options *options, struct report *report,
                         const struct other *other, const struct subject *subject,
                         const struct image *mean, const struct image *se, struct arena arena) {
  enum { BATCHES = 16 };
  struct region all = {0, 0, mean->width, mean->height};
  struct estimate theirs = region_reference(mean, se, all, arena), photons[REGIONS];
  struct regions regions = regions_of(subject, &arena);
  struct runs_plan plan = plan_of(options, other->radius);
  struct batches batches =
      batches_render(subject, "others", BATCHES, options->full ? 32 : 1, &arena);
  compare_means(report, subject->name, "path", batches_region(&batches, all, 0, 1, arena), theirs,
                batches.seconds);
  double begin = subject_seconds();
  runs_measure(subject, &regions, &plan, arena, photons);
  compare_means(report, subject->name, "photons", photons[0], theirs, subject_seconds() - begin);
  if (!options->always_pictures) return;
  struct image image = batches_mean(&batches, &arena);
  picture_write(options, subject->name, &image, mean, NULL, 1, arena);
}

static bool load(const struct options *options, const char *name, struct arena *arena,
                 struct subject *subject, struct problem *problem) {
  return subject_load(name, arena_format(arena, "%s/%s/small.pbrt", options->scenes, name), arena,
                      subject, problem);
}

static void check_with_reference(const struct options *options, struct report *report,
                                 const struct other *other, struct arena arena) {
  struct problem problem = {0};
  struct subject *subject = arena_new(&arena, struct subject, 1);
  struct image mean, se;
  const char *name = other->name;
  if (!load(options, name, &arena, subject, &problem)) {
    refused(report, name, &problem);
    return;
  }
  const char *stem = arena_format(&arena, "%s/%s/small", options->scenes, name);
  if (image_read(arena_format(&arena, "%s.mean.pfm", stem), &arena, &mean, &problem) &&
      image_read(arena_format(&arena, "%s.se.pfm", stem), &arena, &se, &problem))
    compare_with(options, report, other, subject, &mean, &se, arena);
  else
    report_line(report, FAILED, "%-24s %s", name, problem.text);
}

// No reference: path tracing and pbrt-v4's own sppm do not resolve it. Two extrapolations that
// share neither radii nor photons nor seeds.
static void check_water(const struct options *options, struct report *report, struct arena arena) {
  static const char name[] = "water-caustic";
  struct problem problem = {0};
  struct subject *subject = arena_new(&arena, struct subject, 1);
  if (!load(options, name, &arena, subject, &problem)) {
    refused(report, name, &problem);
    return;
  }
  double begin = subject_seconds(), z[AREAS];
  struct estimate coarse[REGIONS], fine[REGIONS];
  struct regions regions = regions_of(subject, &arena);
  struct runs_plan plan = plan_of(options, 0.073);
  if (options->full) plan.iterations = 2; // thousands of photons a disc where the water focuses
  runs_measure(subject, &regions, &plan, arena, coarse);
  plan.radius *= 0.6;
  plan.n_emitted *= 2;
  plan.purpose = "fine";
  runs_measure(subject, &regions, &plan, arena, fine);
  bool passed = true;
  for (int r = 0; r < AREAS; r++) {
    z[r] = compare_z(coarse[r], fine[r]);
    passed &= fabs(z[r]) < limit;
  }
  double error = sqrt(coarse[0].se2 + fine[0].se2) / fine[0].mean;
  report_line(report, passed ? PASSED : FAILED,
              "%-24s %-8s %9.6f %9.6f %8.5f +- %.5f z %.2f, of quadrants %.2f %.2f %.2f %.2f %6.1f",
              name, "photons", coarse[0].mean, fine[0].mean, coarse[0].mean / fine[0].mean, error,
              z[0], z[1], z[2], z[3], z[4], subject_seconds() - begin);
}

static void check_volumetric(const struct options *options, struct report *report,
                             struct arena arena) {
  static const char name[] = "volumetric-caustic";
  struct problem problem = {0};
  struct subject *subject = arena_new(&arena, struct subject, 1);
  if (!load(options, name, &arena, subject, &problem))
    refused(report, name, &problem);
  else
    report_line(report, PASSED, "%-24s is read; path tracing does not resolve it", name);
}

void others_check(const struct options *options, struct report *report) {
  report_heading(report,
                 "scenes by others: means within %.0f %% of pbrt-v4's; water by photons of "
                 "two radii, |z| < %.0f",
                 100 * margin, limit);
  struct arena arena = arena_reserve();
  for (size_t s = 0; s < sizeof with_reference / sizeof *with_reference; s++)
    if (selected(options, with_reference[s].name))
      check_with_reference(options, report, &with_reference[s], arena);
  if (selected(options, "water-caustic")) check_water(options, report, arena);
  if (selected(options, "volumetric-caustic")) check_volumetric(options, report, arena);
  arena_release(arena);
}
