// One line a check: a table for people, TAP for tests/run.
#ifndef TESTS_CONFORMANCE_REPORT_H
#define TESTS_CONFORMANCE_REPORT_H

#include <stdbool.h>

struct report {
  bool tap;
  int passed, failed, skipped;
};

enum verdict { FAILED, PASSED, SKIPPED };

void report_heading(struct report *, const char *format, ...) __attribute__((format(printf, 2, 3)));
void report_line(struct report *, enum verdict, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// The plan, or `N passed, N failed`; returns the exit status.
int report_end(struct report *);

#endif
