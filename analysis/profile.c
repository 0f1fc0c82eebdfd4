#include "analysis/profile.h"

#include "analysis/footprint.h"
#include "analysis/mirror.h"
#include "analysis/receiver.h"
#include "analysis/special.h"
#include "analysis/sphere.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// ---- the light around the probe ----

struct neighbourhood {
  const struct scene *scene;
  const struct light *light;
  struct vec p, n, s, t;
  int channel; // that carries the most flux: all are in proportion
  bool mirrored;
  struct plane mirror;
};

// Of the light's mirror image p receives what its own image receives of the light.
static bool form_at(const struct neighbourhood *at, struct vec p, struct light_closed_form *form) {
  struct vec n = at->n;
  if (at->mirrored) p = mirror_point(&at->mirror, p), n = mirror_direction(&at->mirror, n);
  return at->light->type->closed_form(at->scene, at->light, p, n, form);
}

static bool density_at(const struct neighbourhood *at, double x, double y, double *density) {
  struct vec p = vec_along(vec_along(at->p, at->s, x), at->t, y);
  struct light_closed_form form;
  if (!form_at(at, p, &form)) return false;
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
         cell->direct == DIRECT_PHOTONS && !cell->left_out && cell->integrator->photons;
}

// The shadow's edge is where the density falls to nothing: elsewhere it must be the same.
static bool is_uniform(const struct neighbourhood *at, double radius) {
  enum { RINGS = 8, ANGLES = 16 };
  double centre, density;
  if (!density_at(at, 0, 0, &centre)) return false;
  for (int k = 0; k < RINGS * ANGLES; k++) {
    double r = radius * (k / ANGLES + 1) / RINGS, phi = 2 * pi * (k % ANGLES) / ANGLES;
    if (!density_at(at, r * cos(phi), r * sin(phi), &density)) return false;
    if (fabs(density - centre) > 1e-12 * centre) return false;
  }
  return centre > 0;
}

static bool find_shadow(const struct neighbourhood *at, bool direct_only, double radius,
                        struct arena scratch, struct half_shadow *shadow) {
  struct light_sample here, there;
  const struct light *light = at->light;
  struct vec beside = vec_along(at->p, at->s, radius);
  if (!light->type->delta || !is_uniform(at, radius)) return false;
  if (!light->type->sample(at->scene, light, at->p, NULL, &here)) return false;
  if (!light->type->sample(at->scene, light, beside, NULL, &there)) return false;
  if (here.wi.x != there.wi.x || here.wi.y != there.wi.y || here.wi.z != there.wi.z) return false;
  // Photons on what casts it must be out of reach.
  if (!(receiver_surroundings(at->scene, at->p, at->n, scratch) > radius)) return false;
  return shadow_find(at->scene, at->p, at->n, here.wi, here.distance, radius, direct_only, scratch,
                     shadow);
}

// Nothing but the light: or a mirror, or what casts a shadow.
static bool find_way(struct neighbourhood *at, const struct cell *cell, double radius,
                     struct arena scratch, struct half_shadow *shadow) {
  bool direct_only = cell->depth <= 1;
  if (receiver_is_plane(at->scene, at->p, at->n, 0, direct_only)) return true;
  at->mirrored = mirror_find(at->scene, cell, at->p, at->n, radius, scratch, &at->mirror);
  return at->mirrored || find_shadow(at, direct_only, radius, scratch, shadow);
}

// In uniform light, of a pixel with a side along the edge.
static bool find_footprint(const struct neighbourhood *at, const struct cell *cell,
                           const struct probe *probe, double *reach, struct arena scratch,
                           struct ring_mean *ring) {
  struct footprint footprint;
  if (!footprint_find(at->scene, probe, &footprint)) return false;
  for (int k = 0; k < 2; k++) *reach += vec_length(footprint.side[k]);
  if (!find_shadow(at, cell->depth <= 1, *reach, scratch, &ring->shadow)) return false;
  if (ring->shadow.distance == INFINITY) return true;
  double along[2];
  for (int k = 0; k < 2; k++) along[k] = fabs(vec_dot(footprint.side[k], ring->shadow.across));
  ring->spread = fmax(along[0], along[1]);
  return fmin(along[0], along[1]) <= 1e-6 * ring->spread;
}

bool ring_mean_find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                    double radius, struct arena scratch, struct ring_mean *ring) {
  if (!probe->hit || !light_is_alone(scene, cell)) return false;
  struct neighbourhood at = {
      .scene = scene, .light = &scene->light[0], .p = probe->p, .n = probe->n};
  vec_basis(at.n, &at.s, &at.t);
  ring->shadow = (struct half_shadow){.shade = SHADE_NONE, .distance = INFINITY};
  ring->spread = 0;
  double reach = radius;
  if (cell->footprint ? !find_footprint(&at, cell, probe, &reach, scratch, ring)
                      : !find_way(&at, cell, radius, scratch, &ring->shadow))
    return false;
  struct light_closed_form form;
  if (!form_at(&at, at.p, &form) || !(form.clear_radius > reach)) return false;
  if (!(receiver_clearance(scene, probe->p, probe->n, scratch) > reach)) return false;

  double flux[3];
  for (int c = 0; c < 3; c++) {
    if (form.photon_flux[c] > form.photon_flux[at.channel]) at.channel = c;
    flux[c] = probe->scale_rgb[c] * form.photon_flux[c];
  }
  ring->flux = luminance(flux, 3);

  double value[CHEBYSHEV_TERMS], hi = radius * radius;
  for (int k = 0; k < CHEBYSHEV_TERMS; k++)
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
  struct kernel_rule rule = kernel_rule_new(kernel);
  double hi = radius * radius, centre = chebyshev_value(&ring->density, 0);
  struct profile profile = {
      .flux = ring->flux, .kernel = kernel, .shadow = ring->shadow, .spread = ring->spread};
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
  for (int k = 1; k < j; k++) value *= profile->flux / (r * r);
  return profile->flux * value;
}

double profile_roughness(const struct profile *profile) {
  return profile->flux * profile->flux * chebyshev_value(&profile->moment[1], 0) *
         lit_share(profile);
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
  view.mean = at.exact;
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
  if (profile->spread == 0) {
    view[0] = (struct profile_view){1, profile_bias(profile, r), profile->exact, {0}};
    for (int j = 0; j < PROFILE_MOMENTS; j++) view[0].moment[j] = profile_moment(profile, j + 1, r);
    return 1;
  }
  int n = 0;
  if (hi > 0) n += views_of_side(profile, fmax(lo, 0), hi, hi - lo, r, view);
  if (lo < 0) n += views_of_side(profile, lo, fmin(hi, 0), hi - lo, r, view + n);
  return n;
}
