#define _GNU_SOURCE // clock_gettime
#include "run/worker.h"

#include "estimate/local.h"

#include <string.h>
#include <time.h>

// Image m of all cells: `film` divided by n.
static void keep_image(const struct group_plan *plan, int m, const double *film, double n,
                       double *value) {
  long size = (long)plan->measure.n_points * plan->measure.features.n_channels;
  for (int c = 0; c < plan->group->n_cells; c++)
    for (long k = 0; k < size; k++) value[plan_image(plan, c, m) + k] = film[c * size + k] / n;
}

static void keep_images(const struct group_plan *plan, uint64_t i, const double *frame,
                        const double *film, double *value) {
  const struct cell *cell = plan->cell;
  for (int m = 0; m < cell->n_images; m++)
    if (cell->image[m] == i) keep_image(plan, m, film, (double)i, value);
  for (int m = 0; m < cell->n_singles; m++)
    if (cell->single[m] == i) keep_image(plan, cell->n_images + m, frame, 1, value);
}

// The probes' squared radii of iteration i, before it; in media those of their points on surfaces.
static void keep_radii(const struct group_plan *plan, uint64_t i, const void *state,
                       double *value) {
  const double *r2 = plan->cell->integrator->local(state)->field[ON_SURFACE].rd;
  for (int c = 0; c < plan->group->n_cells; c++)
    for (int p = 0; p < plan->n_probes; p++)
      value[plan_series(plan, c, p) + plan->radius_at + (long)(i - 1)] =
          r2[(long)plan->probe_point[p] * plan->measure.n_estimators + c];
}

static double probe_value(const struct group_plan *plan, const double *frame, int estimator,
                          int probe) {
  int n_channels = plan->measure.features.n_channels;
  long point = (long)estimator * plan->measure.n_points + plan->probe_point[probe];
  return luminance(frame + point * n_channels, n_channels);
}

// Iteration i's frame into the series of one cell at one probe. A bias that is proportional to r^2
// is 4/3 of what half the radius takes away (Richardson; theory 4.1).
static void keep_probe(const struct group_plan *plan, uint64_t i, int checkpoint,
                       const double *frame, int cell, int probe, double *sum, double *value) {
  double *series = value + plan_series(plan, cell, probe);
  double x = probe_value(plan, frame, cell, probe);
  *sum += series[i - 1] = x;
  if (checkpoint >= 0) series[plan->average_at + checkpoint] = *sum / (double)i;
  if (plan->companion[cell])
    series[plan->richardson_at + (long)(i - 1)] =
        4.0 / 3 * (x - probe_value(plan, frame, plan->companion[cell], probe));
}

// Iteration i's frame into the run's vector.
static void keep(const struct group_plan *plan, uint64_t i, int checkpoint, const double *frame,
                 struct worker_sums *sum, double *value) {
  for (int c = 0; c < plan->group->n_cells; c++)
    for (int p = 0; p < plan->n_probes; p++)
      keep_probe(plan, i, checkpoint, frame, c, p, &sum->probe[c * plan->n_probes + p], value);
  if (!plan->n_images) return;
  for (long k = 0; k < sum->film_size; k++) sum->film[k] += frame[k];
  keep_images(plan, i, frame, sum->film, value);
}

static struct block_time clock_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (struct block_time){progress_clock_s(), (double)now.tv_sec + 1e-9 * (double)now.tv_nsec,
                             0};
}

// What passed since `begin`.
static struct block_time time_since(struct block_time begin, int64_t bytes) {
  struct block_time now = clock_now();
  return (struct block_time){now.wall_s - begin.wall_s, now.cpu_s - begin.cpu_s, bytes};
}

// Long runs are seen to advance, short iterations not slowed down.
static void show_advance(uint64_t i, uint64_t n, struct progress *progress, double run_work) {
  enum { STEPS = 64 };
  uint64_t steps = i * STEPS / n - (i - 1) * STEPS / n;
  if (steps) progress_advance(progress, run_work * (double)steps / STEPS);
}

struct worker *worker_new(const struct group_plan *plan, struct arena *arena) {
  struct block_time begin = clock_now();
  const struct measurement *measure = &plan->measure;
  struct worker *worker = arena_new(arena, struct worker, 1);
  struct worker_sums *sum = &worker->sum;
  long estimate = (long)measure->n_points * measure->features.n_channels;
  sum->film_size = plan->n_images ? plan->group->n_cells * estimate : 0;
  sum->film = arena_new(arena, double, sum->film_size);
  sum->probe = arena_new(arena, double, plan->group->n_cells * plan->n_probes);
  worker->plan = plan;
  worker->frame = arena_new(arena, double, measure->n_estimators *estimate);
  worker->value = arena_new(arena, double, plan->width);
  worker->time = arena_new(arena, struct block_time, plan->n_times);
  worker->state = plan->cell->integrator->create(measure, arena);
  worker->made = time_since(begin, 0);
  return worker;
}

// When a run began; what was made before its first is a part of it.
static struct block_time begin_run(struct worker *worker) {
  struct block_time now = clock_now();
  now.wall_s -= worker->made.wall_s;
  now.cpu_s -= worker->made.cpu_s;
  worker->made = (struct block_time){0};
  return now;
}

void worker_run(struct worker *worker, uint64_t run, struct progress *progress, double run_work) {
  const struct group_plan *plan = worker->plan;
  const struct integrator_type *integrator = plan->cell->integrator;
  struct worker_sums *sum = &worker->sum;
  struct block_time begin = begin_run(worker);
  memset(sum->probe, 0, (size_t)(plan->group->n_cells * plan->n_probes) * sizeof *sum->probe);
  memset(sum->film, 0, (size_t)sum->film_size * sizeof *sum->film);
  worker->run = run;
  integrator->begin(worker->state, run);
  int next = 0, t = 0;
  int64_t most = 0;
  for (uint64_t i = 1; i <= plan->cell->iterations; i++) {
    if (plan->radius_at) keep_radii(plan, i, worker->state, worker->value);
    integrator->step(worker->state, i, worker->frame);
    int64_t bytes = integrator->bytes ? integrator->bytes(worker->state) : 0;
    most = most < bytes ? bytes : most;
    bool due = plan->checkpoint[next] == i;
    keep(plan, i, due ? next : -1, worker->frame, sum, worker->value);
    next += due;
    if (plan_time_at(plan, t) == i) worker->time[t++] = time_since(begin, most);
    show_advance(i, plan->cell->iterations, progress, run_work);
  }
}

void worker_keep(const struct worker *worker, double *kept) {
  const struct group_plan *plan = worker->plan;
  for (int c = 0; plan->kept_width && c < plan->group->n_cells; c++)
    for (int p = 0; p < plan->n_probes; p++) {
      const double *series = worker->value + plan_series(plan, c, p);
      double *out = kept + plan_kept(plan, c, p), sum = 0;
      memcpy(out, series + plan->average_at, (size_t)plan->n_checkpoints * sizeof *out);
      uint64_t i = 0;
      for (int k = 0; plan->companion[c] && k < plan->n_checkpoints; k++) {
        for (; i < plan->checkpoint[k]; i++) sum += series[plan->richardson_at + (long)i];
        out[plan->n_checkpoints + k] = sum / (double)i;
      }
    }
}
