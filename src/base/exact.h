// The functions of libm that IEEE 754 defines to the last bit, as instructions. -fno-builtin, which
// keeps compilers from folding the others differently from what the run time gives, would make calls
// of these too (a loop of normalisations took 1.6 times as long). Needs -fno-math-errno.
#ifndef BASE_EXACT_H
#define BASE_EXACT_H

#include <math.h>

#define sqrt(x) __builtin_sqrt(x)
#define fabs(x) __builtin_fabs(x)

#endif
