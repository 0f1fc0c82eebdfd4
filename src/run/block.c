#define _GNU_SOURCE // opendir, rmdir
#include "run/block.h"

#include "base/file.h"

#include <dirent.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

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

struct block_sum block_begin(const struct group_plan *plan, uint64_t number, struct block *out,
                             struct arena *arena) {
  memset(out->time, 0, (size_t)plan->n_times * sizeof *out->time);
  return (struct block_sum){.plan = plan,
                            .number = number,
                            .block = out,
                            .leaf = arena_new(arena, struct moments, plan->width),
                            .tree = moments_tree_new(plan->width, arena)};
}

static void add_time(struct block_time *sum, const struct block_time *time) {
  sum->wall_s += time->wall_s;
  sum->cpu_s += time->cpu_s;
  if (sum->photon_bytes < time->photon_bytes) sum->photon_bytes = time->photon_bytes;
}

bool block_add(struct block_sum *sum, const struct worker *worker, struct arena *arena) {
  const struct group_plan *plan = sum->plan;
  for (int t = 0; t < plan->n_times; t++) add_time(&sum->block->time[t], &worker->time[t]);
  worker_keep(worker, sum->block->kept + (long)sum->tree.count * plan->kept_width);
  for (long k = 0; k < plan->width; k++) sum->leaf[k] = moments_of(worker->value[k]);
  moments_tree_push(&sum->tree, sum->leaf, arena);
  if (sum->tree.count < (uint64_t)block_runs(plan, sum->number)) return false;
  moments_tree_root(&sum->tree, sum->block->moments);
  return true;
}

void block_compute(const struct group_plan *plan, uint64_t number, struct block *out,
                   struct progress *progress, double run_work, struct arena scratch) {
  struct block_sum sum = block_begin(plan, number, out, &scratch);
  struct arena own = arena_reserve(), reserved = own;
  struct worker *worker = worker_new(plan, &own);
  uint64_t run = number * RUNS_PER_BLOCK;
  do worker_run(worker, ++run, progress, run_work);
  while (!block_add(&sum, worker, &scratch));
  arena_release(reserved);
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
