#include "analysis/bias_family.h"

#include <math.h>

// The power of r.
static double power_of(const struct prediction *theory) {
  return theory->bias_kind == BIAS_SIDE ? 1 : theory->bias_kind == BIAS_FOURTH ? 4 : 2;
}

double bias_theory_rate(const struct prediction *theory) {
  switch (theory->bias_kind) {
  case BIAS_SMOOTH:
  case BIAS_FOURTH:
  case BIAS_SIDE:
    return power_of(theory) / theory->d * (1 - theory->family.theory);
  case BIAS_EDGE:
    return 0;
  case BIAS_ENDS:
    return 1;
  case BIAS_STAYS:
    break;
  }
  return NAN;
}

// The law itself at the rate a of the variance that this is the bias's rate for: rate = (q / d) (1
// - a), q the power of r.
static void by_radius(const struct prediction *theory, double rate, double *shape, double *slope) {
  double per_log = power_of(theory) / theory->d;
  family_ratio(&theory->family, 1 - rate / per_log, shape, slope);
  for (uint64_t j = 0; j < theory->n; j++) {
    shape[j] = theory->bias[j] * exp(per_log * shape[j]);
    slope[j] *= -shape[j];
  }
}

// The bias at an edge does not know the radius.
static void by_power(const struct prediction *theory, double rate, double *shape, double *slope) {
  for (uint64_t j = 0; j < theory->n; j++) {
    double log_i = log((double)(j + 1));
    shape[j] = theory->bias[j] * exp(-rate * log_i);
    slope[j] = -log_i * shape[j];
  }
}

// Where the bias of iterations ends, at iteration m, that of the average goes on as S m^-1 (N / m)^
// -rate, S the sum so far: what iteration i > m adds to N times that is S ((i / m)^(1 - rate) - ((i
// - 1) / m)^(1 - rate)), and nothing at theory's rate of 1.
static void by_tail(const struct prediction *theory, double rate, double *shape, double *slope) {
  double sum = 0, m = (double)theory->bias_end, power = 1 - rate;
  for (uint64_t j = 0; j < theory->n; j++) {
    shape[j] = theory->bias[j], slope[j] = 0;
    if (j < theory->bias_end) {
      sum += theory->bias[j];
      continue;
    }
    double last = log((double)j / m), here = log((double)(j + 1) / m);
    shape[j] = sum * (exp(power * here) - exp(power * last));
    slope[j] = -sum * (here * exp(power * here) - last * exp(power * last));
  }
}

void bias_family(const struct prediction *theory, double rate, double *shape, double *slope) {
  switch (theory->bias_kind) {
  case BIAS_SMOOTH:
  case BIAS_FOURTH:
  case BIAS_SIDE:
    by_radius(theory, rate, shape, slope);
    return;
  case BIAS_ENDS:
    by_tail(theory, rate, shape, slope);
    return;
  case BIAS_EDGE:
    by_power(theory, rate, shape, slope);
    return;
  case BIAS_STAYS:
    by_power(theory, 0, shape, slope);
    return;
  }
}
