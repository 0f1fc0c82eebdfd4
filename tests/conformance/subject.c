#define _GNU_SOURCE // clock_gettime
#include "tests/conformance/subject.h"

#include "numeric/rng.h"
#include "run/interrupt.h"
#include "run/render.h"

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

uint64_t subject_seed(const struct subject *subject, const char *purpose, int number,
                      struct arena scratch) {
  return rng_hash_name(
      arena_format(&scratch, "conformance %s %s %d", subject->name, purpose, number));
}

void subject_stop_if_interrupted(void) {
  if (interrupt_signal()) exit(128 + interrupt_signal());
}

// ---- path tracing ----

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
    subject_stop_if_interrupted();
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
    batches.image[k] = render_one(subject, subject_seed(subject, purpose, k, scratch), samples_each,
                                  arena, scratch);
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
