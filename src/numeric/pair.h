// Numbers of about 106 bits as an unevaluated sum of two doubles (Dekker 1971), for the elementary
// functions. Needs round to nearest, no contraction, and double evaluated as double.
#ifndef NUMERIC_PAIR_H
#define NUMERIC_PAIR_H

#include <float.h>

_Static_assert(FLT_EVAL_METHOD == 0, "double must be evaluated as double (SSE2, not x87)");

struct pair {
  double hi, lo; // hi is the double nearest to hi + lo
};

// a + b exactly, |a| >= |b| or a = 0.
static inline struct pair pair_quick_sum(double a, double b) {
  double s = a + b;
  return (struct pair){s, b - (s - a)};
}

// a + b exactly (Knuth).
static inline struct pair pair_sum(double a, double b) {
  double s = a + b, b_part = s - a;
  return (struct pair){s, (a - (s - b_part)) + (b - b_part)};
}

// a b exactly (Dekker, Veltkamp); needs |a|, |b| < 2^996 and no underflow of the low part.
static inline struct pair pair_product(double a, double b) {
  double ta = 0x1.0000002p27 * a, tb = 0x1.0000002p27 * b; // 2^27 + 1
  double a1 = ta - (ta - a), b1 = tb - (tb - b), a2 = a - a1, b2 = b - b1;
  double p = a * b;
  return (struct pair){p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

// The following are right to a few units of 2^-104.
static inline struct pair pair_add(struct pair a, struct pair b) {
  struct pair s = pair_sum(a.hi, b.hi), t = pair_sum(a.lo, b.lo);
  s = pair_quick_sum(s.hi, s.lo + t.hi);
  return pair_quick_sum(s.hi, s.lo + t.lo);
}

static inline struct pair pair_scale(struct pair a, double s) {
  struct pair p = pair_product(a.hi, s);
  return pair_quick_sum(p.hi, p.lo + a.lo * s);
}

static inline struct pair pair_multiply(struct pair a, struct pair b) {
  struct pair p = pair_product(a.hi, b.hi);
  return pair_quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

static inline struct pair pair_divide(struct pair a, struct pair b) {
  double q = a.hi / b.hi;
  struct pair p = pair_product(q, b.hi);
  return pair_quick_sum(q, (((a.hi - p.hi) - p.lo) + (a.lo - q * b.lo)) / b.hi);
}

#endif
