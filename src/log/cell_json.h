// A cell in JSON: manifest.json, fit.json and the manifests within images say the same of it.
#ifndef LOG_CELL_JSON_H
#define LOG_CELL_JSON_H

#include "experiment/experiment.h"

#include <jansson.h>

// Sets every key of experiment/cell_keys.h. A number that is not finite is null.
void cell_json_set(json_t *object, const struct cell *);

// An object of its own as text on one line; `more`, a further key, is text or NULL.
char *cell_json_line(const struct cell *, const char *more, const char *text, struct arena *);

#endif
