#include "scene/skip.h"

#include <string.h>

const struct skip_row skip_rows[] = {
    {"gray", SKIP_GRAY, "one channel instead of three where all spectra are gray"},
    {"static-eye", SKIP_STATIC_EYE,
     "one eye pass for all iterations where the camera is not random"},
    {"unseen", SKIP_UNSEEN, "photons in grid cells that no point measured can see are not stored"},
    {"probes", SKIP_PROBES, "only the probes' pixels are computed"},
    {"media", SKIP_MEDIA,
     "no medium is asked for, and no photon in one stored, where there are none"},
    {"motion", SKIP_MOTION, "no time, and no tree brought to it, where nothing moves"},
    {"tree", SKIP_TREE, "a few primitives are tested one after the other, without a tree"},
    {"last-bounce", SKIP_LAST, "no new direction after the last vertex of a photon path"},
    {"runs", SKIP_RUNS, "no more runs once rates are known as well as `until` asks"},
    {"references", SKIP_REFERENCES, "a reference that is on disk is not sampled again"},
};
const int n_skip_rows = sizeof skip_rows / sizeof *skip_rows;

static const struct skip_row *skip_find(const char *name, size_t length) {
  for (int k = 0; k < n_skip_rows; k++)
    if (strlen(skip_rows[k].name) == length && memcmp(skip_rows[k].name, name, length) == 0)
      return &skip_rows[k];
  return NULL;
}

bool skip_read(const char *names, unsigned *off, struct problem *problem) {
  for (const char *at = names;;) {
    size_t length = strcspn(at, ",");
    const struct skip_row *row = skip_find(at, length);
    if (row)
      *off |= row->bit;
    else if (length == 3 && memcmp(at, "all", 3) == 0)
      for (int k = 0; k < n_skip_rows; k++) *off |= skip_rows[k].bit;
    else
      return problem_set(problem,
                         "--no-skip: unknown name '%.*s'; known: all, and those of 'photonlab list "
                         "skips'",
                         (int)length, at);
    if (!at[length]) return true;
    at += length + 1;
  }
}
