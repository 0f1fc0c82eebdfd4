// The error function.
#include "numeric/elementary.h"

// erf x = 2 / sqrt(pi) exp(-x^2) (x + 2 x^3 / 3 + 4 x^5 / 15 + ...) (Abramowitz & Stegun 7.1.6):
// all terms have one sign. Beyond 6 it is 1 in double, and terms fall by 2/3 or more at last.
double num_erf(double x) {
  if (x < 0) return -num_erf(-x);
  if (!(x < 6)) return x == x ? 1 : x;
  double term = x, sum = x;
  for (int n = 1; term > 0x1p-55 * sum; n++) {
    term *= 2 * x * x / (2 * n + 1);
    sum += term;
  }
  return 0x1.20dd750429b6dp+0 * num_exp(-x * x) * sum;
}
