// Radius laws: rho(alpha, i) = r_i^d / r_1^d, i = 1, 2, ... (theory 2). A law is one row of the
// table in law.c; nothing else knows what alpha does.
#ifndef DENSITY_LAW_H
#define DENSITY_LAW_H

#include <stdint.h>

struct law {
  const char *name, *formula, *source;
  // Closed form, valid for alpha in [0, 1] and i from 1 to 1e15. Zero beyond i = 1: the law has no
  // second radius at this alpha.
  double (*rho)(double alpha, uint64_t i);
  // e in rho ~ i^-e. The variance of the average then falls as N^-(1 - e), the bias of iteration i
  // as i^-(2 e / d) (theory 3.2).
  double (*measure_exponent)(double alpha);
  // lim rho_i i^e, and its formula.
  const char *constant_formula;
  double (*constant)(double alpha);
  // Local statistics (theory 2.4), NULL: none. n: what was counted so far (0: nothing), m: photons
  // in the disc in this pass. Returns the new n and *ratio = r2 of the next pass / r2 of this one;
  // m = 0 changes neither. rho is then what constant density gives, in the limit of many photons.
  double (*count)(double alpha, double n, double m, double *ratio);
};

extern const struct law laws[];
extern const int n_laws;

const struct law *law_find(const char *name); // NULL if unknown

// r^d and its inverse, d in {1, 2, 3}.
static inline double radius_power(double r, int d) {
  return d == 1 ? r : d == 2 ? r * r : r * r * r;
}
double radius_root(double rd, int d);

// r_i = r1 rho^(1/d), d in {1, 2, 3}.
double law_radius(const struct law *, double alpha, double r1, int d, uint64_t i);

#endif
