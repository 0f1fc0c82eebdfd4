#include "tests/conformance/report.h"

#include <stdarg.h>
#include <stdio.h>

void report_heading(struct report *report, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  printf("%s", report->tap ? "# " : "\n");
  vprintf(format, arguments);
  printf("\n");
  fflush(stdout);
  va_end(arguments);
}

void report_line(struct report *report, enum verdict verdict, const char *format, ...) {
  static const char *const words[] = {"FAILED", "passed", "skipped"};
  int *count[] = {&report->failed, &report->passed, &report->skipped};
  va_list arguments;
  va_start(arguments, format);
  ++*count[verdict];
  if (report->tap)
    printf("%sok %d - ", verdict == FAILED ? "not " : "",
           report->passed + report->failed + report->skipped);
  vprintf(format, arguments);
  if (!report->tap) printf("  %s", words[verdict]);
  if (report->tap && verdict == SKIPPED) printf(" # SKIP");
  printf("\n");
  fflush(stdout);
  va_end(arguments);
}

int report_end(struct report *report) {
  if (report->tap)
    printf("1..%d\n", report->passed + report->failed + report->skipped);
  else {
    printf("%d passed, %d failed", report->passed, report->failed);
    if (report->skipped) printf(", %d skipped", report->skipped);
    printf("\n");
  }
  return report->failed > 0;
}
