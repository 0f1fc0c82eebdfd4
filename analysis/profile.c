#include "analysis/profile.h"

#include "analysis/receiver.h"
#include "analysis/special.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double chebyshev_value(const struct chebyshev *c, double x) {
  double y = 2 * x / c->hi - 1, b1 = 0, b2 = 0; // Clenshaw
  for (int k = PROFILE_NODES - 1; k >= 1; k--) {
    double b = 2 * y * b1 - b2 + c->coefficient[k];
    b2 = b1, b1 = b;
  }
  return y * b1 - b2 + c->coefficient[0];
}

static double chebyshev_node(double hi, int k) {
  return hi * (1 + cos(pi * (k + 0.5) / PROFILE_NODES)) / 2;
}

static struct chebyshev chebyshev_fit(double hi, const double value[PROFILE_NODES]) {
  struct chebyshev c = {.hi = hi};
  for (int j = 0; j < PROFILE_NODES; j++) {
    double sum = 0;
    for (int k = 0; k < PROFILE_NODES; k++)
      sum += value[k] * cos(pi * j * (k + 0.5) / PROFILE_NODES);
    c.coefficient[j] = (j ? 2 : 1) * sum / PROFILE_NODES;
  }
  return c;
}

// The last coefficients of a smooth function are rounding: PROFILE_NODES terms of 1e-16 each.
static bool chebyshev_converged(const struct chebyshev *c) {
  double largest = 0, last = 0;
  for (int k = 0; k < PROFILE_NODES; k++) {
    largest = fmax(largest, fabs(c->coefficient[k]));
    if (k >= PROFILE_NODES - 4) last = fmax(last, fabs(c->coefficient[k]));
  }
  return last <= 1e-13 * largest;
}

// ---- the light around the probe ----

struct neighbourhood {
  const struct scene *scene;
  const struct light *light;
  struct vec p, n, s, t;
  int channel; // that carries the most flux: all are in proportion
};

static bool density_at(const struct neighbourhood *at, double x, double y, double *density) {
  struct vec p = vec_along(vec_along(at->p, at->s, x), at->t, y);
  struct light_closed_form form;
  if (!at->light->type->closed_form(at->scene, at->light, p, at->n, &form)) return false;
  *density = form.irradiance[at->channel] / form.photon_flux[at->channel];
  return true;
}

// The mean over a circle. The trapezoid rule converges geometrically; it is doubled until it
// stands.
static bool circle_mean(const struct neighbourhood *at, double distance, double *mean) {
  double last = NAN;
  for (int steps = 8; steps <= 8192; steps *= 2) {
    double sum = 0, density;
    for (int k = 0; k < steps; k++) {
      double phi = 2 * pi * k / steps;
      if (!density_at(at, distance * cos(phi), distance * sin(phi), &density)) return false;
      sum += density;
    }
    *mean = sum / steps;
    if (fabs(*mean - last) <= 1e-13 * fabs(*mean)) return true;
    last = *mean;
  }
  return false;
}

static bool light_is_alone(const struct scene *scene, const struct cell *cell) {
  return scene->n_lights == 1 && scene->light[0].type->closed_form &&
         cell->direct == DIRECT_PHOTONS && !cell->left_out && !cell->footprint &&
         cell->integrator->photons;
}

bool ring_mean_find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                    double radius, struct arena scratch, struct ring_mean *ring) {
  if (!probe->hit || !light_is_alone(scene, cell)) return false;
  const struct light *light = &scene->light[0];
  struct light_closed_form form;
  if (!light->type->closed_form(scene, light, probe->p, probe->n, &form)) return false;
  if (!(form.clear_radius > radius)) return false;
  if (!receiver_is_plane(scene, probe->p, probe->n, 0, cell->depth <= 1)) return false;
  if (!(receiver_clearance(scene, probe->p, probe->n, scratch) > radius)) return false;

  struct neighbourhood at = {.scene = scene, .light = light, .p = probe->p, .n = probe->n};
  vec_basis(at.n, &at.s, &at.t);
  double flux[3];
  for (int c = 0; c < 3; c++) {
    if (form.photon_flux[c] > form.photon_flux[at.channel]) at.channel = c;
    flux[c] = probe->scale_rgb[c] * form.photon_flux[c];
  }
  ring->flux = luminance(flux, 3);

  double value[PROFILE_NODES], hi = radius * radius;
  for (int k = 0; k < PROFILE_NODES; k++)
    if (!circle_mean(&at, sqrt(chebyshev_node(hi, k)), &value[k])) return false;
  ring->density = chebyshev_fit(hi, value);
  return chebyshev_converged(&ring->density);
}

// ---- through a kernel ----

// Nodes in |u|, in which every kernel is a polynomial or an exponential.
// GSL tables 64 nodes to full precision; most other numbers it finds to 1e-10.
enum { RULE_NODES = 64 };
struct kernel_rule {
  double u2[RULE_NODES], weight[PROFILE_MOMENTS][RULE_NODES]; // 2 pi u psi^j(u) du
};

static struct kernel_rule kernel_rule_new(const struct kernel *kernel) {
  struct kernel_rule rule;
  double u[RULE_NODES], du[RULE_NODES];
  special_gauss_legendre(RULE_NODES, u, du);
  for (int k = 0; k < RULE_NODES; k++) {
    rule.u2[k] = u[k] * u[k];
    double psi = kernel_value(kernel, 2, rule.u2[k]), power = 2 * pi * u[k] * du[k];
    for (int j = 0; j < PROFILE_MOMENTS; j++) rule.weight[j][k] = power *= psi;
  }
  return rule;
}

// All moments at one squared radius.
static void kernel_means(const struct kernel_rule *rule, const struct ring_mean *ring,
                         double centre, double r2, double mean[PROFILE_MOMENTS]) {
  for (int j = 0; j < PROFILE_MOMENTS; j++) mean[j] = 0;
  for (int k = 0; k < RULE_NODES; k++) {
    double density = chebyshev_value(&ring->density, rule->u2[k] * r2);
    mean[0] += rule->weight[0][k] * (density - centre);
    for (int j = 1; j < PROFILE_MOMENTS; j++) mean[j] += rule->weight[j][k] * density;
  }
}

struct profile profile_new(const struct ring_mean *ring, const struct kernel *kernel,
                           double radius) {
  struct kernel_rule rule = kernel_rule_new(kernel);
  double hi = radius * radius, centre = chebyshev_value(&ring->density, 0);
  struct profile profile = {.exact = ring->flux * centre, .flux = ring->flux};
  double mean[PROFILE_NODES][PROFILE_MOMENTS], value[PROFILE_NODES];
  for (int m = 0; m < PROFILE_NODES; m++)
    kernel_means(&rule, ring, centre, chebyshev_node(hi, m), mean[m]);
  for (int j = 0; j < PROFILE_MOMENTS; j++) {
    for (int m = 0; m < PROFILE_NODES; m++) value[m] = mean[m][j];
    profile.moment[j] = chebyshev_fit(hi, value);
  }
  return profile;
}

double profile_bias(const struct profile *profile, double r) {
  return profile->flux * chebyshev_value(&profile->moment[0], r * r);
}

double profile_moment(const struct profile *profile, int j, double r) {
  if (j == 1) return profile->exact + profile_bias(profile, r);
  double value = profile->flux * chebyshev_value(&profile->moment[j - 1], r * r);
  for (int k = 1; k < j; k++) value *= profile->flux / (r * r);
  return value;
}

double profile_roughness(const struct profile *profile) {
  return profile->flux * profile->flux * chebyshev_value(&profile->moment[1], 0);
}
