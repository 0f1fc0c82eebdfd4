#include "log/cell_json.h"

#include "experiment/cell_keys.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *key_json(const struct cell_key *key, const struct cell *cell) {
  char buffer[CELL_KEY_SIZE];
  const char *text = key->text(cell, 17, buffer);
  if (key->kind == KEY_NAME) return json_string(text);
  if (key->kind == KEY_COUNT) return json_integer(strtoll(text, NULL, 10));
  double value = strtod(text, NULL);
  return isfinite(value) ? json_real(value) : json_null();
}

void cell_json_set(json_t *object, const struct cell *cell) {
  for (int k = 0; k < CELL_KEYS; k++)
    json_object_set_new(object, cell_keys[k].name, key_json(&cell_keys[k], cell));
}

char *cell_json_line(const struct cell *cell, const char *more, const char *text,
                     struct arena *arena) {
  json_t *object = json_object();
  cell_json_set(object, cell);
  if (more) json_object_set_new(object, more, json_string(text));
  char *line = json_dumps(object, JSON_REAL_PRECISION(17));
  char *copy = arena_string(arena, line, (ptrdiff_t)strlen(line));
  free(line);
  json_decref(object);
  return copy;
}
