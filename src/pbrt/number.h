// Decimal numbers of text, exactly rounded and whatever the locale.
#ifndef PBRT_NUMBER_H
#define PBRT_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

// The number written as [+-]digits[.digits][e[+-]digits] in all of text[0, length). False if it is
// not that; *value is infinite where a double cannot hold it. text[length] must exist and not
// continue a number (a zero, a space, a bracket).
bool number_scan(const char *text, ptrdiff_t length, double *value);

#endif
