// Progress on stderr: one line rewritten on a terminal, a line every few seconds elsewhere.
#ifndef RUN_PROGRESS_H
#define RUN_PROGRESS_H

#include <stdbool.h>

struct progress {
  const char *what;
  double total, done; // in units of expected work
  double started_s, printed_s, resumed;
  bool quiet, terminal, printed;
};

double progress_clock_s(void); // monotonic

struct progress progress_begin(const char *what, double total, double already, bool quiet);
void progress_advance(struct progress *, double work); // thread safe
void progress_end(struct progress *);

#endif
