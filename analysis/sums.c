// Theory 3.1: telescoping sums of rho_i = Gamma(i + alpha) / (Gamma(1 + alpha) Gamma(i + 1)) and
// the Euler-Maclaurin tail of their general power.
#include "analysis/sums.h"

#include "analysis/special.h"

#include <assert.h>
#include <float.h>
#include <math.h>

static const struct law *knaus_zwicker(void) {
  const struct law *law = law_find("knaus-zwicker");
  assert(law);
  return law;
}

double sums_minus(double alpha, uint64_t n) {
  double last = knaus_zwicker()->rho(alpha, n);
  return (((double)n + 1) / last - alpha) / (2 - alpha);
}

// log(1 + x) / x and (e^x - 1) / x; below DBL_EPSILON the next term of either is lost in rounding.
static double log1p_ratio(double x) { return fabs(x) < DBL_EPSILON ? 1 : log1p(x) / x; }
static double expm1_ratio(double x) { return fabs(x) < DBL_EPSILON ? 1 : expm1(x) / x; }

// ln Gamma(1 + a) / a. The series' terms fall as a^k: 30 of them reach 1e-17 at a = 0.3.
static double lgamma1p_ratio(double a) {
  if (a > 0.3) return lgamma(1 + a) / a;
  double sum = 0;
  for (int k = 32; k >= 2; k--) sum = special_zeta(k) * (k % 2 ? -1 : 1) / k + a * sum;
  const double euler_gamma = 0.57721566490153286061;
  return -euler_gamma + a * sum;
}

// ln(Gamma(n + 1 + a) / Gamma(n + 1) / Gamma(1 + a)) / a, finite at a = 0.
static double log_growth_ratio(double a, uint64_t n) {
  if (n < 20) {
    double sum = 0;
    for (uint64_t k = n; k >= 1; k--) sum += log1p_ratio(a / (double)k) / (double)k;
    return sum;
  }
  double w = (double)n + (1 + a) / 2, q = (1 - a * a) / 4, z = 1 / (w * w);
  double c2 = q * (q + 1.0 / 3) / 10;
  double c3 = -q * (q * q + q + 1.0 / 3) / 21;
  double c4 = q * (((q + 2) * q + 9.0 / 5) * q + 3.0 / 5) / 36;
  double c5 = -q * ((((q + 10.0 / 3) * q + 17.0 / 3) * q + 5) * q + 5.0 / 3) / 55;
  double series = z * (-q / 3 + z * (c2 + z * (c3 + z * (c4 + z * c5)))) / 2;
  return log(w) - series - lgamma1p_ratio(a);
}

double sums_plus(double alpha, uint64_t n) {
  double growth = log_growth_ratio(alpha, n);
  return growth * expm1_ratio(alpha * growth);
}

// Over from < i <= to.
static double direct(const struct law *law, double alpha, double p, uint64_t from, uint64_t to) {
  double sum = 0, lost = 0; // Neumaier: the rounding of each addition is kept
  for (uint64_t i = from + 1; i <= to; i++) {
    double term = pow(law->rho(alpha, i), p), next = sum + term;
    lost += fabs(sum) >= fabs(term) ? (sum - next) + term : (term - next) + sum;
    sum = next;
  }
  return sum + lost;
}

double sums_direct(const struct law *law, double alpha, double p, uint64_t n) {
  return direct(law, alpha, p, 0, n);
}

// The tail's primitive without its leading term, at w = n + (1 + alpha) / 2.
static double tail_correction(double b, double e1, double e2, double w) {
  double f1 = b * pow(w, b - 1) + e1 * (b - 2) * pow(w, b - 3);
  double f3 = b * (b - 1) * (b - 2) * pow(w, b - 3);
  return e1 * pow(w, b - 1) / (b - 1) + e2 * pow(w, b - 3) / (b - 3) - f1 / 24 + 7 * f3 / 5760;
}

double sums_power(double alpha, double p, uint64_t n) {
  const uint64_t direct = 2000; // where the tail's next term is below 1e-15
  double head = sums_direct(knaus_zwicker(), alpha, p, n < direct ? n : direct);
  if (n <= direct) return head;
  double t = alpha / 2, b = p * (alpha - 1);
  double bernoulli3 = t * (t * (t - 1.5) + 0.5);
  double bernoulli5 = t * (t * t * (t * (t - 2.5) + 5.0 / 3) - 1.0 / 6);
  double e1 = -p * bernoulli3 / 3, e2 = -p * bernoulli5 / 10 + e1 * e1 / 2;
  double w0 = (double)direct + (1 + alpha) / 2, w = (double)n + (1 + alpha) / 2;
  double decades = log(w / w0);
  double leading = pow(w0, b + 1) * decades * expm1_ratio((b + 1) * decades); // also at b = -1
  double rest = tail_correction(b, e1, e2, w) - tail_correction(b, e1, e2, w0);
  return head + pow(tgamma(1 + alpha), -p) * (leading + rest);
}

// ---- any law ----

enum { STEPS = 64, LEVELS = 5 }; // of a block: 64 steps, then every 2nd, 4th, 8th and 16th

// Over from < i <= from + STEPS * step. Trapezoid sums with steps of h are a series in h^2 (Euler
// and Maclaurin): extrapolated to h = 1 they are the sum over all integers. *error: what the
// coarsest level still changed. Blocks that no more than double i leave less than 1e-14 of a power
// of i.
static double block_sum(const struct law *law, double alpha, double p, uint64_t from, uint64_t step,
                        double *error) {
  double term[STEPS + 1], level[LEVELS], h = (double)step;
  for (int k = 0; k <= STEPS; k++) term[k] = pow(law->rho(alpha, from + (uint64_t)k * step), p);
  double ends = (term[0] + term[STEPS]) / 2, before = 0;
  for (int l = 0; l < LEVELS; l++) {
    int stride = 1 << l;
    double inside = 0;
    for (int k = stride; k < STEPS; k += stride) inside += term[k];
    level[l] = h * stride * (ends + inside);
  }
  for (int m = 1; m < LEVELS; m++) { // Neville, in (h / step)^2
    before = level[0];
    for (int l = 0; l + m < LEVELS; l++) {
      double near = ldexp(1, 2 * l), far = ldexp(1, 2 * (l + m)), at = 1 / (h * h);
      level[l] += (level[l + 1] - level[l]) * (at - near) / (far - near);
    }
  }
  *error = fabs(level[0] - before);
  return level[0] + (term[STEPS] - term[0]) / 2;
}

// Blocks are halved where rho is not smooth enough for them, down to those of single terms.
static double sums_in_blocks(const struct law *law, double alpha, double p, uint64_t n) {
  uint64_t at = 4 * STEPS;
  if (n <= at) return sums_direct(law, alpha, p, n);
  double sum = sums_direct(law, alpha, p, at), error;
  while (n - at >= STEPS) {
    uint64_t step = (n - at < at ? n - at : at) / STEPS;
    double block = block_sum(law, alpha, p, at, step, &error);
    while (step > 1 && error > 1e-12 * fabs(sum + block)) {
      step /= 2;
      block = block_sum(law, alpha, p, at, step, &error);
    }
    sum += block, at += STEPS * step;
  }
  return sum + direct(law, alpha, p, at, n);
}

double sums_law(const struct law *law, double alpha, double p, uint64_t n) {
  if (p == 0) return (double)n;
  if (law->rho != knaus_zwicker()->rho) return sums_in_blocks(law, alpha, p, n);
  if (p == 1) return sums_plus(alpha, n);
  if (p == -1) return sums_minus(alpha, n);
  return sums_power(alpha, p, n);
}
