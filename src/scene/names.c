#include "scene/names.h"

#include "pbrt/suggest.h"

#include <stdio.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

// Comparing letters takes a microsecond a name: beyond this many nobody waits for advice.
enum { MAX_COMPARED = 65536, MAX_LISTED = 8 };

// Where the name is, or the free slot where it would be. There is always a free one.
static uint32_t *slot_of(const struct names *names, const char *name) {
  uint32_t mask = names->n_slots - 1, at = (uint32_t)XXH64(name, strlen(name), 0) & mask;
  while (names->slot[at] && strcmp(names->item[names->slot[at] - 1], name) != 0)
    at = (at + 1) & mask;
  return &names->slot[at];
}

uint32_t names_find(const struct names *names, const char *name) {
  return names->n_slots ? *slot_of(names, name) - 1 : NAME_NONE; // 0 - 1 is NAME_NONE
}

// At most half of the slots are taken.
static void make_room(struct names *names, struct arena *arena) {
  if (2 * (names->count + 1) <= names->n_slots) return;
  names->n_slots = names->n_slots ? 2 * names->n_slots : 16;
  names->slot = arena_new(arena, uint32_t, names->n_slots);
  for (ptrdiff_t k = 0; k < names->count; k++) *slot_of(names, names->item[k]) = (uint32_t)k + 1;
}

uint32_t names_add(struct names *names, struct arena *arena, const char *name) {
  make_room(names, arena);
  const char *copy = arena_string(arena, name, (ptrdiff_t)strlen(name));
  *slot_of(names, copy) = (uint32_t)names->count + 1;
  *arena_push(arena, names) = copy;
  return (uint32_t)names->count - 1;
}

struct names_hint names_suggest(const struct names *names, const char *name) {
  struct names_hint hint;
  size_t size = sizeof hint.text;
  int n = names->count < MAX_COMPARED ? (int)names->count : MAX_COMPARED;
  const char *nearest = suggest_name(name, names->item, n);
  if (nearest) {
    snprintf(hint.text, size, "; did you mean \"%s\"?", nearest);
    return hint;
  }
  size_t used = (size_t)snprintf(hint.text, size, n ? "; there are" : "; there are none yet");
  for (int k = 0; k < n && k < MAX_LISTED && used < size; k++)
    used +=
        (size_t)snprintf(hint.text + used, size - used, "%s \"%s\"", k ? "," : "", names->item[k]);
  if (n > MAX_LISTED && used < size) snprintf(hint.text + used, size - used, ", ...");
  return hint;
}
