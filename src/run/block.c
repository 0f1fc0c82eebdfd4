#define _GNU_SOURCE // opendir, rmdir, clock_gettime
#include "run/block.h"

#include "base/file.h"
#include "estimate/local.h"

#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

// Running sums of one run: of the probes' luminance, and of the film where images are kept.
struct averages {
  double *probe, *film;
  long film_size;
};

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
                 struct averages *sum, double *value) {
  for (int c = 0; c < plan->group->n_cells; c++)
    for (int p = 0; p < plan->n_probes; p++)
      keep_probe(plan, i, checkpoint, frame, c, p, &sum->probe[c * plan->n_probes + p], value);
  if (!plan->n_images) return;
  for (long k = 0; k < sum->film_size; k++) sum->film[k] += frame[k];
  keep_images(plan, i, frame, sum->film, value);
}

// What is kept of a run, from its vector.
static void keep_run(const struct group_plan *plan, const double *value, double *kept) {
  for (int c = 0; plan->kept_width && c < plan->group->n_cells; c++)
    for (int p = 0; p < plan->n_probes; p++) {
      const double *series = value + plan_series(plan, c, p);
      double *out = kept + plan_kept(plan, c, p), sum = 0;
      memcpy(out, series + plan->average_at, (size_t)plan->n_checkpoints * sizeof *out);
      uint64_t i = 0;
      for (int k = 0; plan->companion[c] && k < plan->n_checkpoints; k++) {
        for (; i < plan->checkpoint[k]; i++) sum += series[plan->richardson_at + (long)i];
        out[plan->n_checkpoints + k] = sum / (double)i;
      }
    }
}

static struct block_time clock_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (struct block_time){progress_clock_s(), (double)now.tv_sec + 1e-9 * (double)now.tv_nsec,
                             0};
}

// Adds what passed since `begin`; bytes are the most of any.
static void take_time(struct block_time *time, struct block_time begin, int64_t bytes) {
  struct block_time now = clock_now();
  time->wall_s += now.wall_s - begin.wall_s;
  time->cpu_s += now.cpu_s - begin.cpu_s;
  time->photon_bytes = time->photon_bytes < bytes ? bytes : time->photon_bytes;
}

// What one run after the other works on.
struct at_work {
  const struct group_plan *plan;
  void *state;   // the integrator's
  double *frame; // of one iteration
  double *value; // [width]
  struct averages sum;
  struct block_time *time; // [n_times], added to
  struct progress *progress;
  double run_work;
};

// Long runs are seen to advance, short iterations not slowed down.
static void show_advance(const struct at_work *at, uint64_t i) {
  enum { STEPS = 64 };
  uint64_t n = at->plan->cell->iterations;
  uint64_t steps = i * STEPS / n - (i - 1) * STEPS / n;
  if (steps) progress_advance(at->progress, at->run_work * (double)steps / STEPS);
}

static void run_once(struct at_work *at, uint64_t run, struct block_time begin) {
  const struct group_plan *plan = at->plan;
  const struct integrator_type *integrator = plan->cell->integrator;
  struct averages *sum = &at->sum;
  memset(sum->probe, 0, (size_t)(plan->group->n_cells * plan->n_probes) * sizeof *sum->probe);
  memset(sum->film, 0, (size_t)sum->film_size * sizeof *sum->film);
  integrator->begin(at->state, run);
  int next = 0, t = 0;
  int64_t most = 0;
  for (uint64_t i = 1; i <= plan->cell->iterations; i++) {
    if (plan->radius_at) keep_radii(plan, i, at->state, at->value);
    integrator->step(at->state, i, at->frame);
    int64_t bytes = integrator->bytes ? integrator->bytes(at->state) : 0;
    most = most < bytes ? bytes : most;
    bool due = plan->checkpoint[next] == i;
    keep(plan, i, due ? next : -1, at->frame, sum, at->value);
    next += due;
    if (plan_time_at(plan, t) == i) take_time(&at->time[t++], begin, most);
    show_advance(at, i);
  }
}

int block_runs(const struct group_plan *plan, uint64_t block) {
  uint64_t left = plan->runs - block * RUNS_PER_BLOCK;
  return left < RUNS_PER_BLOCK ? (int)left : RUNS_PER_BLOCK;
}

struct block block_new(const struct group_plan *plan, uint64_t block, struct arena *arena) {
  return (struct block){
      .time = arena_new(arena, struct block_time, plan->n_times),
      .moments = arena_new(arena, struct moments, plan->width),
      .kept = arena_new(arena, double, block_runs(plan, block) * plan->kept_width),
  };
}

void block_compute(const struct group_plan *plan, uint64_t block, struct block *out,
                   struct progress *progress, double run_work, struct arena scratch) {
  const struct measurement *measure = &plan->measure;
  long estimate = (long)measure->n_points * measure->features.n_channels;
  long film_size = plan->n_images ? plan->group->n_cells * estimate : 0;
  struct block_time begin = clock_now(); // the first run's time has what all share
  struct at_work at = {.plan = plan,
                       .state = plan->cell->integrator->create(measure, &scratch),
                       .frame = arena_new(&scratch, double, measure->n_estimators *estimate),
                       .value = arena_new(&scratch, double, plan->width),
                       .sum = {arena_new(&scratch, double, plan->group->n_cells * plan->n_probes),
                               arena_new(&scratch, double, film_size), film_size},
                       .time = out->time,
                       .progress = progress,
                       .run_work = run_work};
  struct moments *leaf = arena_new(&scratch, struct moments, plan->width);
  struct moments_tree tree = moments_tree_new(plan->width, &scratch);
  memset(out->time, 0, (size_t)plan->n_times * sizeof *out->time);
  for (int run = 1; run <= block_runs(plan, block); run++, begin = clock_now()) {
    run_once(&at, block * RUNS_PER_BLOCK + (uint64_t)run, begin);
    for (long k = 0; k < plan->width; k++) leaf[k] = moments_of(at.value[k]);
    moments_tree_push(&tree, leaf, &scratch);
    keep_run(plan, at.value, out->kept + (run - 1) * plan->kept_width);
  }
  moments_tree_root(&tree, out->moments);
}

// ---- files ----

struct block_header {
  char magic[8];
  uint64_t fingerprint, block, width,
      check; // native: on a machine of the other byte order no match
};

static size_t kept_bytes(const struct group_plan *plan, uint64_t block) {
  return (size_t)(block_runs(plan, block) * plan->kept_width) * sizeof(double);
}

static struct block_header header_of(const struct group_plan *plan, uint64_t number,
                                     const struct block *block) {
  XXH64_state_t *state = XXH64_createState();
  XXH64_reset(state, plan->fingerprint);
  XXH64_update(state, block->moments, (size_t)plan->width * sizeof *block->moments);
  XXH64_update(state, block->kept, kept_bytes(plan, number));
  struct block_header header = {"PLBLOCK", plan->fingerprint, number, (uint64_t)plan->width,
                                XXH64_digest(state)};
  XXH64_freeState(state);
  return header;
}

const char *block_folder(const struct plan *plan, const char *directory, struct arena *arena) {
  return arena_format(arena, "%s/blocks/%016" PRIx64, directory, plan->fingerprint);
}

static char *block_path(const struct group_plan *plan, uint64_t block, const char *folder,
                        struct arena *arena) {
  return arena_format(arena, "%s/group-%03d-block-%06" PRIu64, folder, plan->number, block);
}

bool block_read(const struct group_plan *plan, uint64_t number, const char *folder,
                struct block *block, struct arena *arena) {
  struct text text;
  struct problem ignored = {0};
  struct block_header header;
  size_t times = (size_t)plan->n_times * sizeof *block->time;
  size_t bytes = (size_t)plan->width * sizeof *block->moments, kept = kept_bytes(plan, number);
  if (!file_read(block_path(plan, number, folder, arena), arena, &text, &ignored)) return false;
  if ((size_t)text.length != sizeof header + times + bytes + kept) return false;
  *block = block_new(plan, number, arena);
  memcpy(&header, text.data, sizeof header);
  memcpy(block->time, text.data + sizeof header, times);
  memcpy(block->moments, text.data + sizeof header + times, bytes);
  memcpy(block->kept, text.data + sizeof header + times + bytes, kept);
  struct block_header expected = header_of(plan, number, block);
  return memcmp(&header, &expected, sizeof header) == 0;
}

const struct block_time *block_times(const struct group_plan *plan, uint64_t number,
                                     const char *folder, struct arena *arena) {
  struct block block;
  return block_read(plan, number, folder, &block, arena) ? block.time : NULL;
}

void block_write(const struct group_plan *plan, uint64_t number, const char *folder,
                 const struct block *block, struct arena scratch) {
  struct problem problem = {0};
  struct file_out out;
  struct block_header header = header_of(plan, number, block);
  if (!file_begin(&out, block_path(plan, number, folder, &scratch), &problem))
    die("%s", problem.text);
  fwrite(&header, sizeof header, 1, out.stream);
  fwrite(block->time, sizeof *block->time, (size_t)plan->n_times, out.stream);
  fwrite(block->moments, sizeof *block->moments, (size_t)plan->width, out.stream);
  fwrite(block->kept, 1, kept_bytes(plan, number), out.stream);
  if (!file_commit(&out, &problem)) die("%s", problem.text);
}

bool block_remove_all(const struct plan *plan, const char *directory, struct arena scratch) {
  const char *folder = block_folder(plan, directory, &scratch);
  DIR *list = opendir(folder);
  for (struct dirent *entry; list && (entry = readdir(list));)
    unlink(arena_format(&scratch, "%s/%s", folder, entry->d_name)); // not "." and "..": folders
  if (list) closedir(list);
  rmdir(folder);
  return rmdir(arena_format(&scratch, "%s/blocks", directory)) == 0;
}

struct block block_must_read(const struct group_plan *plan, uint64_t number, const char *folder,
                             struct arena *arena) {
  struct block block;
  if (!block_read(plan, number, folder, &block, arena))
    die("%s: block %" PRIu64 " of group %d has gone while the experiment ran", folder, number,
        plan->number);
  return block;
}

void block_merge(const struct group_plan *plan, const char *folder, struct moments *out,
                 struct arena scratch) {
  struct moments_tree tree = moments_tree_new(plan->width, &scratch);
  struct moments *leaf = arena_new(&scratch, struct moments, plan->width);
  for (uint64_t block = 0; block < plan->n_blocks; block++) {
    struct arena own = scratch; // given back after each block
    struct block file = block_must_read(plan, block, folder, &own);
    memcpy(leaf, file.moments, (size_t)plan->width * sizeof *leaf);
    moments_tree_push(&tree, leaf, &scratch);
  }
  moments_tree_root(&tree, out);
}
