#include "run/reference.h"

#include "base/file.h"
#include "numeric/rng.h"
#include "numeric/sum.h"
#include "run/interrupt.h"
#include "run/progress.h"

#include <string.h>
#include <xxhash.h>

enum {
  SAMPLES_PER_STEP = 4096, // shared by the probes: one full batch of walks
  STEPS_PER_UNIT = 64,     // what a thread takes at a time
  FIRST_UNITS = 4,         // then the number of units doubles until the error is small enough
};

struct reference {
  const struct group_plan *plan;
  double target_se;
  const struct integrator_type *integrator;
  struct measurement measure;
  int replicas;
  struct moments_tree tree; // over steps, in their order
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
  reference.tree = moments_tree_new(plan->n_probes, arena);
  return reference;
}

// mean[step * n_probes + p] of the unit's steps.
static void compute_unit(const struct reference *reference, uint64_t unit, double *mean,
                         struct arena scratch) {
  int n_channels = reference->measure.features.n_channels, n_probes = reference->plan->n_probes;
  double *frame = arena_new(&scratch, double, (long)reference->measure.n_points *n_channels);
  double *value = arena_new(&scratch, double, reference->replicas);
  void *state = reference->integrator->new (&reference->measure, &scratch);
  reference->integrator->begin(state, 1);
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

// Units first .. last - 1 in parallel, pushed in their order.
static void compute_round(struct reference *reference, uint64_t first, uint64_t last, int threads,
                          struct arena *arena) {
  int n_probes = reference->plan->n_probes;
  long size = (long)STEPS_PER_UNIT * n_probes;
  struct arena scratch = *arena;
  double *mean = arena_new(&scratch, double, (long)(last - first) * size);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (uint64_t unit = first; unit < last; unit++) {
    struct arena own = arena_reserve();
    if (!interrupt_signal()) compute_unit(reference, unit, mean + (long)(unit - first) * size, own);
    arena_release(own);
  }
  struct moments *leaf = arena_new(&scratch, struct moments, n_probes);
  for (long step = 0; step < (long)(last - first) * STEPS_PER_UNIT; step++) {
    for (int p = 0; p < n_probes; p++) leaf[p] = moments_of(mean[step * n_probes + p]);
    moments_tree_push(&reference->tree, leaf, &scratch);
  }
  *arena = scratch; // the tree may have grown into it
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

// ---- cache ----

static char *cache_path(const struct group_plan *plan, const struct cell *cell,
                        const char *directory, struct arena *arena) {
  char *key =
      arena_format(arena, "2 %016llx %s %d %d %.17g", (unsigned long long)plan->loaded->scene.hash,
                   cell->reference_integrator, cell->depth, cell->footprint, cell->reference_se);
  for (int p = 0; p < plan->n_probes; p++)
    key = arena_format(arena, "%s %d,%d", key, plan->probe_pixel[p].x, plan->probe_pixel[p].y);
  return arena_format(arena, "%s/%s-%016llx.csv", directory, cell->scene,
                      (unsigned long long)XXH64(key, strlen(key), 0));
}

static const char cache_header[] = "x,y,reference,reference_se,samples\n";

// Only a file that is whole: these probes, row by row to the end of the last line.
static bool cache_read(const char *path, const struct group_plan *plan, struct probe *probe,
                       struct arena scratch) {
  struct text text;
  struct problem ignored = {0};
  struct probe *read = arena_new(&scratch, struct probe, plan->n_probes);
  if (!file_exists(path) || !file_read(path, &scratch, &text, &ignored)) return false;
  if (strncmp(text.data, cache_header, strlen(cache_header)) != 0) return false;
  const char *at = text.data + strlen(cache_header);
  for (int p = 0; p < plan->n_probes; p++) {
    int used = 0, x, y;
    read[p] = probe[p];
    if (sscanf(at, "%d,%d,%lf,%lf,%*f%n", &x, &y, &read[p].reference, &read[p].reference_se,
               &used) != 4 ||
        used == 0 || at[used] != '\n' || x != probe[p].x || y != probe[p].y)
      return false;
    at += used + 1;
  }
  memcpy(probe, read, (size_t)plan->n_probes * sizeof *probe);
  return true;
}

static bool cache_write(struct file_out *out, const struct group_plan *plan,
                        const struct probe *probe, double samples, struct problem *problem) {
  fputs(cache_header, out->stream);
  for (int p = 0; p < plan->n_probes; p++)
    fprintf(out->stream, "%d,%d,%.17g,%.17g,%.17g\n", probe[p].x, probe[p].y, probe[p].reference,
            probe[p].reference_se, samples);
  return file_commit(out, problem);
}

// Doubles the number of samples until every probe's error is small enough. False: interrupted.
static bool refine(struct reference *reference, const struct run_options *options,
                   struct moments *root, struct arena *arena) {
  double target = reference->target_se;
  int threads = plan_threads(options);
  struct progress progress = progress_begin("reference", 1, 0, options->quiet);
  for (uint64_t done = 0, next = FIRST_UNITS;; done = next, next *= 2) {
    compute_round(reference, done, next, threads, arena);
    if (interrupt_signal()) break;
    double se = largest_se(reference, root);
    // Work grows as the inverse square of the error.
    double share = se > 0 ? target * target / (se * se) : 1;
    progress_advance(&progress, (share < 1 ? share : 1) - progress.done);
    if (se <= target) break;
  }
  progress_end(&progress);
  return !interrupt_signal();
}

bool reference_make(const struct group_plan *plan, const struct cell *cell,
                    const struct run_options *options, const char *directory, struct probe *probe,
                    struct arena scratch, struct problem *problem) {
  const char *name = cell->reference_integrator;
  if (strcmp(name, "none") == 0 || strcmp(name, "analytic") == 0) return true;
  char *path = cache_path(plan, cell, directory, &scratch);
  if (cache_read(path, plan, probe, scratch)) return true;
  struct file_out
      out; // begun first: a folder that cannot be written to is found out before the work
  if (!file_make_directory(directory, problem) || !file_begin(&out, path, problem)) return false;
  struct reference reference = reference_of(plan, cell, &scratch);
  struct moments *root = arena_new(&scratch, struct moments, plan->n_probes);
  if (!refine(&reference, options, root, &scratch)) {
    file_abandon(&out);
    return false;
  }
  for (int p = 0; p < plan->n_probes; p++) {
    probe[p].reference = root[p].mean;
    probe[p].reference_se = sqrt(moments_se2(root[p]));
  }
  return cache_write(&out, plan, probe, root[0].n * reference.replicas, problem);
}
