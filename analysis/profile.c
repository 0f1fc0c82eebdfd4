#include "analysis/profile.h"

#include "analysis/fog.h"
#include "analysis/special.h"
#include "analysis/sphere.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// ---- through a kernel ----

// Nodes in |u|, in which every kernel is a polynomial or an exponential.
// GSL tables 64 nodes to full precision; most other numbers it finds to 1e-10.
enum { RULE_NODES = 64 };
struct kernel_rule {
  double u2[RULE_NODES], weight[PROFILE_MOMENTS][RULE_NODES]; // psi^j(u) over the shell du
};

static double shell(int d, double u) { return d == 1 ? 2 : d == 2 ? 2 * pi * u : 4 * pi * u * u; }

static struct kernel_rule kernel_rule_new(const struct kernel *kernel, int d) {
  struct kernel_rule rule;
  double u[RULE_NODES], du[RULE_NODES];
  special_gauss_legendre(RULE_NODES, u, du);
  for (int k = 0; k < RULE_NODES; k++) {
    rule.u2[k] = u[k] * u[k];
    double psi = kernel_value(kernel, d, rule.u2[k]), power = shell(d, u[k]) * du[k];
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

// The distance to the edge, negative in the dark, is between these.
static void edge_range(const struct profile *profile, double *lo, double *hi) {
  double distance = profile->shadow.distance;
  if (profile->shadow.shade == SHADE_DARK) distance = -distance;
  *lo = distance - profile->spread, *hi = distance + profile->spread;
}

static double lit_share(const struct profile *profile) {
  double lo, hi;
  edge_range(profile, &lo, &hi);
  return profile->shadow.shade == SHADE_NONE || lo >= 0 ? 1 : hi <= 0 ? 0 : hi / (hi - lo);
}

// Near the rim of a kernel what is beyond goes as (1 - t)^(3/2) and higher powers.
static void tabulate_beyond(struct profile *profile) {
  double value[CHEBYSHEV_TERMS];
  for (int j = 0; j < PROFILE_MOMENTS; j++) {
    for (int k = 0; k < CHEBYSHEV_TERMS; k++) {
      double s = chebyshev_node(1, k);
      value[k] = shadow_beyond(profile->kernel, j + 1, 1 - s * s);
    }
    profile->beyond[j] = chebyshev_fit(1, value);
  }
}

struct profile profile_new(const struct ring_mean *ring, const struct kernel *kernel,
                           double radius) {
  struct kernel_rule rule = kernel_rule_new(kernel, ring->d);
  double hi = radius * radius, centre = chebyshev_value(&ring->density, 0);
  struct profile profile = {.d = ring->d,
                            .flux = ring->flux,
                            .kernel = kernel,
                            .shadow = ring->shadow,
                            .spread = ring->spread};
  profile.exact = ring->flux * centre * lit_share(&profile);
  double mean[CHEBYSHEV_TERMS][PROFILE_MOMENTS], value[CHEBYSHEV_TERMS];
  for (int m = 0; m < CHEBYSHEV_TERMS; m++)
    kernel_means(&rule, ring, centre, chebyshev_node(hi, m), mean[m]);
  for (int j = 0; j < PROFILE_MOMENTS; j++) {
    for (int m = 0; m < CHEBYSHEV_TERMS; m++) value[m] = mean[m][j];
    profile.moment[j] = chebyshev_fit(hi, value);
  }
  if (ring->shadow.shade != SHADE_NONE) profile.density = centre;
  if (ring->spread > 0) tabulate_beyond(&profile);
  return profile;
}

bool profile_find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                  double radius, struct arena scratch, struct profile *profile) {
  struct ring_mean ring;
  if (sphere_find(scene, cell, probe, radius, profile)) return true;
  if (fog_find(scene, cell, probe, radius, profile)) return true;
  if (!ring_mean_find(scene, cell, probe, radius, scratch, &ring)) return false;
  *profile = profile_new(&ring, cell->kernel, radius);
  return true;
}

// What the half of the disc beyond the edge holds when it is lit, over flux^j and r^-2(j-1).
static double beyond(const struct profile *profile, int j, double r) {
  double t = profile->shadow.distance / r;
  if (profile->spread == 0) return profile->density * shadow_beyond(profile->kernel, j, t);
  return t < 1 ? profile->density * chebyshev_value(&profile->beyond[j - 1], sqrt(1 - t)) : 0;
}

double profile_bias(const struct profile *profile, double r) {
  if (profile->shadow.shade == SHADE_NONE)
    return profile->flux * chebyshev_value(&profile->moment[0], r * r);
  double size = profile->flux * beyond(profile, 1, r);
  return profile->shadow.shade == SHADE_LIT ? -size : size;
}

// T_k'(-1) = (-1)^(k-1) k^2 and T_k''(-1) = (-1)^k k^2 (k^2 - 1)/3. Rounding, 1e-16 of the light a
// coefficient, leaves less than 1e-10 and 1e-7 of it at the largest r where there is no such term.
bool profile_bias_terms(const struct profile *profile, double *second, double *fourth) {
  const struct chebyshev *c = &profile->moment[0];
  double slope = 0, bend = 0, unit = fabs(profile->exact);
  if (profile->shadow.shade != SHADE_NONE) return false;
  for (int k = 1; k < CHEBYSHEV_TERMS; k++) {
    double square = (double)k * k, term = (k % 2 ? square : -square) * c->coefficient[k];
    slope += 2 * profile->flux * term;
    bend -= 2 * profile->flux * term * (square - 1) / 3;
  }
  *second = fabs(slope) > 1e-10 * unit ? slope / c->hi : 0;
  *fourth = fabs(bend) > 1e-7 * unit ? bend / (c->hi * c->hi) : 0;
  return true;
}

double profile_moment(const struct profile *profile, int j, double r) {
  if (j == 1) return profile->exact + profile_bias(profile, r);
  double value = chebyshev_value(&profile->moment[j - 1], r * r);
  if (profile->shadow.shade == SHADE_LIT) value -= beyond(profile, j, r);
  if (profile->shadow.shade == SHADE_DARK) value = beyond(profile, j, r);
  for (int k = 1; k < j; k++) value *= profile->flux / radius_power(r, profile->d);
  return profile->flux * value;
}

double profile_roughness(const struct profile *profile) {
  return profile->flux * profile->flux * chebyshev_value(&profile->moment[1], 0) *
         lit_share(profile);
}

// ---- what is random beside the photons ----

static int views_of_ray(const struct profile *profile, double r, struct profile_view *view) {
  double sees = 1 - profile->blind;
  view[0] = (struct profile_view){sees, profile_bias(profile, r) / sees, {0}};
  for (int j = 0; j < PROFILE_MOMENTS; j++)
    view[0].moment[j] = profile_moment(profile, j + 1, r) / sees;
  if (profile->blind == 0) return 1;
  view[1] = (struct profile_view){.weight = profile->blind};
  return 2;
}

// ---- places in the pixel ----

// At this distance from the edge, negative in the dark.
static struct profile_view view_at(const struct profile *profile, double distance, double weight,
                                   double r) {
  struct profile at = *profile;
  at.shadow.shade = distance > 0 ? SHADE_LIT : SHADE_DARK;
  at.shadow.distance = fabs(distance);
  at.exact = distance > 0 ? at.flux * at.density : 0;
  struct profile_view view = {.weight = weight, .bias = profile_bias(&at, r)};
  for (int j = 0; j < PROFILE_MOMENTS; j++) view.moment[j] = profile_moment(&at, j + 1, r);
  return view;
}

// Distances from lo to hi on one side of the edge, of `range` in all: those within r of it, where t
// = |distance| / r = 1 - s^2 makes them smooth in s, and those farther away, which are alike.
static int views_of_side(const struct profile *profile, double lo, double hi, double range,
                         double r, struct profile_view *view) {
  int n = 0;
  double sign = lo < 0 ? -1 : 1, near = sign > 0 ? lo : -hi, far = sign > 0 ? hi : -lo;
  if (far > r) view[n++] = view_at(profile, sign * 2 * r, (far - fmax(near, r)) / range, r);
  if (near >= r) return n;
  double x[PROFILE_NODES], weight[PROFILE_NODES];
  double from = sqrt(1 - fmin(far / r, 1)), to = sqrt(1 - near / r);
  special_gauss_legendre(PROFILE_NODES, x, weight);
  for (int k = 0; k < PROFILE_NODES; k++) {
    double s = from + (to - from) * x[k];
    view[n++] =
        view_at(profile, sign * r * (1 - s * s), (to - from) * weight[k] * 2 * s * r / range, r);
  }
  return n;
}

int profile_views(const struct profile *profile, double r,
                  struct profile_view view[PROFILE_VIEWS]) {
  double lo, hi;
  edge_range(profile, &lo, &hi);
  if (profile->spread == 0) return views_of_ray(profile, r, view);
  int n = 0;
  if (hi > 0) n += views_of_side(profile, fmax(lo, 0), hi, hi - lo, r, view);
  if (lo < 0) n += views_of_side(profile, lo, fmin(hi, 0), hi - lo, r, view + n);
  return n;
}
