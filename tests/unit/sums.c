// The sums of rho_i against 60-digit values (theory, Appendix A), long direct sums, and the slopes
// an ordinary straight line sees in the exact curves (theory 3.4).
#include "analysis/sums.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

static void assert_relative(double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance * fabs(expected)))
    fail_msg("%.17g, not %.17g within %g", measured, expected, tolerance);
}

static const struct golden {
  double alpha;
  uint64_t n;
  double plus, minus;
} golden[] = {
    {0.5, 2, 1.75, 2.3333333333333333},
    {0.5, 10, 5.4002761840820313, 20.476700801778201},
    {0.5, 19, 8.0296550095663406, 51.512916563001198},
    {0.5, 20, 8.2803963848054991, 55.501089631950008},
    {0.5, 100, 20.652088561721082, 597.13916740863361},
    {0.5, 1000, 69.391722605708992, 18703.991919818874},
    {0.5, 1000000, 2254.7591804752771, 590818614.6387779},
    {0.5, 1000000000, 71362.964672872706, 18683304075678.146},
    {0.5, 1000000000000000, 71364962.646110871, 1.8683304054659783e+22},
    {2.0 / 3, 2, 1.8333333333333333, 2.2},
    {2.0 / 3, 10, 6.6362534442518859, 15.723683407165197},
    {2.0 / 3, 19, 10.675127902578806, 35.844587386739022},
    {2.0 / 3, 20, 11.080965499331433, 38.308627209568786},
    {2.0 / 3, 100, 34.496706616292327, 317.25823610549358},
    {2.0 / 3, 1000, 164.75212587394374, 6777.61332683002},
    {2.0 / 3, 1000000, 16614.491742587449, 67705971.700101989},
    {2.0 / 3, 1000000000, 1661596.7520718177, 677058970464.98845},
    {2.0 / 3, 1000000000000000, 16615982509.987076, 6.770589697132018e+19},
    {0.7, 2, 1.85, 2.1764705882352941},
    {0.7, 10, 6.9152757803213612, 14.962860106403836},
    {0.7, 19, 11.305270711124349, 33.462826385261452},
    {0.7, 20, 11.750955186013701, 35.706566197486827},
    {0.7, 100, 38.298310648053576, 280.79731973518716},
    {0.7, 1000, 196.6187697053073, 5557.5770561845791},
    {0.7, 1000000, 24916.444697484215, 44100992.960237779},
    {0.7, 1000000000, 3136971.0934067011, 350306256452.18928},
    {0.7, 1000000000000000, 49717663919.196502, 2.2102830508197476e+19},
    {0.8, 2, 1.9, 2.1111111111111111},
    {0.8, 10, 7.8233228185600004, 12.97221761802585},
    {0.8, 19, 13.43510187785548, 27.423026100261478},
    {0.8, 20, 14.022505952969699, 29.125431722499548},
    {0.8, 100, 52.563940181776481, 196.40122994483755},
    {0.8, 1000, 336.11024497360893, 3092.59199539541},
    {0.8, 1000000, 84678.907958060544, 12301210.936922997},
    {0.8, 1000000000, 21270677.429721407, 48971952621.359867},
    {0.8, 1000000000000000, 1342089092537.2958, 7.7615314248353527e+17},
    {0.1, 2, 1.55, 2.8181818181818182},
    {0.1, 10, 3.3045638589926563, 43.897463163168891},
    {0.1, 19, 4.1507248749857592, 142.02675541722564},
    {0.1, 20, 4.221478499360688, 156.16030700323238},
    {0.1, 100, 6.6685457243902005, 3192.2506149915096},
    {0.1, 1000, 10.974093874399606, 251212.12970579357},
    {0.1, 1000000, 31.846520238281492, 125773030929.20187},
    {0.1, 1000000000, 73.494780256405695, 63035771629838233.0},
    {0.1, 1000000000000000, 322.39870722035488, 1.583386992912634e+28},
    {1e-12, 2, 1.5000000000005, 2.999999999998},
    {1e-12, 10, 2.9289682539717685, 54.999999999871407},
    {1e-12, 19, 3.5477396571491783, 189.99999999943043},
    {1e-12, 20, 3.5977396571493557, 209.99999999935947},
    {1e-12, 100, 5.1873775176522572, 5049.9999999763787},
    {1e-12, 1000, 7.4854708605775391, 500499.99999650427},
    {1e-12, 1000000, 14.392726722968476, 500000499993.05363},
    {1e-12, 1000000000, 21.300481502573977, 5.0000000048959976e+17},
    {1e-12, 1000000000000000, 35.115992060427963, 4.999999999826925e+29},
};

static void test_golden(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof golden / sizeof *golden; k++) {
    assert_relative(sums_plus(golden[k].alpha, golden[k].n), golden[k].plus, 1e-14);
    assert_relative(sums_minus(golden[k].alpha, golden[k].n), golden[k].minus, 4e-15);
  }
}

static void test_alpha_at_its_ends(void **state) {
  (void)state;
  assert_relative(sums_plus(0, 1000), 7.485470860550345, 1e-14); // H_1000
  assert_relative(sums_plus(5e-324, 1000), 7.485470860550345, 1e-14);
  assert_relative(sums_minus(0, 1000), 500500, 1e-15);
  assert_relative(sums_plus(1, 1000), 1000, 1e-14);
  assert_relative(sums_minus(1, 1000), 1000, 1e-15);
}

static void test_direct_sums(void **state) {
  (void)state;
  const struct law *law = law_find("knaus-zwicker");
  const double alphas[] = {0.1, 0.5, 2.0 / 3, 0.9};
  for (int k = 0; k < 4; k++) {
    assert_relative(sums_plus(alphas[k], 5000), sums_direct(law, alphas[k], 1, 5000), 2e-14);
    assert_relative(sums_minus(alphas[k], 5000), sums_direct(law, alphas[k], -1, 5000), 2e-14);
  }
}

static void test_general_power(void **state) {
  (void)state;
  const struct law *law = law_find("knaus-zwicker");
  const double powers[] = {0.5, 2.0 / 3, 4.0 / 3, 2};
  const double alphas[] = {0, 0.25, 0.5, 2.0 / 3, 1}; // 0.5 with p = 2: the logarithm
  for (int a = 0; a < 5; a++)
    for (int p = 0; p < 4; p++)
      assert_relative(sums_power(alphas[a], powers[p], 100000),
                      sums_direct(law, alphas[a], powers[p], 100000), 2e-13);
  assert_relative(sums_power(0.7, 1, 1000000), sums_plus(0.7, 1000000), 2e-13);
}

// K_2 = (Gamma(1 - 2a) / Gamma(1 - a)^2 - 1) / a^2: what the sum leaves above its tail
// (theory 3.1), whose next term is w^(b - 3), below 1e-11.
static void test_constant_of_squares(void **state) {
  (void)state;
  const double alphas[] = {0.3, 0.6, 0.8}, n = 20000;
  for (int k = 0; k < 3; k++) {
    double a = alphas[k], t = a / 2, b = 2 * (a - 1), w = n + (1 + a) / 2;
    double constant = (tgamma(1 - 2 * a) / pow(tgamma(1 - a), 2) - 1) / (a * a);
    double e1 = -2 * t * (t * (t - 1.5) + 0.5) / 3; // -2 B_3(t) / 3
    double tail = pow(w, b + 1) / (b + 1) + (e1 / (b - 1) - b / 24) * pow(w, b - 1);
    double rest = sums_power(a, 2, (uint64_t)n) - tail / pow(tgamma(1 + a), 2);
    if (!(fabs(rest - constant) <= 1e-9)) fail_msg("%.12f, not %.12f", rest, constant);
  }
}

// ---- any law ----

// The sequence of Knaus and Zwicker under another name, so that it is summed in blocks.
static double as_another(double alpha, uint64_t i) {
  return law_find("knaus-zwicker")->rho(alpha, i);
}

static void test_blocks(void **state) {
  (void)state;
  struct law law = {.name = "another", .rho = as_another};
  for (size_t k = 0; k < sizeof golden / sizeof *golden; k++) {
    assert_relative(sums_law(&law, golden[k].alpha, 1, golden[k].n), golden[k].plus, 2e-14);
    assert_relative(sums_law(&law, golden[k].alpha, -1, golden[k].n), golden[k].minus, 2e-14);
  }
}

static void test_every_law(void **state) {
  (void)state;
  const double powers[] = {-1, -1.0 / 3, 0, 0.5, 2.0 / 3, 1, 4.0 / 3, 2, 8};
  const uint64_t terms[] = {1, 255, 256, 257, 999, 6007};
  for (int l = 0; l < n_laws; l++)
    for (double alpha = 0.1; alpha <= 1; alpha += 0.3)
      for (int p = 0; p < 9; p++)
        for (int n = 0; n < 6; n++)
          assert_relative(sums_law(&laws[l], alpha, powers[p], terms[n]),
                          sums_direct(&laws[l], alpha, powers[p], terms[n]), 1e-13);
}

// A radius that drops now and then is no smooth sequence.
static double in_steps(double alpha, uint64_t i) { return i < 3000 ? 1 : i < 5000 ? alpha : 0.01; }

static void test_steps(void **state) {
  (void)state;
  struct law law = {.name = "steps", .rho = in_steps};
  assert_relative(sums_law(&law, 0.25, 1, 10000), 2999 + 2000 * 0.25 + 50.01, 1e-13);
  assert_relative(sums_law(&law, 0.25, -1, 10000), 2999 + 2000 * 4 + 500100, 1e-13);
}

// Ordinary least squares of ln y on ln n over ten points a decade.
static double slope(double (*curve)(double alpha, uint64_t n), double alpha, int from, int to) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0, last = 0;
  for (int j = 10 * from; j <= 10 * to; j++) {
    double n = round(pow(10, j / 10.0));
    if (n == last) continue;
    last = n;
    double x = log(n), y = log(curve(alpha, (uint64_t)n));
    sx += x, sy += y, sxx += x * x, sxy += x * y, count++;
  }
  return (sxy - sx * sy / count) / (sxx - sx * sx / count);
}

static void assert_slope(double measured, double expected) {
  if (!(fabs(measured - expected) <= 2e-4)) fail_msg("%.6f, not %.4f", measured, expected);
}

static double variance(double alpha, uint64_t n) {
  return sums_minus(alpha, n) / (double)n / (double)n;
}
static double bias_2d(double alpha, uint64_t n) { return sums_plus(alpha, n) / (double)n; }
static double bias_3d(double alpha, uint64_t n) {
  return sums_power(alpha, 2.0 / 3, n) / (double)n;
}
static double bias_1d(double alpha, uint64_t n) { return sums_power(alpha, 2, n) / (double)n; }

static void test_straight_lines(void **state) {
  (void)state;
  static const struct {
    double alpha;
    int from, to;
    double variance, bias_2d, bias_3d, bias_1d;
  } rows[] = {
      {0.5, 0, 2, -.5925, -.3584, -.2465, -.6323},
      {0.5, 1, 3, -.5162, -.4493, -.3069, -.7852},
      {0.5, 2, 4, -.5018, -.4838, -.3269, -.8563},
      {4. / 7, 1, 3, -.5866, -.3886, -.2639, -.7053},
      {2. / 3, 0, 2, -.7363, -.2424, -.1645, -.4532},
      {2. / 3, 1, 3, -.6801, -.3053, -.2061, -.5759},
      {2. / 3, 2, 4, -.6683, -.3265, -.2189, -.6287},
      {2. / 3, 3, 5, -.6668, -.3318, -.2216, -.6500},
      {.7, 1, 3, -.7126, -.2756, -.1857, -.5254},
      {.75, 1, 3, -.7612, -.2306, -.1550, -.4455},
      {.8, 1, 3, -.8096, -.1852, -.1242, -.3616},
      {.9, 1, 3, -.9055, -.0932, -.0623, -.1847},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    double a = rows[k].alpha;
    int from = rows[k].from, to = rows[k].to;
    assert_slope(slope(variance, a, from, to), rows[k].variance);
    assert_slope(slope(bias_2d, a, from, to), rows[k].bias_2d);
    assert_slope(slope(bias_3d, a, from, to), rows[k].bias_3d);
    assert_slope(slope(bias_1d, a, from, to), rows[k].bias_1d);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      {"S+ and S- are the 60-digit values up to 1e15 terms", test_golden, 0, 0, 0},
      {"alpha may be zero, the smallest number, or one", test_alpha_at_its_ends, 0, 0, 0},
      {"closed forms equal direct sums of 5000 terms", test_direct_sums, 0, 0, 0},
      {"sums of any power equal direct sums of 1e5 terms", test_general_power, 0, 0, 0},
      {"the constant of the sum of squares is the one with Gammas", test_constant_of_squares, 0, 0,
       0},
      {"a law without closed form has the same sums in blocks up to 1e15 terms", test_blocks, 0, 0,
       0},
      {"the sums of every law equal direct ones", test_every_law, 0, 0, 0},
      {"a law in steps is summed exactly", test_steps, 0, 0, 0},
      {"a straight line through the exact curves has the slopes of theory", test_straight_lines, 0,
       0, 0},
  };
  return cmocka_run_group_tests_name("sums", tests, NULL, NULL);
}
