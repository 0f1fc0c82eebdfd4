#define _GNU_SOURCE // nftw
#include "tests/bench/trial.h"

#include "analysis/fit.h"
#include "base/file.h"
#include "base/problem.h"

#include <ftw.h>
#include <string.h>

struct trial *trial_new(struct bench *bench, const char *path, const char *quality,
                        const char *name) {
  struct trial *trial = arena_new(bench->arena, struct trial, 1);
  struct problem problem = {{0}};
  trial->options = (struct run_options){.quiet = true, .largest_rate_se = fit_largest_rate_se};
  trial->directory = arena_format(bench->arena, "%s/%s", bench->folder, name);
  if (!experiment_read(path, quality, bench->arena, &trial->experiment, &problem))
    die("%s", problem.text);
  return trial;
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *at) {
  (void)info, (void)type, (void)at;
  return remove(path);
}

void trial_run(void *data, int repetition) {
  const struct trial *trial = data;
  struct arena arena = arena_reserve(), reserved = arena;
  struct problem problem = {{0}};
  (void)repetition;
  nftw(trial->directory, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  if (run_experiment(&trial->experiment, trial->directory, trial->options, &arena, &problem) !=
      RUN_DONE)
    die("%s", problem.text);
  arena_release(reserved);
}

// ---- what is measured is the same ----
static bool ends(const char *path, const char *with) {
  size_t n = strlen(path), m = strlen(with);
  return n >= m && strcmp(path + n - m, with) == 0;
}

static struct text read_text(const char *path, struct arena *arena) {
  struct text text;
  struct problem problem = {{0}};
  if (!file_read(path, arena, &text, &problem)) die("%s", problem.text);
  return text;
}

static struct comparison {
  const struct trial *a, *b;
  bool shorter;
  int files;
} comparison; // nftw takes no data

static int compare(const char *path, const struct stat *info, int type, struct FTW *at) {
  (void)info, (void)at;
  struct comparison *c = &comparison;
  bool asked =
      ends(path, "/runs.csv") || (!c->shorter && (ends(path, "/log.csv") || ends(path, ".exr")));
  if (type != FTW_F || !asked) return 0;
  struct arena arena = arena_reserve(), reserved = arena;
  const char *below = path + strlen(c->a->directory);
  struct text a = read_text(path, &arena);
  struct text b = read_text(arena_format(&arena, "%s%s", c->b->directory, below), &arena);
  bool same = (c->shorter ? a.length < b.length : a.length == b.length) &&
              memcmp(a.data, b.data, (size_t)a.length) == 0;
  bench_check(same, "what is measured in two ways differs", path);
  arena_release(reserved);
  c->files++;
  return 0;
}

void trial_check_same(struct trial *a, struct trial *b, bool shorter) {
  trial_run(a, 0);
  trial_run(b, 0);
  comparison = (struct comparison){a, b, shorter, 0};
  nftw(a->directory, compare, 16, FTW_PHYS);
  bench_check(comparison.files > 0, "there is nothing to compare", a->directory);
}
