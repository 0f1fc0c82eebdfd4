// What tells the cells of an experiment apart: one table for manifests, fit.json, curves.csv and
// the terminal.
#ifndef EXPERIMENT_CELL_KEYS_H
#define EXPERIMENT_CELL_KEYS_H

#include "experiment/experiment.h"

#include <stdbool.h>

enum { CELL_KEYS = 19, CELL_KEY_SIZE = 32 };

struct cell_key {
  const char *name;
  enum { KEY_NAME, KEY_COUNT, KEY_REAL } kind;
  bool always; // in the table of the terminal, even where all cells have the same
  // A real number with so many significant digits; 17 say which double it is. The result lies in
  // `buffer` or in the cell.
  const char *(*text)(const struct cell *, int digits, char buffer[CELL_KEY_SIZE]);
};
extern const struct cell_key cell_keys[CELL_KEYS];

#endif
