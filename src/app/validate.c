#include "app/validate.h"

#include "density/kernel.h"
#include "density/law.h"
#include "numeric/elementary.h"
#include "numeric/pair.h"
#include "numeric/rng.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

struct report {
  FILE *out;
  int checks, failures;
};

// The largest relative error of several values.
static double worse(double worst, double got, double want) {
  double error = got == want ? 0 : fabs(got - want) / fabs(want);
  return worst != worst || error <= worst ? worst : error; // a NaN is kept
}

__attribute__((format(printf, 4, 5))) static void check(struct report *report, double error,
                                                        double bound, const char *format, ...) {
  char what[128];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  bool ok = error <= bound;
  fprintf(report->out, "%-56s  %8.1e  %8.1e  %s\n", what, error, bound, ok ? "ok" : "FAIL");
  report->checks++;
  report->failures += !ok;
}

// ---- radius laws ----
enum { N_GOLDEN_I = 7, N_SUM = 1000 };
static const uint64_t golden_i[N_GOLDEN_I] = {
    2, 19, 20, 1000, 1000000, 1000000000, 1000000000000000};

// rho at golden_i to 20 digits (Gamma functions and powers in 120-digit arithmetic); alpha is the
// double nearest to what is written.
static const struct {
  const char *law;
  double alpha, rho[N_GOLDEN_I];
} golden_rho[] = {
    {"knaus-zwicker",
     0.5,
     {0.75, 0.25717064127093181, 0.25074137523915851, 0.035678022291708641, 0.0011283790260481255,
      3.5682482318595112e-5, 3.5682482323055418e-8}},
    {"knaus-zwicker",
     2.0 / 3,
     {0.83333333333333331, 0.41271620008741715, 0.40583759675262686, 0.1107609099759785,
      0.011077320443511336, 0.0011077321673093903, 1.1077321674324709e-5}},
    {"knaus-zwicker",
     0.7,
     {0.84999999999999998, 0.45247154811101746, 0.4456844748893522, 0.13853616347927961,
      0.017442499078489594, 0.0021958807638475741, 3.4802364744437525e-5}},
    {"knaus-zwicker",
     0.8,
     {0.90000000000000002, 0.59333744961032245, 0.58740407511421923, 0.26967245801247718,
      0.067744072171190702, 0.017016542930163892, 0.0010736712740308359}},
    {"knaus-zwicker",
     0.1,
     {0.55, 0.074087564790501358, 0.070753624374928797, 0.0020971996674732134,
      4.1846516053629888e-6, 8.3494780248056221e-9, 3.3239870722035487e-14}},
    {"knaus-zwicker",
     1e-12,
     {0.5000000000005, 0.052631578947552374, 0.050000000000177387, 0.0010000000000074845,
      1.0000000000143927e-6, 1.0000000000213005e-9, 1.000000000035116e-15}},
    {"power",
     0.5,
     {0.7071067811865475244, 0.22941573387056176591, 0.22360679774997896964, 0.03162277660168379332,
      0.001, 0.00003162277660168379332, 3.162277660168379332e-8}},
    {"power",
     2.0 / 3,
     {0.79370052598409971702, 0.37475617678431541454, 0.36840314986403861974,
      0.099999999999999974436, 0.0099999999999999948872, 0.00099999999999999923309,
      9.9999999999999872181e-6}},
    {"power",
     0.7,
     {0.81225239635623549761, 0.4134032815758320848, 0.40709053153690432638, 0.12589254117941668242,
      0.015848931924611125128, 0.0019952623149688777651, 0.000031622776601683744816}},
    {"power",
     0.8,
     {0.87055056329612416593, 0.55494415282835434834, 0.54928027165305894918,
      0.25118864315095808816, 0.063095734448019363655, 0.015848931924611149438,
      0.0010000000000000015338}},
    {"power",
     0.1,
     {0.53588673126814658417, 0.070651560576952885265, 0.067464142383678166878,
      0.0019952623149688796779, 3.981071705534972813e-6, 7.9432823472428159344e-9,
      3.1622776601683799383e-14}},
    {"power",
     1e-12,
     {0.50000000000034657359, 0.052631578947523391525, 0.050000000000149786614,
      0.0010000000000069077553, 1.0000000000138155106e-6, 1.0000000000207232658e-9,
      1.0000000000345387764e-15}},
};

// Knaus and Zwicker: sums of rho_i and of 1/rho_i over i = 1..N_SUM, which set bias and variance.
static const struct {
  double alpha, sum, inverse_sum;
} golden_sums[] = {
    {0.5, 69.391722605708992, 18703.991919818874}, {2.0 / 3, 164.75212587394374, 6777.61332683002},
    {0.7, 196.6187697053073, 5557.5770561845791},  {0.8, 336.11024497360893, 3092.59199539541},
    {0.1, 10.974093874399606, 251212.12970579357}, {1e-12, 7.4854708605775391, 500499.99999650427},
};

static void check_golden_laws(struct report *report) {
  for (size_t k = 0; k < sizeof golden_rho / sizeof golden_rho[0]; k++) {
    const struct law *law = law_find(golden_rho[k].law);
    double alpha = golden_rho[k].alpha, worst = 0;
    for (int j = 0; law && j < N_GOLDEN_I; j++)
      worst = worse(worst, law->rho(alpha, golden_i[j]), golden_rho[k].rho[j]);
    check(report, law ? worst : NAN, 2e-15, "law %s, alpha = %.4g: rho to i = 1e15",
          golden_rho[k].law, alpha);
  }
}

// The rounding of a thousand terms of one sign: at most 1000 ulp, in practice a few.
static void check_law_sums(struct report *report) {
  const struct law *law = law_find("knaus-zwicker");
  for (size_t k = 0; law && k < sizeof golden_sums / sizeof golden_sums[0]; k++) {
    double sum = 0, inverse_sum = 0;
    for (uint64_t i = 1; i <= N_SUM; i++) {
      double rho = law->rho(golden_sums[k].alpha, i);
      sum += rho;
      inverse_sum += 1 / rho;
    }
    double error =
        worse(worse(0, sum, golden_sums[k].sum), inverse_sum, golden_sums[k].inverse_sum);
    check(report, error, N_SUM * 0x1p-52, "law knaus-zwicker, alpha = %.4g: sums over i <= %d",
          golden_sums[k].alpha, N_SUM);
  }
}

// What every law promises: it starts at 1, falls as i^-measure_exponent, and radii are the roots.
static void check_law(struct report *report, const struct law *law) {
  static const double alphas[] = {0, 0.3, 0.5, 2.0 / 3, 0.8, 1};
  double start = 0, decay = 0, root = 0, constant = 0;
  for (size_t k = 0; k < sizeof alphas / sizeof alphas[0]; k++) {
    double alpha = alphas[k], rho = law->rho(alpha, 1000000000000000);
    start = worse(start, law->rho(alpha, 1), 1);
    if (law->rho(alpha, 2) == 0) continue; // no sequence
    double grown = rho * num_pow(1e15, law->measure_exponent(alpha));
    constant = worse(constant, grown, law->constant(alpha));
    double fall = num_pow(1e-3, law->measure_exponent(alpha)); // from 1e12 to 1e15
    decay = worse(decay, rho / law->rho(alpha, 1000000000000), fall);
    for (int d = 1; d <= 3; d++) {
      double r = law_radius(law, alpha, 1, d, 1000000000000000);
      root = worse(root, d == 1 ? r : d == 2 ? r * r : r * r * r, rho);
    }
  }
  check(report, start, 0, "law %s: rho_1 = 1", law->name);
  // Theory 2.1: the next term is alpha (1 - alpha) / (2 i) at most.
  check(report, decay, 1e-12, "law %s: decay is i^-measure_exponent", law->name);
  check(report, constant, 4e-15, "law %s: rho_i i^measure_exponent at i = 1e15", law->name);
  check(report, root, 2e-15, "law %s: r^d is rho r1^d, d = 1, 2, 3", law->name);
}

// ---- kernels ----
enum { N_NODES = 48 };
struct rule {
  double node[N_NODES], weight[N_NODES]; // on [0, 1]
};

// The Legendre polynomial of degree N_NODES at x, and its derivative.
static double legendre(double x, double *derivative) {
  double before = 1, p = x;
  for (int n = 2; n <= N_NODES; n++) {
    double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
    before = p;
    p = next;
  }
  *derivative = N_NODES * (x * p - before) / (x * x - 1);
  return p;
}

// Gauss and Legendre: exact for polynomials up to degree 95. Newton converges quadratically from
// Tricomi's estimate of the roots, right to 1e-3 or better: five steps are ample.
static void gauss_legendre(struct rule *rule) {
  for (int j = 0; j < N_NODES; j++) {
    double sine, x, slope;
    num_sincos_turns((4 * j + 3) / (8.0 * N_NODES + 4), &sine, &x);
    for (int step = 0; step < 5; step++) x -= legendre(x, &slope) / slope;
    legendre(x, &slope);
    rule->node[j] = 0.5 * (1 - x);
    rule->weight[j] = 1 / ((1 - x * x) * slope * slope);
  }
}

// In d dimensions, of |u|^power (psi / psi(0))^exponent over the unit ball.
static double ball_integral(const struct rule *rule, const struct kernel *kernel, int d, int power,
                            int exponent) {
  static const double sphere[] = {0, 2, 0x1.921fb54442d18p+2, 0x1.921fb54442d18p+3}; // 2, 2pi, 4pi
  double t2[N_NODES], w[N_NODES], sum = 0;
  for (int j = 0; j < N_NODES; j++) t2[j] = rule->node[j] * rule->node[j];
  kernel_weigh(kernel, t2, 1, w, N_NODES);
  for (int j = 0; j < N_NODES; j++) {
    double term = rule->weight[j] * w[j] * (exponent == 2 ? w[j] : 1);
    for (int k = 0; k < d - 1 + power; k++) term *= rule->node[j];
    sum += term;
  }
  return sphere[d] * sum;
}

static void check_kernel(struct report *report, const struct rule *rule,
                         const struct kernel *kernel, int d) {
  const double bound = 1e-10; // theory, A4
  struct kernel_constants of = kernel->constants(d);
  double one = of.c * ball_integral(rule, kernel, d, 0, 1);
  double mu2 = of.c * ball_integral(rule, kernel, d, 2, 1) / d;
  double roughness = of.c * of.c * ball_integral(rule, kernel, d, 0, 2);
  double roughness2 = of.c * of.c * ball_integral(rule, kernel, d, 2, 2);
  check(report, worse(0, one, 1), bound, "kernel %s, d = %d: integral 1", kernel->name, d);
  check(report, worse(0, of.mu2, mu2), bound, "kernel %s, d = %d: mu2", kernel->name, d);
  check(report, worse(0, of.roughness, roughness), bound, "kernel %s, d = %d: R", kernel->name, d);
  check(report, worse(0, of.roughness2, roughness2), bound, "kernel %s, d = %d: R2", kernel->name,
        d);
}

// ---- elementary functions and random numbers ----
static void check_functions(struct report *report) {
  const double ulp = 0x1p-52;
  double sine, cosine, error;
  error =
      worse(worse(0, num_exp(2.385), 10.859062664920514), num_exp(-37.2), 6.9862685086757042e-17);
  check(report, error, ulp, "exp");
  error = worse(worse(0, num_log(2.385), 0.86919912434030445), num_log(1e300), 690.77552789821371);
  check(report, error, ulp, "log");
  error = worse(worse(0, num_pow(1e15, 0.8), 1000000000000.0015), num_pow(0.9, 6000),
                2.8513900904532173e-275);
  check(report, error, ulp, "pow");
  check(report, worse(worse(0, num_cbrt(1e-15), 1e-5), num_cbrt(27), 3), ulp, "cbrt");
  num_sincos(45.553093477052, &sine, &cosine); // as near to 29 pi/2 as a double below 1e5 comes
  check(report, worse(worse(0, sine, 1), cosine, -6.1898063658835770e-19), ulp, "sin, cos");
  num_sincos_turns(1.0 / 3, &sine, &cosine);
  error = worse(worse(0, sine, 0.86602540378443871), cosine, -0.49999999999999990);
  check(report, error, ulp, "sin, cos of turns");
  check(report, worse(0, num_atan2(2.385, -1.7), 2.1900535527342505), ulp, "atan2");
  check(report, worse(0, num_acos(0.2385), 1.3299753419360803), ulp, "acos");
  check(report, worse(0, num_rgamma1p(0.5), 1.1283791670955126), ulp, "1/Gamma(1+a)");
}

// The compiler must not have reordered or fused (theory 7).
static void check_arithmetic(struct report *report) {
  volatile double one = 1, small = 0x1p-60, third = 1.0 / 3;
  struct pair sum = pair_sum(one, small), product = pair_product(third, third);
  check(report, worse(0, sum.lo, 0x1p-60), 0, "1 + 2^-60 keeps its low part");
  // The square of the double nearest to 1/3 less the double nearest to that, in exact integers.
  check(report, worse(0, product.lo, -0x1.c71c71c71c71cp-58), 0, "products are rounded, not fused");
}

static void check_random_numbers(struct report *report) {
  const uint32_t counter[4] = {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344};
  const uint32_t want[4] = {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
  const struct rng_key key = {{0xa4093822, 0x299f31d0}};
  uint32_t out[4];
  rng_philox(key, counter, out);
  check(report, memcmp(out, want, sizeof want) ? 1 : 0, 0, "Philox4x32-10: known answer");
  enum { N = 100 };
  uint64_t path[N];
  double u0[N], u1[N], v0, v1;
  int different = 0;
  for (int j = 0; j < N; j++) path[j] = 0x1fedcba9876 * (uint64_t)j;
  rng_fill(key, 0xabcdef012345, path, N, 7, u0, u1);
  for (int j = 0; j < N; j++) {
    rng_fill(key, 0xabcdef012345, &path[j], 1, 7, &v0, &v1);
    different += u0[j] != v0 || u1[j] != v1;
  }
  check(report, different, 0, "random numbers: arrays equal single ones");
}

bool validate_run(FILE *out) {
  struct report report = {.out = out};
  struct rule rule;
  fprintf(out, "%-56s  %8s  %8s\n", "relative error of", "is", "at most");
  check_arithmetic(&report);
  check_functions(&report);
  check_random_numbers(&report);
  check_golden_laws(&report);
  check_law_sums(&report);
  for (int l = 0; l < n_laws; l++) check_law(&report, &laws[l]);
  gauss_legendre(&rule);
  for (int k = 0; k < n_kernels; k++)
    for (int d = 1; d <= 3; d++) check_kernel(&report, &rule, &kernels[k], d);
  if (report.failures == 0)
    fprintf(out, "all %d checks ok\n", report.checks);
  else
    fprintf(out, "%d of %d checks FAIL\n", report.failures, report.checks);
  return report.failures == 0;
}
