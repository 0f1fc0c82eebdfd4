// The radius laws. To add one, add a row.
#include "density/law.h"

#include "numeric/elementary.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static double fixed_rho(double alpha, uint64_t i) {
  (void)alpha, (void)i;
  return 1;
}

static double fixed_exponent(double alpha) {
  (void)alpha;
  return 0;
}

// ln(Gamma(w + t) / Gamma(w + 1 - t)) = (2t - 1) ln w - S with t = alpha/2, w = i + alpha/2:
// S = sum over m >= 1 of B_(2m+1)(t) / (m (2m + 1) w^2m); five terms leave less than 2^-60 for
// i >= 20. Every B_(2m+1)(t) has the factors t - 1/2 and q = t (1 - t).
static double knaus_zwicker_series(double alpha, double w) {
  double t = 0.5 * alpha, h = t - 0.5, q = t * (1 - t), z = 1 / (w * w);
  double s1 = -1.0 / 3;
  double s2 = (q + 1.0 / 3) / 10;
  double s3 = -((q + 1) * q + 1.0 / 3) / 21;
  double s4 = (((q + 2) * q + 9.0 / 5) * q + 3.0 / 5) / 36;
  double s5 = -((((q + 10.0 / 3) * q + 17.0 / 3) * q + 5) * q + 5.0 / 3) / 55;
  return h * q * z * (s1 + z * (s2 + z * (s3 + z * (s4 + z * s5))));
}

// Gamma(i + alpha) / (Gamma(1 + alpha) Gamma(i + 1)) = product over k = 1..i-1 of
// (k + alpha)/(k + 1). Neither lgamma nor the recurrence survives large i (theory 2.5).
static double knaus_zwicker_rho(double alpha, uint64_t i) {
  if (alpha == 1) return 1;
  if (i < 20) {
    double rho = 1;
    for (uint64_t k = 1; k < i; k++) rho *= ((double)k + alpha) / ((double)k + 1);
    return rho;
  }
  double w = (double)i + 0.5 * alpha;
  // w^alpha / w, not w^(alpha - 1): alpha is exact, alpha - 1 may round.
  return num_pow(w, alpha) / w * num_exp(-knaus_zwicker_series(alpha, w)) * num_rgamma1p(alpha);
}

static double power_rho(double alpha, uint64_t i) {
  if (alpha == 1) return 1;
  return num_pow((double)i, alpha) / (double)i;
}

static double shrinking_exponent(double alpha) { return 1 - alpha; }

static double one(double alpha) {
  (void)alpha;
  return 1;
}

// The fraction alpha of the m photons found is kept, and the radius shrinks so that their density
// stays.
static double keep_fraction(double alpha, double n, double m, double *ratio) {
  double kept = n + alpha * m;
  *ratio = m > 0 ? kept / (n + m) : 1;
  return kept;
}

// All of the first pass that finds photons is counted, the fraction alpha of each: Hachisuka,
// Ogaki, Jensen 2008. N = (1 + alpha) M after it, as if a pass before had found as many.
static double hachisuka_count(double alpha, double n, double m, double *ratio) {
  return keep_fraction(alpha, n == 0 ? m : n, m, ratio);
}

// pbrt's renderers start with N = 0, so that the first pass already shrinks by alpha: from then on
// the sequence is that of knaus-zwicker times alpha.
static double pbrt_rho(double alpha, uint64_t i) {
  return i == 1 ? 1 : alpha * knaus_zwicker_rho(alpha, i - 1);
}

static double pbrt_constant(double alpha) { return alpha * num_rgamma1p(alpha); }

// clang-format off
const struct law laws[] = {
  {"fixed", "1", "no reduction", fixed_rho, fixed_exponent, "1", one, NULL},
  {"knaus-zwicker", "product over k < i of (k + alpha)/(k + 1)", "Knaus and Zwicker 2011",
   knaus_zwicker_rho, shrinking_exponent, "1/Gamma(1 + alpha)", num_rgamma1p, NULL},
  {"power", "i^(alpha - 1)", "Georgiev et al. 2012",
   power_rho, shrinking_exponent, "1", one, NULL},
  {"smallvcm", "i^(alpha - 1), the same as power",
   "SmallVCM (alpha = 0.75 and a least radius of 1e-7 there)",
   power_rho, shrinking_exponent, "1", one, NULL},
  {"hachisuka", "local: (N + alpha M)/(N + M) a pass, N = M at first",
   "Hachisuka, Ogaki and Jensen 2008",
   knaus_zwicker_rho, shrinking_exponent, "1/Gamma(1 + alpha)", num_rgamma1p, hachisuka_count},
  {"pbrt", "local: (N + alpha M)/(N + M) a pass, N = 0 at first",
   "pbrt-v3 and pbrt-v4 (alpha = 2/3 there)",
   pbrt_rho, shrinking_exponent, "alpha/Gamma(1 + alpha)", pbrt_constant, keep_fraction},
};
// clang-format on
const int n_laws = sizeof laws / sizeof laws[0];

const struct law *law_find(const char *name) {
  for (int k = 0; k < n_laws; k++)
    if (strcmp(laws[k].name, name) == 0) return &laws[k];
  return NULL;
}

double radius_root(double rd, int d) { return d == 1 ? rd : d == 2 ? sqrt(rd) : num_cbrt(rd); }

double law_radius(const struct law *law, double alpha, double r1, int d, uint64_t i) {
  assert(alpha >= 0 && alpha <= 1 && i >= 1 && d >= 1 && d <= 3);
  double rho = law->rho(alpha, i);
  return r1 * radius_root(rho, d);
}
