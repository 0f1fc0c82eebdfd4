// Elementary functions with one definition everywhere: libm's change bits with the CPU and version,
// these use only + - * / sqrt, comparisons, conversions and integer operations on the bits, so the
// same argument gives the same bits on every IEEE machine and at every optimisation level.
// Errors are given in ulp (of the result), measured against 60-digit values by tests/unit.
#ifndef NUMERIC_ELEMENTARY_H
#define NUMERIC_ELEMENTARY_H

double num_exp(double x);
double num_log(double x); // x > 0; -inf at 0, NaN below
double num_pow(double x,
               double y); // x >= 0; relative error of a few 1e-16 even where |y ln x| is large
double num_cbrt(double x);
double num_atan2(double y, double x);
double num_acos(double x);                               // x in [-1, 1]
void num_sincos(double x, double *sine, double *cosine); // radians, |x| <= 1e5
void num_sincos_turns(double u, double *sine,
                      double *cosine); // of 2 pi u; exact at multiples of 1/4, |u| <= 1e5
double num_rgamma1p(double a);         // 1 / Gamma(1 + a) for a in [0, 1]
double num_erf(double x);

#endif
