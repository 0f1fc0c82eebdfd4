// runs.csv, of cells with `keep: runs`: for each cell, probe, checkpoint and run the running
// average (and, where there are biases by Richardson, theirs). Eight bytes a value in memory and
// about 40 in the file, 10 checkpoints a decade: what a bootstrap of the averages' variance and
// bias needs. One of the fits of single iterations would need all iterations, 35 times as much at N
// = 1000.
#ifndef LOG_RUNS_H
#define LOG_RUNS_H

#include "log/results.h"

#include <stdio.h>

bool runs_are_kept(const struct experiment *);

void runs_write_header(FILE *);
// `value` of run `run` at the series' checkpoints; name: average or richardson.
void runs_write(FILE *, const struct series *, const char *name, uint64_t run, const double *value);

// Into the results' series, whose checkpoints are known. `sum`: the file's, as in the manifest.
bool runs_read(const char *path, uint64_t sum, struct arena *, struct results *, struct problem *);

#endif
