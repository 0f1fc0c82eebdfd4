#define _GNU_SOURCE // strtod_l
#include "pbrt/number.h"

#include <float.h>
#include <locale.h>
#include <stdint.h>
#include <stdlib.h>

_Static_assert(FLT_EVAL_METHOD == 0,
               "one rounding per operation, or results depend on the machine");

// The number is negative ? -digits : digits, times 10^exponent.
struct decimal {
  bool negative, exact; // exact: all digits are in `digits`
  uint64_t digits;
  int n_digits;
  long exponent;
};

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static void push_digit(struct decimal *d, char c, bool fraction) {
  d->n_digits++;
  if (d->digits > (UINT64_MAX - 9) / 10) {
    d->exact = false;
    return;
  }
  d->digits = 10 * d->digits + (uint64_t)(c - '0');
  if (fraction) d->exponent--;
}

// [+-]digits at `at`; a silly exponent stays at a value that leaves no doubt.
static const char *scan_exponent(const char *at, const char *end, struct decimal *d) {
  bool negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+')) at++;
  if (at == end || !is_digit(*at)) return NULL;
  long exponent = 0;
  for (; at < end && is_digit(*at); at++)
    if (exponent < 100000000) exponent = 10 * exponent + (*at - '0');
  d->exponent += negative ? -exponent : exponent;
  return at;
}

static bool scan_decimal(const char *at, const char *end, struct decimal *d) {
  *d = (struct decimal){.exact = true};
  d->negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+')) at++;
  for (; at < end && is_digit(*at); at++) push_digit(d, *at, false);
  if (at < end && *at == '.')
    for (at++; at < end && is_digit(*at); at++) push_digit(d, *at, true);
  if (d->n_digits == 0) return false;
  if (at < end && (*at == 'e' || *at == 'E')) at = scan_exponent(at + 1, end, d);
  return at == end;
}

// Every C locale but "C" may read another decimal point.
static double scan_slowly(const char *text) {
  locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  double value = strtod_l(text, NULL, c);
  freelocale(c);
  return value;
}

bool number_scan(const char *text, ptrdiff_t length, double *value) {
  static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  struct decimal d;
  if (!scan_decimal(text, text + length, &d)) return false;
  // Both factors are exact doubles, so one operation rounds once (Clinger 1990).
  if (d.exact && d.digits <= (uint64_t)1 << 53 && d.exponent >= -22 && d.exponent <= 22) {
    double digits = (double)d.digits;
    double magnitude = d.exponent < 0 ? digits / power[-d.exponent] : digits * power[d.exponent];
    *value = d.negative ? -magnitude : magnitude;
  } else {
    *value = scan_slowly(text);
  }
  return true;
}
