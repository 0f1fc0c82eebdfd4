// All integrators agree: each row of integrator_types against the mean of all others, on the same
// depth and pixels. Photons find direct light themselves or leave it to next-event estimation, in
// turn from scene to scene and from row to row. A new row is tested as it is.
//
// z is Welch's t of a region's means as a normal deviate, from independent runs, at a family-wise
// level of 0.01 over all scenes, integrators and regions (runs.h). Others are weighted by what
// their first runs promised; who is blind to what mirrors and clear glass show is compared, and
// compares, on the other pixels.
//
// Full: FIRST runs, and as many more as they ask for so that the image is known to 0.20 % (Stein
// 1945). Then 2 % more of it are found as good as certainly: (4.8 + 3.8) sqrt(1 + 1/3) 0.20 % =
// 1.99 %, t's quantile for the level, the normal one for 0.9999, and the mean of three others or
// more. `finds` says so of each. Only where `most` runs do not suffice may it be more: path tracing
// of the torus in glass, which a path from the eye leaves for the light once in a thousand times,
// finds 11 %.
// Planted: 2 % more light in each region in turn, which must be rejected where it is certain to be.
//
// Glance: GLANCE small runs. They find 3 to 30 % of the image of a room, more where most photons
// miss it: light lost or counted twice.
#include "tests/conformance/parts.h"

#include <assert.h>
#include <math.h>

static const double family_level = 0.01, plant = 0.02, certain = 0.9999, wanted = 0.002;

enum { FIRST = 48, GLANCE = 8, ITERATIONS = 2 };

// The conformance scenes are a room of two units seen at 64 pixels from 3.4 in front of its middle,
// where a pixel is 2 * 3.4 * tan(19 degrees) / 64 = 0.037 wide; the largest radius is two of these,
// half of the smallest sphere's. Of a cubic term m3 r^3 of the bias, m3 r^3 / 8 remains, and what
// is finer than the smallest radius is not resolved: lamps hang 0.01 under the ceiling. Of the
// torus it is four pixels, a fifth of the radius of its tube; of two it takes twice as long.
struct setup {
  const char *name, *path;
  bool in_full; // our own scenes: in full or in the glance
  double radius;
  uint64_t n_emitted; // of an iteration
  int most;           // runs
  double volume;      // the largest radius in media; 0: radius
  int every;          // so manyth row and column of the film alone are measured; 0: all
};
static const struct setup in_room = {.radius = 0.073, .n_emitted = 12000, .most = 2000};
static const struct setup own_scenes[] = {
    {"our-cornell-box", "scenes/cornell-box.pbrt", false, 0.073, 12000, 2000, 0, 0},
    {"torus-in-glass", "scenes/torus-in-glass.pbrt", true, 0.024, 65000, 150, 0, 0},
};

// Fog around everything, where photon beams all cross every pixel, and photons are so few in the
// smallest ball that they are known to one or two percent after these runs.
static const struct setup in_fog = {
    .radius = 0.073, .n_emitted = 12000, .most = 150, .volume = 0.2, .every = 4};

// An integrator and how it finds direct light.
struct member {
  struct runs_plan plan;
  bool may_miss; // it was not given the runs it asked for
  double weight, seconds;
  struct estimate region[REGIONS];
};
enum { MEMBERS = 32 };

struct members {
  int n;
  struct member of[MEMBERS];
};

static const char *direct_of(const struct member *member) {
  if (!member->plan.type->photons) return "";
  return member->plan.direct == DIRECT_NEE ? "nee" : "photons";
}

static bool is_blind(const struct member *member) { return member->plan.type->blind_to_mirrored; }

// The image's number among the regions.
static int image_of(const struct member *member) { return is_blind(member) ? UNMIRRORED : 0; }

// ---- who takes part ----

// Whether the integrator measures the scene. What moves must be refused by those whose eye points
// stay; what an integrator does not accept is its own affair.
static bool takes(struct report *report, const struct subject *subject,
                  const struct runs_plan *plan) {
  const struct integrator_type *type = plan->type;
  struct problem why = {0}, ignored = {0};
  bool moves = type->one_eye_pass && subject->measure.features.motion;
  if (runs_accepted(subject, plan, &why)) {
    if (moves)
      report_line(report, FAILED, "%-24s %-14s takes what moves", subject->name, type->name);
    return !moves;
  }
  bool itself =
      type->accepts && !type->accepts(&subject->scene, subject->measure.footprint, &ignored);
  enum verdict verdict = moves ? PASSED : itself ? SKIPPED : FAILED;
  report_line(report, verdict, "%-24s %-14s refuses: %s", subject->name, type->name, why.text);
  return false;
}

static void find_members(const struct options *options, struct report *report,
                         const struct subject *subject, const struct setup *setup, int scene,
                         struct members *members) {
  int either = scene; // of the rows so far, those that find direct light in both ways
  *members = (struct members){0};
  for (int k = 0; integrator_types[k]; k++) {
    struct runs_plan plan = {.type = integrator_types[k],
                             .radius = setup->radius,
                             .volume = setup->volume,
                             .n_emitted = options->full ? setup->n_emitted : setup->n_emitted / 3,
                             .iterations = ITERATIONS};
    if (!takes(report, subject, &plan)) continue;
    assert(members->n < MEMBERS);
    if (plan.type->photons && !plan.type->only_photons)
      plan.direct = either++ % 2 ? DIRECT_NEE : DIRECT_PHOTONS;
    members->of[members->n++] = (struct member){.plan = plan, .weight = 1};
  }
}

// At most, by all.
static long count_tests(void) {
  long rows = 0, scenes = sizeof own_scenes / sizeof *own_scenes;
  while (integrator_types[rows]) rows++;
  for (const struct conformance_scene *row = conformance_scenes; row->name; row++) scenes++;
  return scenes * rows * (AREAS + 1);
}

// ---- runs ----

// Runs that bring the image's error to what is wanted; one more at a time would say nothing of its
// variance.
static int count_runs(struct member *member, int most) {
  struct estimate image = member->region[image_of(member)];
  double needed = FIRST * image.se2 / (image.mean * image.mean * wanted * wanted);
  member->may_miss = needed > most;
  if (member->may_miss) needed = most;
  return needed > FIRST ? (int)needed + 2 : FIRST;
}

static void go_on(const struct subject *subject, const struct regions *regions,
                  struct member *member, int most, struct arena scratch) {
  struct estimate more[REGIONS];
  int all = count_runs(member, most);
  member->weight = all / member->region[image_of(member)].se2;
  member->plan.first = FIRST;
  member->plan.runs = all - FIRST;
  if (all == FIRST) return;
  runs_measure(subject, regions, &member->plan, scratch, more);
  for (int r = 0; r < REGIONS; r++)
    member->region[r] = estimate_extended(member->region[r], FIRST, more[r].mean, all - FIRST);
}

static void measure(const struct options *options, const struct subject *subject,
                    const struct regions *regions, struct member *member, int most,
                    struct arena scratch) {
  double begin = subject_seconds();
  struct runs_plan *plan = &member->plan;
  plan->purpose = arena_format(&scratch, "agree %s %s", plan->type->name, direct_of(member));
  plan->runs = options->full ? FIRST : GLANCE;
  runs_measure(subject, regions, plan, scratch, member->region);
  if (options->full) go_on(subject, regions, member, most, scratch);
  member->seconds = subject_seconds() - begin;
}

// ---- the tests ----

struct agreement {
  double ratio, error; // of the image, relative
  double finds;        // the least relative error of the image that is as good as certainly found
  double z[AREAS + 1]; // of the image, the quadrants and what is mirrored
  int planted, found;
};

static struct estimate others_of(const struct members *members, const struct member *self,
                                 const struct regions *regions, int region) {
  struct estimate part[MEMBERS];
  double weight[MEMBERS];
  bool blind_too = !regions->pixels[MIRRORED] || (region >= UNMIRRORED && region < MIRRORED);
  for (int k = 0; k < members->n; k++) {
    const struct member *other = &members->of[k];
    weight[k] = other != self && (blind_too || !is_blind(other)) ? other->weight : 0;
    part[k] = other->region[region];
  }
  return estimate_weighted(part, weight, members->n);
}

static void judge_region(struct estimate own, struct estimate others, double threshold, int at,
                         struct agreement *out) {
  double finds = compare_smallest(own, others, threshold, certain) / others.mean;
  out->z[at] = compare_z(own, others);
  if (at == 0) {
    out->ratio = own.mean / others.mean;
    out->error = sqrt(own.se2 + others.se2) / others.mean;
    out->finds = finds;
  }
  if (!(finds <= plant)) return;
  own.mean *= 1 + plant;
  own.se2 *= (1 + plant) * (1 + plant);
  out->planted++;
  out->found += fabs(compare_z(own, others)) > threshold;
}

static struct agreement judge(const struct members *members, const struct member *self,
                              const struct regions *regions, double threshold) {
  struct agreement out = {0};
  for (int k = 0; k <= AREAS; k++) {
    int r = k < AREAS ? image_of(self) + k : MIRRORED;
    if (!regions->pixels[r] || (r == MIRRORED && is_blind(self))) continue;
    judge_region(self->region[r], others_of(members, self, regions, r), threshold, k, &out);
  }
  return out;
}

static void check_member(const struct options *options, struct report *report, const char *name,
                         const struct member *member, const struct agreement *is,
                         double threshold) {
  bool passed = is->found == is->planted;
  for (int k = 0; k <= AREAS; k++) passed &= fabs(is->z[k]) < threshold;
  if (options->full && !member->may_miss) passed &= is->finds <= plant;
  report_line(report, passed ? PASSED : FAILED,
              "%-24s %-14s %-7s %5d %8.5f %6.2f %% %6.2f %% %6.2f %6.2f %6.2f %6.2f %6.2f %6.2f "
              "%4d/%d %6.1f",
              name, member->plan.type->name, direct_of(member),
              member->plan.first + member->plan.runs, is->ratio, 100 * is->error, 100 * is->finds,
              is->z[0], is->z[1], is->z[2], is->z[3], is->z[4], is->z[5], is->found, is->planted,
              member->seconds);
}

// Every so manyth pixel of the film, along both axes.
static void thin_out(struct subject *subject, int every, struct arena *arena) {
  struct measurement *measure = &subject->measure;
  struct pixel *kept = arena_new(arena, struct pixel, measure->n_points);
  int n = 0;
  for (int j = 0; j < measure->n_points; j++)
    if (measure->pixel[j].x % every == every / 2 && measure->pixel[j].y % every == every / 2)
      kept[n++] = measure->pixel[j];
  measure->pixel = kept;
  measure->n_points = n;
}

static void check_scene(const struct options *options, struct report *report,
                        const struct setup *setup, int scene, double threshold,
                        struct arena arena) {
  struct problem problem = {0};
  struct subject *subject = arena_new(&arena, struct subject, 1);
  struct members *members = arena_new(&arena, struct members, 1);
  if (!subject_load(setup->name, setup->path, &arena, subject, &problem)) {
    refused(report, setup->name, &problem);
    return;
  }
  subject->measure.footprint = true; // light tracing knows no centre of a pixel
  if (setup->every) thin_out(subject, setup->every, &arena);
  struct regions regions = regions_of(subject, &arena);
  find_members(options, report, subject, setup, scene, members);
  for (int k = 0; k < members->n; k++)
    measure(options, subject, &regions, &members->of[k], setup->most, arena);
  for (int k = 0; k < members->n; k++) {
    struct agreement is = judge(members, &members->of[k], &regions, threshold);
    check_member(options, report, setup->name, &members->of[k], &is, threshold);
  }
}

static void check_setup(const struct options *options, struct report *report, struct setup setup,
                        int scene, double threshold) {
  struct arena arena = arena_reserve(), kept = arena;
  if (!setup.path)
    setup.path = arena_format(&arena, "%s/%s.pbrt", options->conformance, setup.name);
  if (selected(options, setup.name)) check_scene(options, report, &setup, scene, threshold, arena);
  arena_release(kept);
}

void agree_check(const struct options *options, struct report *report, bool conformance) {
  long tests = count_tests();
  double threshold = compare_threshold(family_level, tests);
  report_heading(
      report, "each integrator at radius 0 against the mean of the others: |z| < %.2f, %ld tests",
      threshold, tests);
  report_heading(report, "%-24s %-14s %-7s %5s %8s %8s %8s %6s %27s %6s %6s %6s", "scene",
                 "integrator", "direct", "runs", "ratio", "error", "finds", "z", "of quadrants",
                 "mirr'd", "plants", "s");
  for (int s = 0; conformance && conformance_scenes[s].name; s++) {
    struct setup setup = conformance_scenes[s].fog ? in_fog : in_room;
    setup.name = conformance_scenes[s].name;
    if (options->full || !conformance_scenes[s].fog)
      check_setup(options, report, setup, s, threshold);
  }
  for (size_t s = 0; s < sizeof own_scenes / sizeof *own_scenes; s++)
    if (own_scenes[s].in_full == options->full)
      check_setup(options, report, own_scenes[s], (int)s, threshold);
}
