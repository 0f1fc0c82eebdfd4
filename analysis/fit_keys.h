// What tells the cells of an experiment apart: one table for the terminal, fit.json and curves.csv.
#ifndef ANALYSIS_FIT_KEYS_H
#define ANALYSIS_FIT_KEYS_H

#include "experiment/experiment.h"

#include <stdbool.h>

enum { FIT_KEYS = 14, FIT_KEY_SIZE = 32 };

struct fit_key {
  const char *name;
  enum { KEY_NAME, KEY_COUNT, KEY_REAL } kind;
  bool always; // in the table of the terminal, even where all cells have the same
  // A real number with so many significant digits; 17 say which double it is. The result lies in
  // `buffer` or in the cell.
  const char *(*text)(const struct cell *, int digits, char buffer[FIT_KEY_SIZE]);
};
extern const struct fit_key fit_keys[FIT_KEYS];

#endif
