#include "run/reference_cache.h"

#include "base/file.h"
#include "base/version.h"

#include <string.h>
#include <unistd.h>
#include <xxhash.h>

char *reference_path(const struct group_plan *plan, const struct cell *cell, const char *directory,
                     struct arena *arena) {
  char *key = arena_format(arena, "%s %016llx %s %d %d %x %.17g", photonlab_version,
                           (unsigned long long)plan->loaded->scene.hash, cell->reference_integrator,
                           cell->depth, cell->footprint, cell->left_out, cell->reference_se);
  for (int p = 0; p < plan->n_probes; p++)
    key = arena_format(arena, "%s %d,%d", key, plan->probe_pixel[p].x, plan->probe_pixel[p].y);
  return arena_format(arena, "%s/%s-%016llx.csv", directory, cell->scene,
                      (unsigned long long)XXH64(key, strlen(key), 0));
}

static const char cache_header[] = "x,y,reference,reference_se,samples\n";

// Only a file that is whole: these probes, row by row to the end of the last line.
bool reference_read(const char *path, const struct group_plan *plan, struct probe *probe,
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

bool reference_write(struct file_out *out, const struct group_plan *plan, const struct probe *probe,
                     double samples, struct problem *problem) {
  fputs(cache_header, out->stream);
  for (int p = 0; p < plan->n_probes; p++)
    fprintf(out->stream, "%d,%d,%.17g,%.17g,%.17g\n", probe[p].x, probe[p].y, probe[p].reference,
            probe[p].reference_se, samples);
  return file_commit(out, problem);
}

// ---- unfinished ones ----
struct unfinished_header {
  char magic[8]; // numbers are native; the sum finds another byte order
  uint64_t count, levels, width, check;
};

static char *unfinished_path(const char *path, struct arena *arena) {
  return arena_format(arena, "%s.unfinished", path);
}

static struct unfinished_header header_of(const struct moments_tree *tree) {
  struct unfinished_header header = {"PLREFER", tree->count, (uint64_t)tree->levels,
                                     (uint64_t)tree->width, tree->count};
  for (int level = 0; level < tree->levels; level++)
    header.check =
        XXH64(tree->level[level], (size_t)tree->width * sizeof(struct moments), header.check);
  return header;
}

void reference_keep(const char *path, const struct moments_tree *tree, struct arena scratch) {
  struct problem problem = {0};
  struct file_out out;
  struct unfinished_header header = header_of(tree);
  if (!file_begin(&out, unfinished_path(path, &scratch), &problem)) die("%s", problem.text);
  fwrite(&header, sizeof header, 1, out.stream);
  for (int level = 0; level < tree->levels; level++)
    fwrite(tree->level[level], sizeof(struct moments), (size_t)tree->width, out.stream);
  if (!file_commit(&out, &problem)) die("%s", problem.text);
}

struct moments_tree reference_take_up(const char *path, long width, struct arena *arena) {
  struct moments_tree empty = moments_tree_new(width, arena), tree = empty;
  struct problem ignored = {0};
  struct text text;
  struct unfinished_header header;
  char *unfinished = unfinished_path(path, arena);
  if (!file_exists(unfinished) || !file_read(unfinished, arena, &text, &ignored)) return empty;
  if ((size_t)text.length < sizeof header) return empty;
  memcpy(&header, text.data, sizeof header);
  size_t row = (size_t)width * sizeof(struct moments);
  if (header.levels > MOMENTS_LEVELS || header.width != (uint64_t)width ||
      (size_t)text.length != sizeof header + header.levels * row)
    return empty;
  tree.count = header.count;
  tree.levels = (int)header.levels;
  for (int level = 0; level < tree.levels; level++) {
    tree.level[level] = arena_new(arena, struct moments, width);
    memcpy(tree.level[level], text.data + sizeof header + (size_t)level * row, row);
  }
  struct unfinished_header expected = header_of(&tree);
  return memcmp(&header, &expected, sizeof header) == 0 ? tree : empty;
}

void reference_forget(const char *path, struct arena scratch) {
  unlink(unfinished_path(path, &scratch));
}
