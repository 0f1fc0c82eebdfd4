#include "tests/bench/measure.h"

#include "base/problem.h"
#include "density/law.h"

#include <string.h>

struct measurement measure_of(const struct bench_scene *scene, bool nee) {
  static struct estimator estimator = {.alpha = 2.0 / 3, .r1 = 0.05};
  estimator.kernel = kernel_find("box");
  estimator.law = law_find("knaus-zwicker");
  estimator.reference = &reference_radii[0];
  return (struct measurement){.scene = &scene->scene,
                              .bvh = scene->bvh,
                              .features = scene_features(&scene->scene),
                              .pixel = scene->pixel,
                              .n_points = scene->n_pixels,
                              .n_replicas = 1,
                              .hit_points = 1,
                              .footprint = true,
                              .nee = nee,
                              .depth = DEPTH,
                              .n_emitted = PHOTONS,
                              .seed = 1,
                              .estimator = &estimator,
                              .n_estimators = 1,
                              .threads = 1};
}

void measure_set_law(struct measurement *measure, const struct integrator_type *integrator,
                     struct arena *arena) {
  if (!integrator->law) return;
  struct estimator *own = arena_new(arena, struct estimator, measure->n_estimators);
  memcpy(own, measure->estimator, (size_t)measure->n_estimators * sizeof *own);
  for (int e = 0; e < measure->n_estimators; e++) own[e].law = law_find(integrator->law);
  measure->estimator = own;
}

struct steps *steps_new(const char *integrator, struct measurement measure, struct arena *arena) {
  struct steps *steps = arena_new(arena, struct steps, 1);
  *steps = (struct steps){.integrator = integrator_find(integrator), .next = 1, .each = 1};
  measure_set_law(&measure, steps->integrator, arena);
  steps->measure = measure;
  steps->size = (long)measure.n_points * measure.features.n_channels * measure.n_estimators;
  steps->frame = arena_new(arena, double, steps->size);
  struct arena *own = arena_new(arena, struct arena, 1);
  *own = arena_reserve();
  steps->state = steps->integrator->create(&steps->measure, own);
  steps->integrator->begin(steps->state, 1);
  return steps;
}

void steps_run(void *data, int repetition) {
  struct steps *steps = data;
  (void)repetition;
  for (int k = 0; k < steps->each; k++)
    steps->integrator->step(steps->state, steps->next++, steps->frame);
}

uint64_t steps_hash(const void *data) {
  const struct steps *steps = data;
  return bench_hash(steps->frame, (size_t)steps->size * sizeof *steps->frame);
}

static uint64_t hash_of(const struct steps *steps, void *state, uint64_t i) {
  steps->integrator->step(state, i, steps->frame);
  return steps_hash(steps);
}

// The hashes of iterations 1 and 2, from a beginning.
static void hash_two(const struct steps *steps, int threads, bool backward, uint64_t hash[2]) {
  struct arena arena = arena_reserve(), start = arena;
  struct measurement measure = steps->measure;
  measure.threads = threads;
  void *state = steps->integrator->create(&measure, &arena);
  steps->integrator->begin(state, 1);
  for (int k = 0; k < 2; k++) {
    int i = backward ? 1 - k : k;
    hash[i] = hash_of(steps, state, (uint64_t)i + 1);
  }
  arena_release(start);
}

void steps_check(const struct steps *steps, int threads, const char *name) {
  uint64_t one[2], other[2];
  hash_two(steps, 1, false, one);
  hash_two(steps, threads, steps->integrator->independent, other);
  bench_check(one[0] == other[0] && one[1] == other[1], "frames computed in two ways differ", name);
}
