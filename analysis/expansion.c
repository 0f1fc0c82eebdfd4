#include "analysis/expansion.h"

#include "analysis/special.h"
#include "analysis/sums.h"

#include <math.h>

double expansion_value(const struct expansion *expansion, double rho) {
  double sum = 0;
  for (int k = 0; k < expansion->n; k++)
    sum += expansion->term[k].factor * pow(rho, expansion->term[k].power);
  return sum;
}

double expansion_sum(const struct expansion *expansion, const struct law *law, double alpha,
                     uint64_t n) {
  double sum = 0;
  for (int k = 0; k < expansion->n; k++) {
    struct expansion_term term = expansion->term[k];
    if (term.factor != 0) sum += term.factor * sums_law(law, alpha, term.power, n);
  }
  return sum;
}

// ---- asymptotes ----

// Of the sum over i <= n of rho_i^p, rho ~ c i^-e (theory 3.2): exponent is its growth, negated.
static struct asymptote power_asymptote(const struct law *law, double alpha, double p) {
  double e = law->measure_exponent(alpha), growth = 1 - p * e, c = pow(law->constant(alpha), p);
  if (growth > 0) return (struct asymptote){c / growth, -growth, false};
  if (growth == 0) return (struct asymptote){c, 0, true};
  const uint64_t n = UINT64_C(1) << 49; // the rest of a convergent sum, to a relative 1 / n
  double rest = c * pow((double)n, growth) / -growth;
  return (struct asymptote){sums_law(law, alpha, p, n) + rest, 0, false};
}

// Whether a outgrows b.
static bool outgrows(struct asymptote a, struct asymptote b) {
  return a.exponent < b.exponent || (a.exponent == b.exponent && a.logarithm && !b.logarithm);
}

struct asymptote expansion_asymptote(const struct expansion *expansion, const struct law *law,
                                     double alpha, double power) {
  struct asymptote all = {0, INFINITY, false};
  for (int k = 0; k < expansion->n; k++) {
    struct expansion_term term = expansion->term[k];
    if (term.factor == 0) continue;
    struct asymptote one = power_asymptote(law, alpha, term.power);
    one.constant *= term.factor;
    if (outgrows(one, all))
      all = one;
    else if (!outgrows(all, one))
      all.constant += one.constant;
  }
  all.exponent += power;
  return all;
}

// ---- theory 1.3, 1.4 ----

static double ball_volume(int d) { return pow(acos(-1), 0.5 * d) / tgamma(0.5 * d + 1); }

// Integral of |u|^4 psi^power over the unit ball.
static double fourth_moment(const struct kernel *kernel, int d, int power) {
  enum { NODES = 64 };
  double u[NODES], du[NODES], sum = 0;
  special_gauss_legendre(NODES, u, du);
  for (int k = 0; k < NODES; k++)
    sum += du[k] * pow(u[k], d + 3) * pow(kernel_value(kernel, d, u[k] * u[k]), power);
  return d * ball_volume(d) * sum;
}

void local_light_set_bias(struct local_light *light, const struct kernel *kernel, int d,
                          double second, double fourth) {
  light->curvature = second / (light->mu * kernel->constants(d).mu2 / 2);
  light->bicurvature = fourth / (light->mu * fourth_moment(kernel, d, 1) / (8 * d * (d + 2)));
}

static void add(struct expansion *expansion, double factor, double power) {
  expansion->term[expansion->n++] = (struct expansion_term){factor, power};
}

// The means of psi and psi^2 over a disc, expanded by Pizzetti: 1, r^2 / (2 d) times the Laplacian,
// r^4 / (8 d (d + 2)) times its own. Var = (E[Y^2] - E[Y]^2) / photons.
struct model model_new(const struct law *law, const struct kernel *kernel, double alpha, int d,
                       struct local_light light) {
  struct model model = {.law = law, .kernel = kernel, .alpha = alpha, .d = d, .light = light};
  struct kernel_constants c = kernel->constants(d);
  double step = 2.0 / d, fourth = 8.0 * d * (d + 2), mu2 = light.mu * light.mu;
  double b1 = c.mu2 / 2 * light.curvature, b2 = 0, r4 = 0;
  if (light.bicurvature != 0) {
    b2 = fourth_moment(kernel, d, 1) / fourth * light.bicurvature;
    r4 = fourth_moment(kernel, d, 2) / fourth * light.bicurvature;
  }
  add(&model.bias, b1 != 0 ? light.mu * b1 : 0, step); // no bias is none of an unknown light too
  add(&model.bias, b2 != 0 ? light.mu * b2 : 0, 2 * step);

  double hits = mu2 * ball_volume(d) / light.lambda, paths = -mu2 / light.photons;
  add(&model.variance, hits * c.roughness, -1);
  add(&model.variance, hits * c.roughness2 / (2 * d) * light.curvature, step - 1);
  add(&model.variance, hits * r4, 2 * step - 1);
  add(&model.variance, paths, 0);
  add(&model.variance, paths * 2 * b1, step);
  add(&model.variance, paths * (b1 * b1 + 2 * b2), 2 * step);
  add(&model.variance, paths * 2 * b1 * b2, 3 * step);
  add(&model.variance, paths * b2 * b2, 4 * step);
  return model;
}

double model_variance(const struct model *model, uint64_t n) {
  return expansion_sum(&model->variance, model->law, model->alpha, n) / (double)n / (double)n;
}

double model_bias(const struct model *model, uint64_t n) {
  return expansion_sum(&model->bias, model->law, model->alpha, n) / (double)n;
}
