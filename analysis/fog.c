#include "analysis/fog.h"

#include "analysis/flat.h"

#include <math.h>

// ---- in numbers ----

static double luminance_of(const double flux[3], double factor) {
  const double value[3] = {flux[0] * factor, flux[1] * factor, flux[2] * factor};
  return luminance(value, 3);
}

static double sinh_ratio(double x) { return x == 0 ? 1 : sinh(x) / x; }

struct profile fog_of_points(const struct fog *fog, double density, const struct kernel *kernel,
                             double radius) {
  double sigma = fog->sigma_t, hi = radius * radius, value[CHEBYSHEV_TERMS];
  double sees = -expm1(-sigma * fog->length);
  for (int k = 0; k < CHEBYSHEV_TERMS; k++)
    value[k] = sees * density * sigma * exp(-sigma * fog->depth) *
               sinh_ratio(sigma * sqrt(chebyshev_node(hi, k)));
  struct ring_mean ring = {.d = 3,
                           .flux =
                               luminance_of(fog->flux, fog->sigma_s / (sigma * sigma) * fog->phase),
                           .density = chebyshev_fit(hi, value),
                           .shadow = {.shade = SHADE_NONE, .distance = INFINITY}};
  struct profile profile = profile_new(&ring, kernel, radius);
  profile.blind = 1 - sees;
  return profile;
}

// The integral of e^(-j sigma x) from 0 to L.
static double weight_along(const struct fog *fog, int j) {
  double sigma = j * fog->sigma_t;
  return -expm1(-sigma * fog->length) / sigma;
}

struct profile fog_of_beams(const struct fog *fog, const double density[CHEBYSHEV_TERMS],
                            const struct kernel *kernel, double radius) {
  double value[CHEBYSHEV_TERMS], first = weight_along(fog, 1);
  for (int k = 0; k < CHEBYSHEV_TERMS; k++)
    value[k] = density[k] * first * exp(-fog->sigma_t * fog->depth);
  struct ring_mean ring = {.d = 1,
                           .flux = luminance_of(fog->flux, fog->sigma_s * fog->phase),
                           .density = chebyshev_fit(radius * radius, value),
                           .shadow = {.shade = SHADE_NONE, .distance = INFINITY}};
  struct profile profile = profile_new(&ring, kernel, radius);
  for (int j = 1; j < PROFILE_MOMENTS; j++)
    for (int k = 0; k < CHEBYSHEV_TERMS; k++)
      profile.moment[j].coefficient[k] *= weight_along(fog, j + 1) / first;
  return profile;
}

// ---- scenes ----

// The ray from the camera, which is among the photons.
struct sight_line {
  const struct scene *scene;
  const struct light *light;
  struct vec o, d, across; // across: at right angles to the ray and the photons
  struct vec towards;      // the light
  struct fog fog;
};

static const double round_off = 1e-12;

// As uniform media of one light do, gray and dark, with the camera in them.
static bool find_medium(struct sight_line *at) {
  const struct scene *scene = at->scene;
  if (scene->camera_medium == MEDIUM_NONE || at->light->medium != scene->camera_medium)
    return false;
  const struct medium *medium = &scene->medium[scene->camera_medium];
  if (!medium->type->uniform || !medium->type->is_gray(medium)) return false;
  struct medium_point point;
  medium->type->at(medium, at->o, &point);
  at->fog.sigma_s = point.sigma_s[0];
  at->fog.sigma_t = point.sigma_s[0] + point.sigma_a[0];
  double phase[3];
  struct bsdf bsdf = medium_bsdf(medium);
  bsdf_value(&bsdf, vec_scale(at->d, -1), at->towards, TRANSPORT_RADIANCE, phase);
  at->fog.phase = phase[0];
  return at->fog.sigma_s > 0 && point.emission[0] == 0;
}

static bool is_same(struct vec a, struct vec b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static struct vec beside(const struct sight_line *at, double along, double across) {
  return vec_along(vec_along(at->o, at->d, along), at->across, across);
}

// Photons that all fly the same way, at right angles to the ray, from a plane at a distance.
static bool find_photons(struct sight_line *at) {
  struct light_sample here, there;
  const struct light_type *type = at->light->type;
  if (!type->delta || !type->closed_form) return false;
  if (!type->sample(at->scene, at->light, at->o, NULL, &here)) return false;
  at->towards = here.wi;
  at->fog.depth = here.distance;
  struct vec across = vec_cross(at->d, at->towards);
  if (!(here.distance < INFINITY) || fabs(vec_dot(at->d, at->towards)) > round_off) return false;
  at->across = vec_normalize(across);
  if (!type->sample(at->scene, at->light, beside(at, 0x1p-20 * here.distance, 0), NULL, &there))
    return false;
  return is_same(here.wi, there.wi) && fabs(here.distance - there.distance) <= round_off;
}

// Nothing, or one black wall along the photons' way.
static bool find_wall(struct sight_line *at, const struct probe *probe) {
  const struct scene *scene = at->scene;
  at->fog.length = INFINITY;
  if (!probe->hit) return scene->n_shapes == 0;
  struct plane plane = flat_plane(scene, probe->p, probe->n);
  if (fabs(vec_dot(probe->n, at->towards)) > round_off) return false;
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    const struct material *material = &scene->material[shape->material];
    if (!material->type->is_black || !material->type->is_black(material) || shape->alpha ||
        !flat_contains_shape(&plane, scene, shape))
      return false;
  }
  at->fog.length = vec_dot(vec_sub(probe->p, at->o), at->d);
  return true;
}

static bool density_at(const struct sight_line *at, double along, double across, double *density) {
  struct light_closed_form form;
  if (!at->light->type->closed_form(at->scene, at->light, beside(at, along, across), at->towards,
                                    &form))
    return false;
  *density = form.irradiance[0] / form.photon_flux[0];
  return true;
}

static bool is_clear(const struct sight_line *at, double along, double radius) {
  struct light_closed_form form;
  return at->light->type->closed_form(at->scene, at->light, beside(at, along, 0), at->towards,
                                      &form) &&
         form.clear_radius > radius;
}

// Where density is the same within the radius of all of the ray that matters: no double knows how
// often a collision is farther away. What beams cover is convex.
static bool find_points(const struct sight_line *at, const struct kernel *kernel, double radius,
                        struct profile *profile) {
  enum { PLACES = 16 };
  double length = fmin(at->fog.length, 40 / at->fog.sigma_t), density, other;
  if (!(at->fog.depth > radius) || !is_clear(at, 0, radius) || !is_clear(at, length, radius))
    return false;
  if (!density_at(at, 0, 0, &density)) return false;
  for (int k = 0; k < PLACES * PLACES; k++) {
    double along = length * (k / PLACES + 0.5) / PLACES;
    double across = radius * (2.0 * (k % PLACES) + 1 - PLACES) / PLACES;
    if (!density_at(at, along, across, &other)) return false;
    if (fabs(other - density) > round_off * density) return false;
  }
  *profile = fog_of_points(&at->fog, density, kernel, radius);
  return density > 0;
}

// Where the photons end on the ray, to rounding; they do within `most`, or not.
static double photons_end(const struct sight_line *at, double most) {
  struct light_sample sample;
  double lo = 0, hi = most;
  while (lo < (lo + hi) / 2 && (lo + hi) / 2 < hi) {
    double middle = (lo + hi) / 2;
    bool lit = at->light->type->sample(at->scene, at->light, beside(at, middle, 0), NULL, &sample);
    *(lit ? &lo : &hi) = middle;
  }
  return hi;
}

// Where density is the same all along the ray, whatever it is beside it.
static bool find_beams(struct sight_line *at, const struct kernel *kernel, double radius,
                       struct profile *profile) {
  enum { PLACES = 16 };
  double density[CHEBYSHEV_TERMS], hi = radius * radius;
  at->fog.length = photons_end(at, fmin(at->fog.length, 40 / at->fog.sigma_t));
  for (int k = 0; k < CHEBYSHEV_TERMS; k++) {
    double across = sqrt(chebyshev_node(hi, k)), left, right, other;
    if (!density_at(at, 0, -across, &left) || !density_at(at, 0, across, &right)) return false;
    density[k] = (left + right) / 2;
    for (int j = 0; j < PLACES; j++) {
      double along = at->fog.length * (j + 0.5) / PLACES;
      if (!density_at(at, along, j % 2 ? across : -across, &other)) return false;
      if (fabs(other - (j % 2 ? right : left)) > round_off * density[k]) return false;
    }
  }
  struct chebyshev fit = chebyshev_fit(hi, density);
  if (!chebyshev_converged(&fit)) return false;
  *profile = fog_of_beams(&at->fog, density, kernel, radius);
  return true;
}

bool fog_find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
              double radius, struct profile *profile) {
  if (!probe->volume || cell->depth != 1 || cell->footprint || cell->left_out ||
      cell->direct != DIRECT_PHOTONS || !cell->integrator->photons || scene->n_lights != 1 ||
      scene->n_motions > 0 || scene->camera.lens_radius > 0 || scene->camera.animation.moves)
    return false;
  struct sight_line at = {.scene = scene, .light = &scene->light[0]};
  struct ray ray = camera_ray(&scene->camera, probe->x + 0.5, probe->y + 0.5, NULL);
  struct light_closed_form form;
  at.o = ray.o, at.d = ray.d;
  if (!find_photons(&at) || !find_medium(&at) || !find_wall(&at, probe)) return false;
  if (!at.light->type->closed_form(scene, at.light, at.o, at.towards, &form)) return false;
  for (int c = 0; c < 3; c++) at.fog.flux[c] = form.photon_flux[c];
  if (cell->integrator->volume_dimension == 3)
    return find_points(&at, cell->kernel, radius, profile);
  return cell->integrator->volume_dimension == 1 && find_beams(&at, cell->kernel, radius, profile);
}
