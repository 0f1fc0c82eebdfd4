// exp, log, pow and cbrt. The logarithm is computed to about 100 bits and the exponential takes its
// argument as a pair, so that pow keeps its accuracy where |y ln x| is large; the others are
// special cases of the same two functions.
#include "numeric/elementary.h"
#include "numeric/lanes_exp.h"
#include "numeric/pair.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

// 2^k, -1022 <= k <= 1023.
static double power_of_two(int k) {
  uint64_t bits = (uint64_t)(k + 1023) << 52;
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

// x 2^k, -2044 <= k <= 2046; a subnormal result is rounded once from x.
static double scale_by_two(double x, int k) {
  int half = k / 2;
  if (k < 0) half = k < -1000 ? k + 1000 : 0; // the last factor alone may be inexact
  return x * power_of_two(half) * power_of_two(k - half);
}

// exp(x.hi + x.lo), below 0.6 ulp in the normal range.
static double exp_pair(struct pair x) {
  if (x.hi != x.hi) return x.hi;
  if (x.hi > 710) return INFINITY;
  if (x.hi < -746) return 0;
  double scaled = x.hi * (1 / (LN2_HI + LN2_LO));
  int k = (int)(scaled + (scaled < 0 ? -0.5 : 0.5));
  struct pair r = pair_sum(x.hi - k * LN2_HI, x.lo - k * LN2_LO); // the first difference is exact
  struct pair s = pair_quick_sum(1, r.hi);
  double small = exp_tail(lanes_set(r.hi))[0] + 0.5 * r.hi * r.hi + (r.lo + r.lo * r.hi);
  return scale_by_two(s.hi + (s.lo + small), k);
}

// x = m 2^k with m in [sqrt(1/2), sqrt(2)), x positive and finite.
static double split_exponent(double x, int *k) {
  int subnormal = x < 0x1p-1022 ? 54 : 0;
  if (subnormal) x *= 0x1p54;
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  *k = (int)(bits >> 52) - 1023 - subnormal;
  bits = (bits & 0xfffffffffffff) | (uint64_t)1023 << 52;
  double m;
  memcpy(&m, &bits, sizeof m);
  if (m < 0x1.6a09e667f3bcdp0) return m; // sqrt(2)
  ++*k;
  return 0.5 * m;
}

// ln x to about 2^-98 relative, x positive and finite: with m = (1 + s)/(1 - s),
// ln m = 2 (s + s^3/3 + s^5/5 + ...), |s| < 0.172. Terms from s^7 on are below 2^-15 of the
// first, so a double holds them to 2^-68; those before are pairs.
static struct pair log_pair(double x) {
  int k;
  double f = split_exponent(x, &k) - 1; // exact
  struct pair s = pair_divide((struct pair){f, 0}, pair_sum(2, f));
  struct pair z = pair_multiply(s, s);
  double p = 1.0 / 31;
  for (int n = 29; n >= 7; n -= 2) p = p * z.hi + 1.0 / n;
  const struct pair third = {0x1.5555555555555p-2, 0x1.5555555555555p-56};
  const struct pair fifth = {0x1.999999999999ap-3, -0x1.999999999999ap-57};
  struct pair series = pair_add(fifth, pair_scale(z, p));
  series = pair_add(third, pair_multiply(z, series));
  series = pair_add(s, pair_multiply(pair_multiply(s, z), series));
  struct pair power = pair_quick_sum(k * LN2_HI, k * LN2_LO);
  return pair_add(power, (struct pair){2 * series.hi, 2 * series.lo});
}

double num_exp(double x) { return exp_pair((struct pair){x, 0}); }

double num_log(double x) {
  if (x == 0) return -INFINITY;
  if (x < 0) return NAN;
  if (!(x < INFINITY)) return x;
  return log_pair(x).hi;
}

double num_pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (x != x || y != y || x < 0) return NAN;
  if (x == 0 || x == INFINITY) return (x > 0) == (y > 0) ? INFINITY : 0;
  struct pair log = log_pair(x);
  double product = y * log.hi;
  if (product > 710) return INFINITY;
  if (product < -746) return 0;
  return exp_pair(pair_scale(log, y)); // |y| < 746 / 2^-53 here: nothing overflows
}

double num_cbrt(double x) {
  if (x == 0 || x != x || x == INFINITY || x == -INFINITY) return x;
  double root = exp_pair(pair_divide(log_pair(x < 0 ? -x : x), (struct pair){3, 0}));
  return x < 0 ? -root : root;
}
