// The built-in checks: radius laws, kernels, elementary functions and random numbers of this very
// binary against closed forms and 60-digit values.
#ifndef APP_VALIDATE_H
#define APP_VALIDATE_H

#include <stdbool.h>
#include <stdio.h>

// Prints a line per check (its relative error, the bound, ok or FAIL) and a last one; true: all ok.
bool validate_run(FILE *out);

#endif
