#include "analysis/ring_mean.h"

#include "analysis/footprint.h"
#include "analysis/mirror.h"
#include "analysis/receiver.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

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
  if (!probe->hit || scene_features(scene).media || !light_is_alone(scene, cell)) return false;
  struct neighbourhood at = {
      .scene = scene, .light = &scene->light[0], .p = probe->p, .n = probe->n};
  vec_basis(at.n, &at.s, &at.t);
  ring->shadow = (struct half_shadow){.shade = SHADE_NONE, .distance = INFINITY};
  ring->d = 2;
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
