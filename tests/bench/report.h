// Where figures go: a table for people, CSV for programs.
#ifndef TESTS_BENCH_REPORT_H
#define TESTS_BENCH_REPORT_H

#include "tests/bench/clock.h"

#include <stdio.h>

// Processor, cores, compiler, flags, load: lines, each after `prefix`.
void report_machine(FILE *, const char *prefix);
void report_load(FILE *, const char *prefix, const char *when);

void report_csv_header(FILE *);
void report_csv(FILE *, const char *part, const struct row *, const struct figure *);

void report_table_header(const struct part_type *);
void report_table(const struct row *, const struct figure *);

// For parts of pairs.
void report_pairs_header(const struct part_type *);
void report_pair(const struct row *, const struct figure *, const struct figure *base);

#endif
