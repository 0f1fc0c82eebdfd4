// Distributions and quadrature nodes: all of GSL that the analysis uses, in one file.
#ifndef ANALYSIS_SPECIAL_H
#define ANALYSIS_SPECIAL_H

double special_normal_quantile(double upper); // z with P(Z > z) = upper
double special_two_sided(double z);           // P(|Z| > |z|)
double special_chi2_upper(double x, double dof);

// The same where the variance behind z or chi-squared was itself estimated with so many degrees of
// freedom: Student's t, and chi-squared / dof as F.
double special_t_two_sided(double t, double variance_dof);
double special_t_quantile(double upper, double variance_dof);
double special_f_upper(double chi2, double dof, double variance_dof);

// A positive estimate of 1 with this relative variance, taken as gamma distributed (exact for
// variances of normal data): the normal deviate with the same tail, and the quantile.
double special_gamma_deviate(double ratio, double relative_variance);
double special_gamma_quantile(double lower, double relative_variance);

double special_zeta(int k); // k >= 2
double special_digamma(double x);
double special_trigamma(double x); // x > 0

// n-point Gauss-Legendre on [0, 1]; n one of those GSL tables to full precision (64, 96, 100, ...).
void special_gauss_legendre(int n, double *x, double *weight);

// P(m of so many trials), each with probability p; and the n-point Gauss rule for it, n <= trials.
double special_binomial(double m, double p, double trials);
void special_gauss_binomial(int n, double p, double trials, double *m, double *weight);

// The level of each of n tests that together reject a true theory with this probability (Sidak).
double special_sidak(double level, int n);

#endif
