#include "analysis/chebyshev.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double chebyshev_value(const struct chebyshev *c, double x) {
  double y = 2 * x / c->hi - 1, b1 = 0, b2 = 0; // Clenshaw
  for (int k = CHEBYSHEV_TERMS - 1; k >= 1; k--) {
    double b = 2 * y * b1 - b2 + c->coefficient[k];
    b2 = b1, b1 = b;
  }
  return y * b1 - b2 + c->coefficient[0];
}

double chebyshev_node(double hi, int k) {
  return hi * (1 + cos(pi * (k + 0.5) / CHEBYSHEV_TERMS)) / 2;
}

struct chebyshev chebyshev_fit(double hi, const double value[CHEBYSHEV_TERMS]) {
  struct chebyshev c = {.hi = hi};
  for (int j = 0; j < CHEBYSHEV_TERMS; j++) {
    double sum = 0;
    for (int k = 0; k < CHEBYSHEV_TERMS; k++)
      sum += value[k] * cos(pi * j * (k + 0.5) / CHEBYSHEV_TERMS);
    c.coefficient[j] = (j ? 2 : 1) * sum / CHEBYSHEV_TERMS;
  }
  return c;
}

// In y = 2 x / hi - 1 the integral of T_k is (T_(k+1) / (k + 1) - T_(k-1) / (k - 1)) / 2 for k > 1,
// and T_1, T_2 / 4 for k = 0, 1; dx = hi / 2 dy. T_k(-1) = (-1)^k.
struct chebyshev chebyshev_integral(const struct chebyshev *c) {
  struct chebyshev out = {.hi = c->hi};
  double at_zero = 0;
  for (int k = 1; k < CHEBYSHEV_TERMS; k++) {
    double below = c->coefficient[k - 1] * (k == 1 ? 2 : 1);
    double above = k + 1 < CHEBYSHEV_TERMS ? c->coefficient[k + 1] : 0;
    out.coefficient[k] = c->hi / 2 * (below - above) / (2 * k);
    at_zero += k % 2 ? -out.coefficient[k] : out.coefficient[k];
  }
  out.coefficient[0] = -at_zero;
  return out;
}

bool chebyshev_converged(const struct chebyshev *c) {
  double largest = 0, last = 0;
  for (int k = 0; k < CHEBYSHEV_TERMS; k++) {
    largest = fmax(largest, fabs(c->coefficient[k]));
    if (k >= CHEBYSHEV_TERMS - 4) last = fmax(last, fabs(c->coefficient[k]));
  }
  return last <= 1e-13 * largest;
}
