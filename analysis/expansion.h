// What theory says of an estimate where all that is known of the light is its value and Laplacians
// at the point: variance and bias of one iteration are sums of powers of rho_i (theory 1.3, 1.4),
// those of the average sums over iterations of the same (theory 3.2). Exact where the light is a
// polynomial of degree 5 within the first disc and a path leaves at most one photon there.
#ifndef ANALYSIS_EXPANSION_H
#define ANALYSIS_EXPANSION_H

#include "density/kernel.h"
#include "density/law.h"

#include <stdbool.h>
#include <stdint.h>

// Photons all carry the same; where they do not, lambda is their number times
// (mean weight)^2 / (mean squared weight).
struct local_light {
  double mu;          // the light there, what the estimate tends to
  double photons;     // emitted per iteration
  double lambda;      // photons expected in the first disc
  double curvature;   // r1^2 Laplacian / mu
  double bicurvature; // r1^4 Laplacian of the Laplacian / mu
};

enum { EXPANSION_TERMS = 8 };
struct expansion {
  int n;
  struct expansion_term {
    double factor, power;
  } term[EXPANSION_TERMS]; // term[0] leads as rho tends to 0, unless its factor is 0
};

double expansion_value(const struct expansion *, double rho);
// Over iterations 1..n.
double expansion_sum(const struct expansion *, const struct law *, double alpha, uint64_t n);

// ~ constant n^-exponent, times ln n where so; the constant is 0 if the whole is.
struct asymptote {
  double constant, exponent;
  bool logarithm;
};
// Of expansion_sum / n^power.
struct asymptote expansion_asymptote(const struct expansion *, const struct law *, double alpha,
                                     double power);

struct model {
  const struct law *law;
  const struct kernel *kernel;
  double alpha;
  int d;
  struct local_light light;
  struct expansion variance, bias;
};
// The light with this bias in the first disc, of r^2 and of r^4; sets curvature and bicurvature.
void local_light_set_bias(struct local_light *, const struct kernel *, int d, double second,
                          double fourth);
struct model model_new(const struct law *, const struct kernel *, double alpha, int d,
                       struct local_light);

// Of the average of n iterations.
double model_variance(const struct model *, uint64_t n);
double model_bias(const struct model *, uint64_t n);

#endif
