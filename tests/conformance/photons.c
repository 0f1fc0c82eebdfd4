// Photons extrapolated to radius zero against path tracing, on the same depth and pixel footprint:
// the mean of the image and of its quadrants, each |z| < 4.
// All these scenes are a room of two units seen at 64 pixels from 3.4 in front of its middle, where
// a pixel is 2 * 3.4 * tan(19 degrees) / 64 = 0.037 wide; the largest radius is two of these, half
// of the smallest sphere's. Of a cubic term m3 r^3 of the bias, m3 r^3 / 8 remains,
// and what is finer than the smallest radius is not resolved: lamps hang 0.01 under the ceiling.
#include "tests/conformance/parts.h"

#include <math.h>

static const double radius = 0.073, limit = 4;

static struct photon_plan plan_of(const struct options *options) {
  struct photon_plan plan = {.radius = radius, .purpose = "photons"};
  plan.n_emitted = options->full ? 25000 : 10000;
  plan.iterations = options->full ? 16 : 2;
  plan.runs = options->full ? 32 : 16;
  return plan;
}

static void check_scene(const struct options *options, struct report *report,
                        const struct conformance_scene *row, const struct path_result *paths,
                        struct arena arena) {
  struct problem problem = {0};
  struct subject *subject = arena_new(&arena, struct subject, 1);
  const char *path = arena_format(&arena, "%s/%s.pbrt", options->conformance, row->name);
  if (!subject_load(row->name, path, &arena, subject, &problem)) return; // reported before
  struct estimate m0[PHOTON_REGIONS];
  double z[PHOTON_REGIONS], begin = subject_seconds();
  photons_extrapolate(subject, plan_of(options), arena, m0);
  bool passed = true;
  for (int r = 0; r < PHOTON_REGIONS; r++) {
    z[r] = compare_z(m0[r], paths->region[r]);
    passed &= fabs(z[r]) < limit;
  }
  report_line(report, passed ? PASSED : FAILED,
              "%-24s %9.6f %9.6f %8.5f %7.2f %% %6.2f %6.2f %6.2f %6.2f %6.2f %6.1f", row->name,
              m0[0].mean, paths->region[0].mean, m0[0].mean / paths->region[0].mean,
              100 * sqrt(m0[0].se2 + paths->region[0].se2) / paths->region[0].mean, z[0], z[1],
              z[2], z[3], z[4], subject_seconds() - begin);
}

void photons_check(const struct options *options, struct report *report,
                   const struct path_result *result) {
  report_heading(report, "probabilistic at radius 0 against path: |z| < %.0f, image and quadrants",
                 limit);
  report_heading(report, "%-24s %9s %9s %8s %9s %6s %27s %6s", "scene", "photons", "path", "ratio",
                 "error", "z", "of quadrants", "s");
  for (int s = 0; conformance_scenes[s].name; s++) {
    if (!result[s].rendered) continue;
    struct arena arena = arena_reserve();
    check_scene(options, report, &conformance_scenes[s], &result[s], arena);
    arena_release(arena);
  }
}
