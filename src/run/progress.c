#define _GNU_SOURCE // clock_gettime, isatty
#include "run/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

double progress_clock_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

struct progress progress_begin(const char *what, double total, double already, bool quiet) {
  double now = progress_clock_s();
  return (struct progress){.what = what,
                           .total = total,
                           .done = already,
                           .resumed = already,
                           .started_s = now,
                           .printed_s = now,
                           .quiet = quiet,
                           .terminal = isatty(STDERR_FILENO)};
}

static void progress_print(struct progress *progress, double now) {
  double worked = progress->done - progress->resumed, elapsed = now - progress->started_s;
  double rest = progress->total - progress->done; // rounding may leave it below zero
  double left = worked > 0 && rest > 0 ? elapsed * rest / worked : 0;
  fprintf(stderr, "%s%s: %5.1f %%, %.0f s elapsed, about %.0f s left%s",
          progress->terminal ? "\r" : "", progress->what, 100 * progress->done / progress->total,
          elapsed, left, progress->terminal ? "   " : "\n");
  fflush(stderr);
  progress->printed_s = now;
  progress->printed = true;
}

void progress_advance(struct progress *progress, double work) {
#pragma omp critical(progress)
  {
    progress->done += work;
    double now = progress_clock_s(), every = progress->terminal ? 0.25 : 5;
    if (!progress->quiet && now - progress->printed_s >= every) progress_print(progress, now);
  }
}

void progress_end(struct progress *progress) {
  if (progress->quiet || !progress->printed) return;
  progress_print(progress, progress_clock_s());
  if (progress->terminal) fputc('\n', stderr);
}
