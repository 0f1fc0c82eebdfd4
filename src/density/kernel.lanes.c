// The kernels. To add one, add a row: its shape on |u|^2 in [0, 1) and its constants.
#include "density/kernel.h"

#include "base/simd.h"
#include "numeric/elementary.h"
#include "numeric/lanes_exp.h"

#include <assert.h>
#include <math.h>

static const double pi = 0x1.921fb54442d18p+1;

static double ball_volume(int d) {
  assert(d >= 1 && d <= 3);
  return d == 1 ? 2 : d == 2 ? pi : 4 * pi / 3;
}

// ---- (1 - |u|^2)^s ----
static inline lanes box_shape(lanes t2) {
  (void)t2;
  return lanes_set(1);
}

static inline lanes epanechnikov_shape(lanes t2) { return 1 - t2; }
static inline lanes biweight_shape(lanes t2) { return (1 - t2) * (1 - t2); }
static inline lanes triweight_shape(lanes t2) { return (1 - t2) * (1 - t2) * (1 - t2); }

// c = Gamma(s + 1 + d/2) / (pi^(d/2) s!).
static double family_c(int s, int d) {
  double c = 1;
  for (int k = 1; k <= s; k++) c = c * (2 * k + d) / (2 * k);
  return c / ball_volume(d);
}

// psi_s^2 is a multiple of psi_2s.
static struct kernel_constants family_constants(int s, int d) {
  double c = family_c(s, d), roughness = c * c / family_c(2 * s, d);
  return (struct kernel_constants){
      .c = c,
      .mu2 = 1.0 / (d + 2 * s + 2),
      .roughness = roughness,
      .roughness2 = roughness * d / (d + 4 * s + 2),
  };
}

static struct kernel_constants box_constants(int d) { return family_constants(0, d); }
static struct kernel_constants epanechnikov_constants(int d) { return family_constants(1, d); }
static struct kernel_constants biweight_constants(int d) { return family_constants(2, d); }
static struct kernel_constants triweight_constants(int d) { return family_constants(3, d); }

// ---- 1 - |u| ----
static inline lanes cone_shape(lanes t2) { return 1 - lanes_sqrt(t2); }

static struct kernel_constants cone_constants(int d) {
  double volume = ball_volume(d), roughness = 2 * (d + 1) / ((d + 2) * volume);
  return (struct kernel_constants){
      .c = (d + 1) / volume,
      .mu2 = (d + 1.0) / ((d + 2) * (d + 3)),
      .roughness = roughness,
      .roughness2 = roughness * d * (d + 1) / ((d + 3) * (d + 4)),
  };
}

// ---- Gaussian cut at three standard deviations and normalised there ----
enum { CUT = 3 }; // sigma = radius / CUT

static inline lanes gaussian_shape(lanes t2) { return lanes_exp(-0.5 * CUT * CUT * t2); }

// Regularised lower incomplete gamma function P(twice_a / 2, x), its series of positive terms:
// x^a e^-x / Gamma(a + 1) (1 + x/(a+1) + x^2/((a+1)(a+2)) + ...).
static double incomplete_gamma(int twice_a, double x) {
  double factor = num_exp(-x) * (twice_a % 2 ? 2 * sqrt(x / pi) : x); // a = 1/2 or 1
  for (int k = twice_a % 2 ? 3 : 4; k <= twice_a; k += 2) factor = factor * x / (0.5 * k);
  double sum = 0, term = 1, a = 0.5 * twice_a;
  for (int k = 1; sum + term != sum; k++) {
    sum += term;
    term = term * x / (a + k);
  }
  return factor * sum;
}

static struct kernel_constants gaussian_constants(int d) {
  double x = 0.5 * CUT * CUT, inside = incomplete_gamma(d, x), c = 1 / inside, square = 1;
  for (int k = 0; k < d; k++) {
    c = c * CUT / sqrt(2 * pi);
    square = square * sqrt(pi) / CUT;
  }
  double inside2 = incomplete_gamma(d, 2 * x), roughness = c * c * square * inside2;
  return (struct kernel_constants){
      .c = c,
      .mu2 = incomplete_gamma(d + 2, x) / (CUT * CUT * inside),
      .roughness = roughness,
      .roughness2 = roughness * d / (2 * CUT * CUT) * incomplete_gamma(d + 2, 2 * x) / inside2,
  };
}

// ---- 1 - 10 t^3 + 15 t^4 - 6 t^5 = (1 - t)^3 (1 + 3 t + 6 t^2): two continuous derivatives ----
static inline lanes quintic_shape(lanes t2) {
  lanes t = lanes_sqrt(t2), rest = 1 - t;
  return rest * rest * rest * (1 + 3 * t + 6 * t2);
}

// Integral over [0, 1] of t^m w(t), by parts with w' = -30 t^2 (1 - t)^2.
static double quintic_moment(int m) { return 60.0 / ((m + 1) * (m + 4) * (m + 5) * (m + 6)); }

// Of t^m w(t)^2, with w^2 = (1 - t)^6 (1 + 6 t + 21 t^2 + 36 t^3 + 36 t^4) and the Beta integral
// of t^n (1 - t)^6 = 6! n! / (n + 7)!.
static double quintic_square_moment(int m) {
  static const double coefficient[] = {1, 6, 21, 36, 36};
  double sum = 0;
  for (int k = 0; k <= 4; k++) {
    double beta = 720;
    for (int j = 1; j <= 7; j++) beta /= m + k + j;
    sum += coefficient[k] * beta;
  }
  return sum;
}

static struct kernel_constants quintic_constants(int d) {
  double sphere = d * ball_volume(d), c = 1 / (sphere * quintic_moment(d - 1));
  return (struct kernel_constants){
      .c = c,
      .mu2 = quintic_moment(d + 1) / (d * quintic_moment(d - 1)),
      .roughness = c * c * sphere * quintic_square_moment(d - 1),
      .roughness2 = c * c * sphere * quintic_square_moment(d + 1),
  };
}

// ---- the table ----
typedef lanes shape_of(lanes t2);

static inline __attribute__((always_inline)) int weigh(shape_of *shape, const double *distance2,
                                                       double r, double *w, int n) {
  lanes inverse_r2 = lanes_set(1 / (r * r));
  int within = 0;
  for (int j = 0; j < n; j += LANES) {
    lanes_some mine = lanes_first(n - j);
    lanes t2 = lanes_load_where(mine, distance2 + j) * inverse_r2;
    lanes_some in = lanes_and(mine, lanes_less(t2, lanes_set(1)));
    lanes_store_where(mine, w + j, lanes_where(in, shape(lanes_where(in, t2))));
    within += lanes_count(in);
  }
  return within;
}

#define WEIGH(name)                                                                                \
  static int name##_weigh(const double *distance2, double r, double *w, int n) {                   \
    return weigh(name##_shape, distance2, r, w, n);                                                \
  }
WEIGH(box)
WEIGH(cone)
WEIGH(epanechnikov)
WEIGH(biweight)
WEIGH(triweight)
WEIGH(gaussian)
WEIGH(quintic)

// clang-format off
static const struct kernel rows[] = {
  {"box", "1", "Jensen 1996", box_weigh, box_constants},
  {"cone", "1 - t", "Jensen 1996 (k = 1)", cone_weigh, cone_constants},
  {"epanechnikov", "1 - t^2", "Epanechnikov 1969", epanechnikov_weigh, epanechnikov_constants},
  {"biweight", "(1 - t^2)^2", "Silverman 1986", biweight_weigh, biweight_constants},
  {"triweight", "(1 - t^2)^3", "Silverman 1986", triweight_weigh, triweight_constants},
  {"gaussian", "exp(-9 t^2 / 2)", "cut at 3 sigma, normalised", gaussian_weigh, gaussian_constants},
  {"quintic", "1 - 10 t^3 + 15 t^4 - 6 t^5", "Hachisuka, Jarosz, Jensen 2010", quintic_weigh,
   quintic_constants},
};
// clang-format on

SIMD_TABLES(kernel_level);
const struct kernel_level SIMD_NAME(kernel_level) = {rows, sizeof rows / sizeof rows[0]};
