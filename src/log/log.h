// Writing a results directory (log/results.h reads it back).
#ifndef LOG_LOG_H
#define LOG_LOG_H

#include "log/results.h"

#include <stdio.h>

void log_write_header(FILE *);
// The rows of one series: an `iteration` row for each i, an `average` row for each checkpoint.
void log_write_series(FILE *, const struct cell *, const struct probe *, const struct series *);

void probes_write(FILE *, const struct cell *, const struct probe *, int n_probes);

#endif
