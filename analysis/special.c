// GSL aborts on an error unless its handler is off; here it is off and codes are checked.
#include "analysis/special.h"

#include <assert.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_sf_psi.h>
#include <gsl/gsl_sf_zeta.h>
#include <math.h>
#include <stdbool.h>

double special_normal_quantile(double upper) { return gsl_cdf_ugaussian_Qinv(upper); }

double special_two_sided(double z) { return 2 * gsl_cdf_ugaussian_Q(fabs(z)); }

double special_chi2_upper(double x, double dof) {
  gsl_set_error_handler_off();
  return x <= 0 ? 1 : gsl_cdf_chisq_Q(x, dof);
}

// From here the normal stands for t, chi-squared for F: tails differ by less than (z^2 + 1)^2 /
// (4 dof), 0.7 % at z = 4.
static const double many_dof = 1e4;

double special_t_two_sided(double t, double variance_dof) {
  gsl_set_error_handler_off();
  if (variance_dof > many_dof) return special_two_sided(t);
  return 2 * gsl_cdf_tdist_Q(fabs(t), variance_dof);
}

double special_t_quantile(double upper, double variance_dof) {
  gsl_set_error_handler_off();
  if (variance_dof > many_dof) return special_normal_quantile(upper);
  return gsl_cdf_tdist_Qinv(upper, variance_dof);
}

double special_f_upper(double chi2, double dof, double variance_dof) {
  gsl_set_error_handler_off();
  if (variance_dof > many_dof) return special_chi2_upper(chi2, dof);
  return chi2 <= 0 ? 1 : gsl_cdf_fdist_Q(chi2 / dof, dof, variance_dof);
}

// Wilson and Hilferty 1931: the cube root is nearly normal; its error falls as the relative
// variance.
static double cube_root_deviate(double ratio, double relative_variance) {
  double ninth = relative_variance / 9;
  return (cbrt(ratio > 0 ? ratio : 0) - (1 - ninth)) / sqrt(ninth);
}

// Where GSL's incomplete gamma function loses digits (at 1e-9 all of them) and its inverse fails;
// the cube root is then right to 1e-4 within four standard deviations.
static const double small_relative_variance = 1e-4;

double special_gamma_deviate(double ratio, double relative_variance) {
  gsl_set_error_handler_off();
  assert(relative_variance > 0);
  if (relative_variance < small_relative_variance)
    return cube_root_deviate(ratio, relative_variance);
  double shape = 1 / relative_variance;
  bool upper = ratio > 1;
  double tail = ratio <= 0 ? 0
                : upper    ? gsl_cdf_gamma_Q(ratio, shape, relative_variance)
                           : gsl_cdf_gamma_P(ratio, shape, relative_variance);
  // Beyond the range of doubles nothing hangs on the digits.
  if (!(tail > 1e-300)) return cube_root_deviate(ratio, relative_variance);
  return upper ? gsl_cdf_ugaussian_Qinv(tail) : gsl_cdf_ugaussian_Pinv(tail);
}

// GSL's own inverse fails for shapes below one and above 1e4; bisection of ln x does not.
double special_gamma_quantile(double lower, double relative_variance) {
  double target = gsl_cdf_ugaussian_Pinv(lower), lo = -700, hi = 700;
  while (hi - lo > 1e-13 * (1 + fabs(lo))) {
    double middle = (lo + hi) / 2;
    *(special_gamma_deviate(exp(middle), relative_variance) < target ? &lo : &hi) = middle;
  }
  return exp((lo + hi) / 2);
}

double special_digamma(double x) { return gsl_sf_psi(x); }

double special_trigamma(double x) { return gsl_sf_psi_1(x); }

double special_zeta(int k) {
  gsl_set_error_handler_off();
  gsl_sf_result zeta;
  int code = gsl_sf_zeta_int_e(k, &zeta);
  assert(code == GSL_SUCCESS);
  (void)code;
  return zeta.val;
}

void special_gauss_legendre(int n, double *x, double *weight) {
  gsl_set_error_handler_off();
  gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc((size_t)n);
  assert(table);
  for (int j = 0; j < n; j++) {
    int code = gsl_integration_glfixed_point(0, 1, (size_t)j, &x[j], &weight[j], table);
    assert(code == GSL_SUCCESS);
    (void)code;
  }
  gsl_integration_glfixed_table_free(table);
}

double special_binomial(double m, double p, double trials) {
  gsl_set_error_handler_off();
  return gsl_ran_binomial_pdf((unsigned)m, p, (unsigned)trials);
}

// Golub and Welsch 1969: eigenvalues of the recurrence of Krawtchouk's polynomials.
void special_gauss_binomial(int n, double p, double trials, double *m, double *weight) {
  gsl_set_error_handler_off();
  size_t size = (size_t)n;
  gsl_matrix *jacobi = gsl_matrix_calloc(size, size), *vectors = gsl_matrix_alloc(size, size);
  gsl_vector *values = gsl_vector_alloc(size);
  gsl_eigen_symmv_workspace *workspace = gsl_eigen_symmv_alloc(size);
  assert(jacobi && vectors && values && workspace && trials >= n);
  for (int k = 0; k < n; k++) {
    gsl_matrix_set(jacobi, (size_t)k, (size_t)k, p * (trials - k) + k * (1 - p));
    if (k == 0) continue;
    double beside = sqrt(k * p * (1 - p) * (trials - k + 1));
    gsl_matrix_set(jacobi, (size_t)k, (size_t)k - 1, beside);
    gsl_matrix_set(jacobi, (size_t)k - 1, (size_t)k, beside);
  }
  int code = gsl_eigen_symmv(jacobi, values, vectors, workspace);
  assert(code == GSL_SUCCESS);
  (void)code;
  for (size_t k = 0; k < size; k++) {
    m[k] = gsl_vector_get(values, k);
    weight[k] = gsl_matrix_get(vectors, 0, k) * gsl_matrix_get(vectors, 0, k);
  }
  gsl_eigen_symmv_free(workspace);
  gsl_vector_free(values);
  gsl_matrix_free(vectors);
  gsl_matrix_free(jacobi);
}

double special_sidak(double level, int n) { return n ? -expm1(log1p(-level) / n) : level; }
