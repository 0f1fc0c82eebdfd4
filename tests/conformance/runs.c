#include "tests/conformance/runs.h"

#include "run/interrupt.h"
#include "walk/eye.h"

#include <assert.h>
#include <math.h>

// ---- regions ----

static bool sees_mirrored(const struct eye_point *point) { return point->hit && point->vertex > 0; }

// The pixels (of the whole film) of which any of some eye paths found a surface by way of a delta
// lobe, and their neighbours: an object's rim may cover less of a pixel than the paths find.
static bool *find_mirrored(const struct subject *subject, struct arena *arena) {
  enum { LOOKS = 16 };
  const struct measurement *measure = &subject->measure;
  int width = subject->scene.camera.width, height = subject->scene.camera.height;
  bool *mirrored = arena_new(arena, bool, (long)width *height);
  if (!measure->features.random_eye) return mirrored; // nor any delta lobe
  struct arena scratch = arena_reserve(), kept = scratch;
  struct eye_point *point = arena_new(&scratch, struct eye_point, measure->n_points);
  struct walk *walk = walk_new(&subject->scene, measure->bvh, measure->features, &scratch);
  uint64_t seed = subject_seed(subject, "mirrored", 0, scratch);
  walk->key = rng_key(seed, 0, RNG_EYE);
  for (uint64_t i = 1; i <= LOOKS; i++) {
    walk_begin(walk, seed, 0, i);
    eye_trace(walk, measure->pixel, measure->n_points, measure->footprint, measure->depth, point);
    for (int j = 0; j < measure->n_points; j++) {
      if (!sees_mirrored(&point[j])) continue;
      struct pixel at = measure->pixel[j];
      for (int y = at.y - 1; y <= at.y + 1; y++)
        for (int x = at.x - 1; x <= at.x + 1; x++)
          if (x >= 0 && y >= 0 && x < width && y < height) mirrored[y * width + x] = true;
    }
  }
  arena_release(kept);
  return mirrored;
}

struct regions regions_of(const struct subject *subject, struct arena *arena) {
  int n = subject->measure.n_points, width = subject->scene.camera.width;
  struct image film = {.width = width, .height = subject->scene.camera.height};
  const bool *mirrored = find_mirrored(subject, arena);
  struct regions regions = {.in = arena_new(arena, uint16_t, n)};
  for (int j = 0; j < n; j++) {
    struct pixel at = subject->measure.pixel[j];
    struct region pixel = {at.x, at.y, 1, 1};
    unsigned in = 1;
    for (int q = 0; q < 4; q++)
      if (region_overlap(pixel, region_quadrant(&film, q))) in |= 2u << q;
    in |= mirrored[at.y * width + at.x] ? 1u << MIRRORED : in << UNMIRRORED;
    regions.in[j] = (uint16_t)in;
    for (int r = 0; r < REGIONS; r++) regions.pixels[r] += in >> r & 1;
  }
  return regions;
}

static void add_regions(const struct regions *regions, const struct measurement *measure,
                        const double *frame, double weight, double sum[REGIONS]) {
  int channels = measure->features.n_channels;
  for (int j = 0; j < measure->n_points; j++) {
    double value = 0;
    for (int c = 0; c < channels; c++) value += frame[(long)j * channels + c];
    for (int r = 0; r < REGIONS; r++)
      if (regions->in[j] >> r & 1) sum[r] += weight * value / channels / regions->pixels[r];
  }
}

// ---- runs ----

// Lagrange's weights at 0 of r, r/2, r/4; without a radius there is nothing to extrapolate.
static const double extrapolation[3] = {1.0 / 3, -2, 8.0 / 3}, as_it_is[1] = {1};

enum { HIT_POINTS = 2 }; // of integrators that draw them once: more than one, for a pixel's mean

static struct cell cell_of(const struct subject *subject, const struct runs_plan *plan,
                           double part) {
  struct cell cell = {.integrator = plan->type,
                      .kernel = kernel_find("epanechnikov"),
                      .alpha = 1,
                      .radius = part * plan->radius,
                      .radius_volume = part * plan->volume,
                      .reference_radius = &reference_radii[0],
                      .photons = plan->n_emitted,
                      .iterations = plan->iterations,
                      .hit_points = HIT_POINTS,
                      .footprint = subject->measure.footprint,
                      .direct = plan->direct,
                      .depth = subject->measure.depth};
  cell.law = cell_default_law(&cell);
  return cell;
}

static int count_estimators(const struct runs_plan *plan) { return plan->type->photons ? 3 : 1; }

static bool make_estimators(const struct subject *subject, const struct runs_plan *plan,
                            struct estimator estimator[3], struct problem *problem) {
  for (int e = 0; e < count_estimators(plan); e++) {
    struct cell cell = cell_of(subject, plan, ldexp(1, -e));
    if (!plan_estimator(&cell, &subject->scene, &estimator[e], problem)) return false;
  }
  return true;
}

bool runs_accepted(const struct subject *subject, const struct runs_plan *plan,
                   struct problem *problem) {
  struct estimator estimator[3];
  return make_estimators(subject, plan, estimator, problem);
}

static struct measurement measurement_of(const struct subject *subject,
                                         const struct runs_plan *plan,
                                         struct estimator estimator[3], struct arena scratch) {
  struct problem problem = {0};
  struct cell cell = cell_of(subject, plan, 1);
  bool accepted = make_estimators(subject, plan, estimator, &problem);
  assert(accepted);
  struct measurement measure = plan_measurement(&cell, &subject->scene, subject->measure.bvh, 0);
  measure.pixel = subject->measure.pixel;
  measure.n_points = subject->measure.n_points;
  measure.seed = subject_seed(subject, plan->purpose, 0, scratch);
  measure.estimator = estimator;
  measure.n_estimators = count_estimators(plan);
  return measure;
}

static void run_once(const struct measurement *measure, const struct regions *regions,
                     const struct runs_plan *plan, void *state, double *frame,
                     double sum[REGIONS]) {
  const double *weight = measure->n_estimators == 3 ? extrapolation : as_it_is;
  long size = (long)measure->n_points * measure->features.n_channels;
  for (int r = 0; r < REGIONS; r++) sum[r] = 0;
  for (uint64_t i = 1; i <= plan->iterations && !interrupt_signal(); i++) {
    plan->type->step(state, i, frame);
    for (int e = 0; e < measure->n_estimators; e++)
      add_regions(regions, measure, frame + e * size, weight[e] / (double)plan->iterations, sum);
  }
}

void runs_measure(const struct subject *subject, const struct regions *regions,
                  const struct runs_plan *plan, struct arena scratch,
                  struct estimate out[REGIONS]) {
  struct estimator estimator[3];
  struct measurement measure = measurement_of(subject, plan, estimator, scratch);
  long size = (long)measure.n_estimators * measure.n_points * measure.features.n_channels;
  double *value = arena_new(&scratch, double, (long)REGIONS * plan->runs);
  interrupt_install();
#pragma omp parallel num_threads(plan_threads(&(struct run_options){0}))
  {
    struct arena own = arena_reserve(), kept = own;
    void *state = plan->type->create(&measure, &own);
    double *frame = arena_new(&own, double, size), sum[REGIONS];
#pragma omp for schedule(dynamic, 1)
    for (int k = 0; k < plan->runs; k++) {
      plan->type->begin(state, (uint64_t)(plan->first + k) + 1);
      run_once(&measure, regions, plan, state, frame, sum);
      for (int r = 0; r < REGIONS; r++) value[r * plan->runs + k] = sum[r];
    }
    arena_release(kept);
  }
  subject_stop_if_interrupted();
  for (int r = 0; r < REGIONS; r++) out[r] = estimate_of(value + r * plan->runs, plan->runs);
}
