// GSL aborts on an error unless its handler is off; here it is off and codes are checked.
#include "analysis/special.h"

#include <assert.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_zeta.h>
#include <math.h>
#include <stdbool.h>

double special_normal_upper(double z) { return gsl_cdf_ugaussian_Q(z); }

double special_normal_quantile(double upper) { return gsl_cdf_ugaussian_Qinv(upper); }

double special_two_sided(double z) { return 2 * gsl_cdf_ugaussian_Q(fabs(z)); }

double special_chi2_upper(double x, double dof) {
  gsl_set_error_handler_off();
  return x <= 0 ? 1 : gsl_cdf_chisq_Q(x, dof);
}

double special_gamma_deviate(double ratio, double relative_variance) {
  gsl_set_error_handler_off();
  assert(relative_variance > 0);
  double shape = 1 / relative_variance;
  bool upper = ratio > 1;
  double tail = ratio <= 0 ? 0
                : upper    ? gsl_cdf_gamma_Q(ratio, shape, relative_variance)
                           : gsl_cdf_gamma_P(ratio, shape, relative_variance);
  // Beyond the range of doubles Wilson and Hilferty's cube root serves: nothing hangs on its
  // digits.
  if (!(tail > 1e-300)) {
    double ninth = relative_variance / 9;
    return (cbrt(ratio > 0 ? ratio : 0) - (1 - ninth)) / sqrt(ninth);
  }
  return upper ? gsl_cdf_ugaussian_Qinv(tail) : gsl_cdf_ugaussian_Pinv(tail);
}

double special_gamma_quantile(double lower, double relative_variance) {
  gsl_set_error_handler_off();
  double x = gsl_cdf_gamma_Pinv(lower, 1 / relative_variance, relative_variance);
  assert(isfinite(x));
  return x;
}

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
