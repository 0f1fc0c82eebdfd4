// Pictures for gnuplot, which reads no EXR.
#ifndef APP_PIXELS_H
#define APP_PIXELS_H

#include "base/arena.h"
#include "base/problem.h"

#include <stdbool.h>

// Writes images/NAME.csv for every images/NAME.exr of a results directory: x,y,R,G,B, a row for
// each pixel, from the top left. There may be none.
bool pixels_write(const char *directory, struct arena scratch, struct problem *);

#endif
