// Names a scene file gives to things (objects, coordinate systems, ...), numbered from 0 in the
// order they were given, found by hashing: a scene may have a hundred thousand.
#ifndef SCENE_NAMES_H
#define SCENE_NAMES_H

#include "base/arena.h"

#include <stdint.h>

#define NAME_NONE UINT32_MAX

struct names {
  const char **item; // by number
  ptrdiff_t count, capacity;
  uint32_t *slot; // open addressing: number + 1, or 0
  uint32_t n_slots;
};

// The name's number, or NAME_NONE.
uint32_t names_find(const struct names *, const char *name);
// The number of a new name, which is copied.
uint32_t names_add(struct names *, struct arena *, const char *name);
// `; did you mean "x"?`, or which are there, or that there are none; for a name that was not found.
struct names_hint {
  char text[256];
};
struct names_hint names_suggest(const struct names *, const char *name);

#endif
