#include "analysis/pairs.h"

#include "analysis/special.h"

#include <math.h>

enum { NODES = 64 };

// The integral of psi along a line that passes the centre at a distance whose square is v, over the
// length of the line in the ball: psi at v + (1 - v) t^2, -1 < t < 1.
static double mean_on_line(const struct kernel *kernel, double v, const double *x,
                           const double *weight) {
  double sum = 0;
  for (int k = 0; k < NODES; k++)
    sum += weight[k] * kernel_value(kernel, 3, v + (1 - v) * x[k] * x[k]);
  return sum;
}

// 1 / (4 pi s^2) is one over the area of a sphere: J is the integral over s > 0 of psi's
// autocorrelation along any direction, half of the integral over lines of that direction of P^2,
// with P the integral of psi along one: 2 sqrt(1 - v) times the mean.
double pairs_constant(const struct kernel *kernel) {
  const double pi = 3.14159265358979323846;
  double x[NODES], weight[NODES], sum = 0;
  special_gauss_legendre(NODES, x, weight);
  for (int k = 0; k < NODES; k++) {
    double mean = mean_on_line(kernel, x[k], x, weight);
    sum += weight[k] * 4 * (1 - x[k]) * mean * mean;
  }
  return pi / 2 * sum / kernel->constants(3).roughness;
}
