// Radius laws and their sums: iterations to 1e15, alpha to 0 and to 1.
#include "analysis/sums.h"
#include "app/stability.h"
#include "density/law.h"
#include "numeric/pair.h"

#include <math.h>
#include <stddef.h>

enum { N_DECADES = 15, SHORT = 1000 };

// rho of knaus-zwicker at i = 10, 100, ..., 1e15 (Gamma functions in 60-digit arithmetic); alpha is
// the double nearest to what is written. The smallest, 1e-12, is that of theory's own table
// (appendix A): there the form 1 / (B(alpha, i) alpha i) has lost all its digits. The largest is
// the double below 1.
static const struct golden {
  double alpha, rho[N_DECADES];
} golden[] = {
    {1e-12,
     {1.0000000000028289683e-1, 1.0000000000051773775e-2, 1.0000000000074844709e-3,
      1.000000000009787506e-4, 1.0000000000120901361e-5, 1.0000000000143927257e-6,
      1.0000000000166953113e-7, 1.0000000000189978964e-8, 1.0000000000213004815e-9,
      1.0000000000236030666e-10, 1.0000000000259056517e-11, 1.0000000000282082368e-12,
      1.0000000000305108219e-13, 1.000000000032813407e-14, 1.0000000000351159921e-15}},
    {0.1,
     {1.3172835503953125196e-1, 1.6651893830559641263e-2, 2.0971996674732133821e-3,
      2.6403249016625681615e-4, 3.3239855764077080635e-5, 4.1846516053629888412e-6,
      5.2681644588574112465e-7, 6.632226137626978798e-8, 8.3494780248056220896e-9,
      1.0511370061070478278e-9, 1.3233030882707626349e-10, 1.6659398853304377785e-11,
      2.0972940561640340498e-12, 2.6403367833097765467e-13, 3.3239870722035486659e-14}},
    {0.5,
     {3.5239410400390625e-1, 1.1269695801851284449e-1, 3.567802229170864146e-2,
      1.128365062444084012e-2, 3.5682437719980395585e-3, 1.1283790260481255024e-3,
      3.568248187702439604e-4, 1.1283791656850386159e-4, 3.5682482318595112001e-5,
      1.1283791670814078343e-5, 3.5682482323010819188e-6, 1.1283791670953715265e-6,
      3.568248232305497626e-7, 1.1283791670955111634e-7, 3.568248232305541783e-8}},
    {2.0 / 3,
     {5.0851584026574284876e-1, 2.3838878553835976929e-1, 1.1076090997597849995e-1,
      5.1415801303201525094e-2, 2.3865339570763278034e-2, 1.1077320443511336493e-2,
      5.141637201858940111e-3, 2.3865366061290165938e-3, 1.1077321673093902754e-3,
      5.1416372589311117366e-4, 2.3865366087780716165e-4, 1.1077321674323482628e-4,
      5.1416372589881825958e-5, 2.386536608780720062e-5, 1.1077321674324709379e-5}},
    {0.8,
     {6.7209798656000006111e-1, 4.2709476334743241433e-1, 2.6967245801247717865e-1,
      1.7016406801087631584e-1, 1.073670415095018152e-1, 6.7744072171190702139e-2,
      4.2743622958949452979e-2, 2.696940302982106882e-2, 1.7016542930163892286e-2,
      1.073671274022246042e-2, 6.7744077590661990036e-3, 4.2743623300895036963e-3,
      2.6969403051396389265e-3, 1.7016542931525210807e-3, 1.0736712740308358753e-3}},
    {1 - 0x1p-53,
     {9.9999999999999978584e-1, 9.9999999999999953511e-1, 9.9999999999999927997e-1,
      9.9999999999999902438e-1, 9.9999999999999876875e-1, 9.9999999999999851311e-1,
      9.9999999999999825747e-1, 9.9999999999999800183e-1, 9.9999999999999774619e-1,
      9.9999999999999749056e-1, 9.9999999999999723492e-1, 9.9999999999999697928e-1,
      9.9999999999999672364e-1, 9.99999999999996468e-1, 9.9999999999999621236e-1}},
};
enum { N_GOLDEN = sizeof golden / sizeof golden[0] };

static double relative(double got, double want) { return fabs(got - want) / fabs(want); }

static double golden_rho(double alpha, double i) {
  int decade = -1;
  for (; i >= 5; i /= 10) decade++;
  for (int k = 0; k < N_GOLDEN; k++)
    if (golden[k].alpha == alpha) return golden[k].rho[decade];
  return NAN;
}

static double closed_form(double alpha, double i) {
  return relative(law_find("knaus-zwicker")->rho(alpha, (uint64_t)i), golden_rho(alpha, i));
}

static double closed_form_bound(double alpha, double i) {
  (void)alpha, (void)i;
  return 2e-15; // theory, A1
}

// ---- ways not taken ----

static double recurrence(double alpha, double i) {
  double rho = 1;
  for (double k = 1; k < i; k++) rho *= (k + alpha) / (k + 1);
  return relative(rho, golden_rho(alpha, i));
}

static double float_recurrence(double alpha, double i) {
  float rho = 1, a = (float)alpha;
  for (int k = 1; k < (int)i; k++) rho *= ((float)k + a) / (float)(k + 1);
  return relative(rho, golden_rho(alpha, i));
}

// ---- alpha to its ends: a thousand iterations by products of 106 bits ----

struct exact {
  struct pair rho, plus, minus; // of iteration SHORT; sums of rho_i and of 1 / rho_i
};

static struct exact exactly(double alpha) {
  struct pair one = {1, 0};
  struct exact e = {one, one, one};
  for (int k = 1; k < SHORT; k++) {
    struct pair factor = pair_divide(pair_sum(k, alpha), (struct pair){k + 1, 0});
    e.rho = pair_multiply(e.rho, factor);
    e.plus = pair_add(e.plus, e.rho);
    e.minus = pair_add(e.minus, pair_divide(one, e.rho));
  }
  return e;
}

// A distance x from one of the ends, 0 or 1.
static double alpha_at(double end, double x) { return end == 0 ? x : 1 - x; }

static double end_rho(double end, double x) {
  double alpha = alpha_at(end, x);
  return relative(law_find("knaus-zwicker")->rho(alpha, SHORT), exactly(alpha).rho.hi);
}

static double end_plus(double end, double x) {
  double alpha = alpha_at(end, x);
  return relative(sums_plus(alpha, SHORT), exactly(alpha).plus.hi);
}

static double end_minus(double end, double x) {
  double alpha = alpha_at(end, x);
  return relative(sums_minus(alpha, SHORT), exactly(alpha).minus.hi);
}

// The closed form as it stands in books (theory 3.1).
static double end_plus_as_it_stands(double end, double x) {
  double alpha = alpha_at(end, x);
  double plus = ((SHORT + alpha) * law_find("knaus-zwicker")->rho(alpha, SHORT) - 1) / alpha;
  return relative(plus, exactly(alpha).plus.hi);
}

// These three are the bounds of theory's acceptance test A1, on rho, S+ and S-.
static double end_rho_bound(double end, double x) {
  (void)end, (void)x;
  return 2e-15;
}

static double end_plus_bound(double end, double x) {
  (void)end, (void)x;
  return 1e-14;
}

static double end_minus_bound(double end, double x) {
  (void)end, (void)x;
  return 4e-15;
}

// Distances from 0 and 1 go down to the decade of the spacing of doubles below 1, 1.1e-16.
#define LEAST 1e-16

// clang-format off
#define LAW(alpha) "law", "closed form; alpha = " #alpha, "i", 10, 1e15, 10, alpha, \
                   closed_form, closed_form_bound, NULL
const struct stress stress_laws[] = {
  {LAW(1e-12)},
  {LAW(0.1)},
  {LAW(0.5)},
  {LAW(2.0 / 3)},
  {LAW(0.8)},
  {LAW(1 - 0x1p-53)},
  {"law", "recurrence in double", "i", 10, 1e7, 10, 2.0 / 3, recurrence, NULL, NULL},
  {"law", "recurrence in float", "i", 10, 1e7, 10, 2.0 / 3, float_recurrence, NULL, NULL},
  {"alpha", "rho_1000; alpha = x", "x", LEAST, 0.1, 10, 0, end_rho, end_rho_bound, NULL},
  {"alpha", "rho_1000; alpha = 1 - x", "x", LEAST, 0.1, 10, 1, end_rho, end_rho_bound, NULL},
  {"alpha", "sum of rho; alpha = x", "x", LEAST, 0.1, 10, 0, end_plus, end_plus_bound, NULL},
  {"alpha", "sum of rho; alpha = 1 - x", "x", LEAST, 0.1, 10, 1, end_plus, end_plus_bound, NULL},
  {"alpha", "sum of 1/rho; alpha = x", "x", LEAST, 0.1, 10, 0, end_minus, end_minus_bound, NULL},
  {"alpha", "sum of 1/rho; alpha = 1 - x", "x", LEAST, 0.1, 10, 1, end_minus, end_minus_bound, NULL},
  {"alpha", "sum of rho as it stands", "x", LEAST, 0.1, 10, 0, end_plus_as_it_stands, NULL, NULL},
  {0},
};
// clang-format on
