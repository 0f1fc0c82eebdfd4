// Sine, cosine, and their inverses.
#include "numeric/elementary.h"
#include "numeric/pair.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#define NUMBER double
#include "numeric/circular_series.h"

// pi/2 in three parts; the first two have 36 bits, so that their products with k < 2^17 are exact.
#define HALF_PI_1 0x1.921fb54440000p+0
#define HALF_PI_2 0x1.68c234c4c0000p-39
#define HALF_PI_3 0x1.98a2e03707345p-77

static const struct pair two_pi = {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};

// Of k quarter turns and r more, |r| <= pi/4 (a rounding more does no harm).
static void sincos_quarter(int k, struct pair r, double *sine, double *cosine) {
  double s = sine_series(r.hi, r.lo), c = cosine_series(r.hi, r.lo);
  int quarter = k & 3;
  *sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
  *cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
}

void num_sincos(double x, double *sine, double *cosine) {
  assert(!(x < -1e5 || x > 1e5));
  if (x != x) {
    *sine = *cosine = x;
    return;
  }
  int k = (int)(x * 0x1.45f306dc9c883p-1 + (x < 0 ? -0.5 : 0.5)); // 2 / pi
  struct pair r = pair_sum(x - k * HALF_PI_1, -k * HALF_PI_2);    // the difference is exact
  struct pair rest = pair_sum(r.hi, -k * HALF_PI_3);
  sincos_quarter(k, pair_quick_sum(rest.hi, rest.lo + r.lo), sine, cosine);
}

void num_sincos_turns(double u, double *sine, double *cosine) {
  assert(!(u < -1e5 || u > 1e5));
  if (u != u) {
    *sine = *cosine = u;
    return;
  }
  // Of |u|, so that every difference is exact; 4 u + 1/2 would round.
  double a = u < 0 ? -u : u;
  int k = (int)(4 * a);
  if (4 * a - k > 0.5) k++;
  sincos_quarter(k, pair_scale(two_pi, a - 0.25 * k), sine, cosine);
  if (u < 0) *sine = -*sine;
}

// arctan(a / b) for 0 <= a <= b, b in [1/2, 2]. Turned back by arctan(c) with c = j/4 nearest to
// a / b, the vector (b, a) has a slope d of at most 1/8.
static struct pair arctan(struct pair a, struct pair b) {
  static const struct pair of_quarters[] = {
      {0, 0},
      {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
      {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
      {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
      {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
  };
  int j = (int)(4 * (a.hi / b.hi) + 0.5);
  double c = 0.25 * j;
  struct pair d = pair_divide(pair_add(a, pair_scale(b, -c)), pair_add(b, pair_scale(a, c)));
  double z = d.hi * d.hi, p = 1.0 / 21;
  for (int n = 19; n >= 3; n -= 2) p = 1.0 / n - p * z;
  return pair_add(of_quarters[j], pair_add(d, (struct pair){-d.hi * z * p, 0}));
}

// The angle in [0, pi] of a vector with a >= 0, the larger of a and |b| in [1/2, 2].
static double half_turn_angle(struct pair a, struct pair b) {
  const struct pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
  const struct pair pi = {2 * half_pi.hi, 2 * half_pi.lo};
  struct pair opposite = {-b.hi, -b.lo}, angle;
  if (b.hi >= a.hi) return arctan(a, b).hi;
  if (b.hi > -a.hi) {
    angle = b.hi >= 0 ? arctan(b, a) : arctan(opposite, a);
    if (b.hi >= 0) angle = (struct pair){-angle.hi, -angle.lo};
    return pair_add(half_pi, angle).hi;
  }
  angle = arctan(a, opposite);
  return pair_add(pi, (struct pair){-angle.hi, -angle.lo}).hi;
}

// x 2^-e with 2^e <= scale < 2^(e+1), scale >= |x|.
static double unit_scale(double x, double scale) {
  if (scale < 0x1p-1022) return unit_scale(x * 0x1p54, scale * 0x1p54);
  uint64_t bits;
  memcpy(&bits, &scale, sizeof bits);
  int exponent = (int)(bits >> 52) - 1023, half = exponent / 2;
  uint64_t first = (uint64_t)(1023 - half) << 52;
  uint64_t second = (uint64_t)(1023 - (exponent - half)) << 52;
  double factor[2];
  memcpy(&factor[0], &first, sizeof first);
  memcpy(&factor[1], &second, sizeof second);
  return x * factor[0] * factor[1];
}

double num_atan2(double y, double x) {
  if (x != x || y != y) return NAN;
  double a = signbit(y) ? -y : y, b = signbit(x) ? -x : x;
  double larger = a > b ? a : b, angle;
  if (larger == INFINITY) {
    a = a == INFINITY;
    b = b == INFINITY;
    larger = 1;
  }
  if (larger == 0) b = larger = 1;
  if (!signbit(x) && a < 0x1p-30 * b) {
    angle = a / b; // arctan t = t (1 - t^2/3 + ...); the scaled a might underflow
  } else {
    double scaled_b = unit_scale(b, larger);
    angle = half_turn_angle((struct pair){unit_scale(a, larger), 0},
                            (struct pair){signbit(x) ? -scaled_b : scaled_b, 0});
  }
  return signbit(y) ? -angle : angle;
}

// The angle of (x, sqrt((1 - x)(1 + x))), the root as a pair.
double num_acos(double x) {
  if (!(x >= -1 && x <= 1)) return NAN;
  struct pair square = pair_multiply(pair_sum(1, -x), pair_sum(1, x));
  double root = sqrt(square.hi);
  if (root == 0) return x > 0 ? 0 : 0x1.921fb54442d18p+1; // pi
  struct pair p = pair_product(root, root);
  double rest = ((square.hi - p.hi) - p.lo + square.lo) / (2 * root);
  return half_turn_angle(pair_quick_sum(root, rest), (struct pair){x, 0});
}
