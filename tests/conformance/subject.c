#define _GNU_SOURCE // clock_gettime
#include "tests/conformance/subject.h"

#include "numeric/rng.h"
#include "run/interrupt.h"
#include "run/render.h"

#include <omp.h>
#include <stdlib.h>
#include <time.h>

double subject_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

bool subject_load(const char *name, const char *path, struct arena *arena, struct subject *subject,
                  struct problem *problem) {
  *subject = (struct subject){.name = name};
  if (!scene_read(path, arena, &subject->scene, problem)) return false;
  const struct scene *scene = &subject->scene;
  struct cell cell = {.footprint = !scene->settings.centre,
                      .direct = DIRECT_PHOTONS,
                      .depth = scene->settings.max_depth};
  struct bvh *bvh = bvh_build(scene, (struct bvh_options){0}, arena);
  subject->measure = plan_measurement(&cell, scene, bvh, 0);
  subject->measure.pixel = plan_film(scene, &subject->measure.n_points, arena, problem);
  return subject->measure.pixel != NULL;
}

static uint64_t seed_of(const struct subject *subject, const char *purpose, int number,
                        struct arena scratch) {
  return rng_hash_name(
      arena_format(&scratch, "conformance %s %s %d", subject->name, purpose, number));
}

// ---- path tracing ----

static void stop_if_interrupted(void) {
  if (interrupt_signal()) exit(128 + interrupt_signal());
}

// Keeps R, G and B.
static struct image render_one(const struct subject *subject, uint64_t seed, uint64_t samples,
                               struct arena *arena, struct arena scratch) {
  static const char *const names[] = {"R", "G", "B"};
  struct estimator unused = {
      .kernel = kernel_find("box"), .law = law_find("knaus-zwicker"), .alpha = 1, .r1 = 1};
  struct measurement measure = subject->measure;
  struct image image, kept;
  measure.seed = seed;
  measure.estimator = &unused;
  measure.n_estimators = 1;
  if (!render_image(integrator_find("path"), &measure, samples, (struct run_options){.quiet = true},
                    &scratch, &image))
    stop_if_interrupted();
  kept = image_new(image.width, image.height, 3, names, arena);
  for (int c = 0; c < 3; c++)
    for (int j = 0; j < image.width * image.height; j++) kept.plane[c][j] = image.plane[c][j];
  return kept;
}

struct batches batches_render(const struct subject *subject, const char *purpose, int n,
                              uint64_t samples_each, struct arena *arena) {
  double begin = subject_seconds();
  struct batches batches = {.n = n, .samples = samples_each * (uint64_t)n};
  struct arena scratch = arena_reserve();
  batches.image = arena_new(arena, struct image, n);
  for (int k = 0; k < n; k++)
    batches.image[k] =
        render_one(subject, seed_of(subject, purpose, k, scratch), samples_each, arena, scratch);
  arena_release(scratch);
  batches.seconds = subject_seconds() - begin;
  return batches;
}

struct image batches_mean(const struct batches *batches, struct arena *arena) {
  const struct image *first = &batches->image[0];
  struct image mean = image_new(first->width, first->height, 3, first->name, arena);
  for (int c = 0; c < 3; c++)
    for (int j = 0; j < mean.width * mean.height; j++) {
      double sum = 0;
      for (int k = 0; k < batches->n; k++) sum += (double)batches->image[k].plane[c][j];
      mean.plane[c][j] = (float)(sum / batches->n);
    }
  return mean;
}

struct estimate batches_region(const struct batches *batches, struct region region, int first,
                               int step, struct arena scratch) {
  double *value = arena_new(&scratch, double, batches->n);
  int n = 0;
  for (int k = first; k < batches->n; k += step)
    value[n++] = region_mean(&batches->image[k], region);
  return estimate_of(value, n);
}

// ---- photons ----

struct region photon_region(const struct subject *subject, int number) {
  struct image film = {.width = subject->scene.camera.width,
                       .height = subject->scene.camera.height};
  return number ? region_quadrant(&film, number - 1)
                : (struct region){0, 0, film.width, film.height};
}

// Adds the means over the regions of one estimator's part of a frame.
static void add_regions(const struct subject *subject, const double *frame, double weight,
                        double sum[PHOTON_REGIONS]) {
  int channels = subject->measure.features.n_channels;
  for (int r = 0; r < PHOTON_REGIONS; r++) {
    struct region at = photon_region(subject, r);
    double total = 0;
    for (int y = at.y; y < at.y + at.height; y++) {
      const double *row = frame + ((long)y * subject->scene.camera.width + at.x) * channels;
      for (int k = 0; k < at.width * channels; k++) total += row[k];
    }
    sum[r] += weight * total / channels / at.width / at.height;
  }
}

// Lagrange's weights at 0 of r, r/2, r/4.
static const double extrapolation[3] = {1.0 / 3, -2, 8.0 / 3};

static void run_once(const struct subject *subject, const struct measurement *measure, void *state,
                     const struct photon_plan *plan, double *frame, double sum[PHOTON_REGIONS]) {
  long size = (long)measure->n_points * measure->features.n_channels;
  for (int r = 0; r < PHOTON_REGIONS; r++) sum[r] = 0;
  for (uint64_t i = 1; i <= plan->iterations && !interrupt_signal(); i++) {
    integrator_find("probabilistic")->step(state, i, frame);
    for (int e = 0; e < 3; e++)
      add_regions(subject, frame + e * size, extrapolation[e] / (double)plan->iterations, sum);
  }
}

void photons_extrapolate(const struct subject *subject, struct photon_plan plan,
                         struct arena scratch, struct estimate out[PHOTON_REGIONS]) {
  const struct integrator_type *probabilistic = integrator_find("probabilistic");
  struct estimator estimator[3];
  for (int e = 0; e < 3; e++) // alpha 1: the radius stays
    estimator[e] = (struct estimator){.kernel = kernel_find("epanechnikov"),
                                      .law = law_find("knaus-zwicker"),
                                      .alpha = 1,
                                      .r1 = ldexp(plan.radius, -e)};
  struct measurement measure = subject->measure;
  measure.n_emitted = plan.n_emitted;
  measure.seed = seed_of(subject, plan.purpose, 0, scratch);
  measure.estimator = estimator;
  measure.n_estimators = 3;
  long size = 3L * measure.n_points * measure.features.n_channels;
  double *value = arena_new(&scratch, double, PHOTON_REGIONS *plan.runs);
  interrupt_install();
#pragma omp parallel num_threads(plan_threads(&(struct run_options){0}))
  {
    struct arena own = arena_reserve(), kept = own;
    void *state = probabilistic->create(&measure, &own);
    double *frame = arena_new(&own, double, size), sum[PHOTON_REGIONS];
#pragma omp for schedule(dynamic, 1)
    for (int k = 0; k < plan.runs; k++) {
      probabilistic->begin(state, (uint64_t)k + 1);
      run_once(subject, &measure, state, &plan, frame, sum);
      for (int r = 0; r < PHOTON_REGIONS; r++) value[r * plan.runs + k] = sum[r];
    }
    arena_release(kept);
  }
  stop_if_interrupted();
  for (int r = 0; r < PHOTON_REGIONS; r++) out[r] = estimate_of(value + r * plan.runs, plan.runs);
}
