// exp in the vector vocabulary (numeric/lanes.h): the bits of num_exp.
#ifndef NUMERIC_LANES_EXP_H
#define NUMERIC_LANES_EXP_H

#include "numeric/lanes.h"

// ln 2 = LN2_HI + LN2_LO; LN2_HI has 40 bits, so that its products with exponents are exact.
#define LN2_HI 0x1.62e42fefa2000p-1
#define LN2_LO 0x1.9ef35793c7673p-41

// exp(r) - 1 = r + r^2/2 + tail, |r| <= ln(2)/2: the tail's Taylor series, error below 2^-60.
static inline lanes exp_tail(lanes r) {
  lanes p = lanes_set(1.0 / 6227020800);
  p = p * r + 1.0 / 479001600;
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  return p * (r * r * r);
}

// num_exp(x), -700 <= x <= 0: exponential.c without what other arguments need.
static inline lanes lanes_exp(lanes x) {
  lanes k = lanes_truncate(x * (1 / (LN2_HI + LN2_LO)) - 0.5);
  lanes hi = x - k * LN2_HI, lo = 0 - k * LN2_LO; // the first difference is exact
  lanes r = hi + lo, part = r - hi, r_lo = (hi - (r - part)) + (lo - part);
  lanes s = 1 + r, s_lo = r - (s - 1);
  lanes small = exp_tail(r) + 0.5 * r * r + (r_lo + r_lo * r);
  return (s + (s_lo + small)) * lanes_power_of_two(k);
}

#endif
