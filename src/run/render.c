#include "run/render.h"

#include "run/interrupt.h"
#include "run/picture.h"
#include "run/progress.h"

#include <omp.h>

enum { ITERATIONS_PER_THREAD = 4 }; // computed before they are merged in order

// Iterations first, first + 1, ... in parallel, each into a frame of its own. One thread enters no
// parallel region: in one, even of one thread, those of the integrator would start their threads
// anew.
static void compute_round(const struct integrator_type *integrator, void *const *state,
                          uint64_t first, int count, long size, double *frames, int threads) {
  if (threads == 1) {
    for (int k = 0; k < count && !interrupt_signal(); k++)
      integrator->step(state[0], first + (uint64_t)k, frames + k * size);
    return;
  }
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int k = 0; k < count; k++)
    if (!interrupt_signal())
      integrator->step(state[omp_get_thread_num()], first + (uint64_t)k, frames + k * size);
}

// Frames of iterations first, first + 1, ... in their order.
static void add_round(struct running *running, const double *frames, uint64_t first, int count,
                      long size) {
  for (int k = 0; k < count; k++)
    for (long j = 0; j < size; j++)
      running_add(&running[j], frames[k * size + j], (double)(first + (uint64_t)k));
}

static struct image picture(const struct measurement *measure, const struct running *running,
                            double n, struct arena *arena) {
  int n_channels = measure->features.n_channels;
  struct image image = picture_new(measure, arena);
  for (long j = 0; j < measure->n_points; j++)
    for (int c = 0; c < 3; c++) {
      const struct running *at = &running[j * n_channels + (n_channels == 3 ? c : 0)];
      image.plane[c][j] = (float)at->mean;
      image.plane[3 + c][j] = n > 1 ? (float)(at->m2 / (n - 1) / n) : NAN;
    }
  return image;
}

// The film's exposure, of the mean and of its variance.
static void expose(struct image *image, double exposure, long n) {
  for (int k = 0; k < 6 && exposure != 1; k++)
    for (long j = 0; j < n; j++)
      image->plane[k][j] =
          (float)((double)image->plane[k][j] * (k < 3 ? exposure : exposure * exposure));
}

bool render_image(const struct integrator_type *integrator, const struct measurement *measure,
                  uint64_t iterations, struct run_options options, struct arena *arena,
                  struct image *image) {
  // Iterations that depend on each other are computed in order, each by all threads.
  struct measurement own_measure = *measure;
  int threads = integrator->independent ? plan_threads(&options) : 1;
  own_measure.threads = integrator->independent ? 1 : plan_threads(&options);
  int round = threads > 1 ? threads * ITERATIONS_PER_THREAD : 1;
  if ((uint64_t)round > iterations) round = (int)iterations;
  long size = (long)measure->n_points * measure->features.n_channels;
  struct running *running = arena_new(arena, struct running, size);
  double *frames = arena_new(arena, double, round *size);
  void **state = arena_new(arena, void *, threads);
  struct arena *own = arena_new(arena, struct arena, threads),
               *kept = arena_new(arena, struct arena, threads);
  for (int t = 0; t < threads; t++) {
    own[t] = kept[t] = arena_reserve();
    state[t] = integrator->create(&own_measure, &own[t]);
    integrator->begin(state[t], 1);
  }
  interrupt_install();
  struct progress progress = progress_begin("render", (double)iterations, 0, options.quiet);
  for (uint64_t first = 1; first <= iterations && !interrupt_signal(); first += (uint64_t)round) {
    uint64_t left = iterations - first + 1;
    int count = left < (uint64_t)round ? (int)left : round;
    compute_round(integrator, state, first, count, size, frames, threads);
    add_round(running, frames, first, count, size);
    progress_advance(&progress, count);
  }
  progress_end(&progress);
  for (int t = 0; t < threads; t++) arena_release(kept[t]);
  if (interrupt_signal()) return false;
  *image = picture(measure, running, (double)iterations, arena);
  expose(image, measure->scene->settings.exposure, measure->n_points);
  return true;
}
