#include "run/reference.h"

#include "numeric/rng.h"
#include "numeric/sum.h"
#include "run/interrupt.h"
#include "run/progress.h"
#include "run/reference_cache.h"

#include <string.h>

enum {
  SAMPLES_PER_STEP = 4096, // shared by the probes: one full batch of walks
  STEPS_PER_UNIT = 16,     // what a thread takes at a time
  UNITS_PER_BLOCK = 16,    // after each block the error is looked at and the state kept
  STEPS_PER_BLOCK = STEPS_PER_UNIT * UNITS_PER_BLOCK, // a power of two, see moments_tree
};

struct reference {
  const struct group_plan *plan;
  double target_se;
  const struct integrator_type *integrator;
  struct measurement measure;
  int replicas;
  struct moments_tree tree; // over blocks, in their order
};

static struct reference reference_of(const struct group_plan *plan, const struct cell *cell,
                                     struct arena *arena) {
  struct reference reference = {
      .plan = plan, .target_se = cell->reference_se, .measure = plan->measure};
  reference.integrator = integrator_find(cell->reference_integrator);
  reference.replicas = plan->n_probes < SAMPLES_PER_STEP ? SAMPLES_PER_STEP / plan->n_probes : 1;
  int n = reference.replicas * plan->n_probes;
  struct pixel *pixel = arena_new(arena, struct pixel, n);
  for (int j = 0; j < n; j++) pixel[j] = plan->probe_pixel[j / reference.replicas];
  reference.measure.pixel = pixel;
  reference.measure.n_points = n;
  reference.measure.n_replicas = reference.replicas;
  reference.measure.n_estimators = 1;
  reference.measure.seed = rng_hash_name("reference");
  return reference;
}

// mean[step * n_probes + p] of the unit's steps.
static void compute_unit(const struct reference *reference, uint64_t unit, double *mean,
                         struct arena scratch) {
  int n_channels = reference->measure.features.n_channels, n_probes = reference->plan->n_probes;
  double *frame = arena_new(&scratch, double, n_channels *(long)reference->measure.n_points);
  double *value = arena_new(&scratch, double, reference->replicas);
  void *state = reference->integrator->create(&reference->measure, &scratch);
  reference->integrator->begin(state, 0); // runs count from 1: no seed shares these numbers
  for (uint64_t step = 0; step < STEPS_PER_UNIT; step++) {
    reference->integrator->step(state, unit * STEPS_PER_UNIT + step + 1, frame);
    for (int p = 0; p < n_probes; p++) {
      const double *at = frame + (long)p * reference->replicas * n_channels;
      for (int k = 0; k < reference->replicas; k++)
        value[k] = luminance(at + (long)k * n_channels, n_channels);
      mean[step * (uint64_t)n_probes + (uint64_t)p] =
          sum_array(value, reference->replicas) / reference->replicas;
    }
  }
}

// Moments over the steps of a block.
static void compute_block(const struct reference *reference, uint64_t block, int threads,
                          struct moments *root, struct arena scratch) {
  int n_probes = reference->plan->n_probes;
  long size = (long)STEPS_PER_UNIT * n_probes;
  double *mean = arena_new(&scratch, double, UNITS_PER_BLOCK *size);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (uint64_t unit = 0; unit < UNITS_PER_BLOCK; unit++) {
    struct arena own = arena_reserve();
    if (!interrupt_signal())
      compute_unit(reference, block * UNITS_PER_BLOCK + unit, mean + (long)unit * size, own);
    arena_release(own);
  }
  struct moments_tree tree = moments_tree_new(n_probes, &scratch);
  struct moments *leaf = arena_new(&scratch, struct moments, n_probes);
  for (long step = 0; step < STEPS_PER_BLOCK; step++) {
    for (int p = 0; p < n_probes; p++) leaf[p] = moments_of(mean[step * n_probes + p]);
    moments_tree_push(&tree, leaf, &scratch);
  }
  moments_tree_root(&tree, root);
}

static double largest_se(const struct reference *reference, struct moments *root) {
  double largest = 0;
  moments_tree_root(&reference->tree, root);
  for (int p = 0; p < reference->plan->n_probes; p++) {
    double se = sqrt(moments_se2(root[p]));
    largest = largest < se ? se : largest;
  }
  return largest;
}

// Work grows as the inverse square of the error.
static double share_done(double target, double se) {
  double share = se > 0 ? target * target / (se * se) : 1;
  return share < 1 ? share : 1;
}

// Block after block until every probe's error is small enough. False: interrupted.
static bool refine(struct reference *reference, const char *path, const struct run_options *options,
                   struct moments *root, struct arena *arena) {
  double target = reference->target_se;
  struct moments *block = arena_new(arena, struct moments, reference->plan->n_probes);
  double se = reference->tree.count ? largest_se(reference, root) : INFINITY;
  struct progress progress = progress_begin("reference", 1, share_done(target, se), options->quiet);
  while (se > target) {
    compute_block(reference, reference->tree.count, plan_threads(options), block, *arena);
    if (interrupt_signal()) break;
    moments_tree_push(&reference->tree, block, arena);
    reference_keep(path, &reference->tree, *arena);
    se = largest_se(reference, root);
    progress_advance(&progress, share_done(target, se) - progress.done);
  }
  progress_end(&progress);
  return !interrupt_signal();
}

static bool is_sampled(const struct cell *cell) {
  return integrator_find(cell->reference_integrator) != NULL;
}

bool reference_make(const struct group_plan *plan, const struct cell *cell,
                    const struct run_options *options, const char *directory, struct probe *probe,
                    struct arena scratch, struct problem *problem) {
  if (!is_sampled(cell)) return true;
  char *path = reference_path(plan, cell, directory, &scratch);
  bool again = options->skip_off & SKIP_REFERENCES;
  if (!again && reference_read(path, plan, probe, scratch)) return true;
  // Begun first: a folder that cannot be written to is found out before the work.
  struct file_out out;
  if (!file_make_directory(directory, problem) || !file_begin(&out, path, problem)) return false;
  struct reference reference = reference_of(plan, cell, &scratch);
  reference.tree = again ? moments_tree_new(plan->n_probes, &scratch)
                         : reference_take_up(path, plan->n_probes, &scratch);
  struct moments *root = arena_new(&scratch, struct moments, plan->n_probes);
  if (!refine(&reference, path, options, root, &scratch)) {
    file_abandon(&out);
    return false;
  }
  for (int p = 0; p < plan->n_probes; p++) {
    probe[p].reference = root[p].mean;
    probe[p].reference_se = sqrt(moments_se2(root[p]));
  }
  if (!reference_write(&out, plan, probe, root[0].n * reference.replicas, problem)) return false;
  reference_forget(path, scratch);
  return true;
}

double reference_left_s(const struct group_plan *plan, const struct cell *cell,
                        const char *directory, struct arena scratch) {
  struct probe *probe = arena_new(&scratch, struct probe, plan->n_probes);
  if (!is_sampled(cell)) return 0;
  char *path = reference_path(plan, cell, directory, &scratch);
  bool again = plan->measure.skip_off & SKIP_REFERENCES;
  if (!again && reference_read(path, plan, probe, scratch)) return 0;
  struct reference reference = reference_of(plan, cell, &scratch);
  struct moments_tree kept = again ? moments_tree_new(plan->n_probes, &scratch)
                                   : reference_take_up(path, plan->n_probes, &scratch);
  double *mean = arena_new(&scratch, double, (long)STEPS_PER_UNIT * plan->n_probes);
  double started = progress_clock_s();
  compute_unit(&reference, 0, mean, scratch);
  double unit_s = progress_clock_s() - started, most = 0;
  for (int p = 0; p < plan->n_probes; p++) {
    struct moments m = {0};
    for (int step = 0; step < STEPS_PER_UNIT; step++)
      m = moments_merge(m, moments_of(mean[step * plan->n_probes + p]));
    double variance = moments_variance(m);
    most = most < variance ? variance : most;
  }
  double target = reference.target_se, blocks = most / (target * target) / STEPS_PER_BLOCK;
  double left = ceil(blocks) - (double)kept.count;
  return unit_s * UNITS_PER_BLOCK * (left > 1 ? left : 1);
}
