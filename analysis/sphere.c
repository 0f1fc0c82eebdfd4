// The chord c from the probe to a point of a sphere of area A has t = pi c^2 / A uniform on [0, 1]
// if the point is uniform, and light that a point of the wall scatters with the cosine lands
// uniformly: the t of a path's hits are independent. A photon counts on the side of the probe's
// normal alone, which it is on iff it came from farther away, t_j < t_(j-1): near grazing some of
// what lands in the disc arrives below the probe's own horizon and is lost, r^2 mu_2 / (2 R^2) of
// it for a kernel's mean. What comes from the centre is all counted. So with k = psi within t < T =
// pi r^2 / A
//   H_m(s) = E[(sum over the hits to come)^m | one is to come, the last was at s]
//          = rho I_m + G_m(s),    I_m = int_0^1 H_m ds,
//   G_m(s) = sum_(b = 1..m) C(m, b) int_0^min(s,T) k^b F_(m - b) dt,  F_0 = 1, F_m = rho H_m.
// The centre is as far as T; the wall is anywhere: E[Y^m] = H_m(T) or I_m.
#include "analysis/sphere.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---- moments ----

static double binomial(int m, int b) {
  double value = 1;
  for (int k = 1; k <= b; k++) value = value * (m - b + k) / k;
  return value;
}

// On t = T u^2, 0 <= u <= 1.
struct chain {
  double albedo, share;                              // T
  double psi[CHEBYSHEV_TERMS];                       // at the nodes of u
  double survives[PROFILE_MOMENTS][CHEBYSHEV_TERMS]; // F_m at the nodes
};

static double node(int k) { return chebyshev_node(1, k); }

// From 0 to u, dt = 2 T u du.
static struct chebyshev integral_dt(const struct chain *chain, const double *value) {
  double integrand[CHEBYSHEV_TERMS];
  for (int k = 0; k < CHEBYSHEV_TERMS; k++) integrand[k] = value[k] * 2 * chain->share * node(k);
  struct chebyshev c = chebyshev_fit(1, integrand);
  return chebyshev_integral(&c);
}

// G_m, given F_0..F_(m - 1).
static struct chebyshev gathered(const struct chain *chain, int m) {
  double value[CHEBYSHEV_TERMS] = {0};
  for (int b = 1; b <= m; b++)
    for (int k = 0; k < CHEBYSHEV_TERMS; k++)
      value[k] += binomial(m, b) * pow(chain->psi[k], b) * chain->survives[m - b][k];
  return integral_dt(chain, value);
}

// E[(sum of psi)^m], m = 1..PROFILE_MOMENTS.
static void chain_moments(struct chain *chain, bool from_wall, double moment[PROFILE_MOMENTS]) {
  for (int k = 0; k < CHEBYSHEV_TERMS; k++) chain->survives[0][k] = 1;
  for (int m = 1; m <= PROFILE_MOMENTS; m++) {
    struct chebyshev g = gathered(chain, m);
    double value[CHEBYSHEV_TERMS], at_rim = chebyshev_value(&g, 1);
    for (int k = 0; k < CHEBYSHEV_TERMS; k++) value[k] = chebyshev_value(&g, node(k));
    struct chebyshev inside = integral_dt(chain, value);
    double mean =
        (chebyshev_value(&inside, 1) + (1 - chain->share) * at_rim) / (1 - chain->albedo); // I_m
    moment[m - 1] = from_wall ? mean : chain->albedo * mean + at_rim;
    if (m == PROFILE_MOMENTS) return;
    for (int k = 0; k < CHEBYSHEV_TERMS; k++)
      chain->survives[m][k] = chain->albedo * (chain->albedo * mean + value[k]);
  }
}

struct profile sphere_profile(double flux, double area, double albedo, bool from_wall,
                              const struct kernel *kernel, double radius) {
  double hits = 1 / (1 - albedo), scattered = from_wall ? hits : hits - 1;
  struct profile profile = {.d = 2, .exact = flux * hits / area, .flux = flux, .kernel = kernel};
  double hi = radius * radius, value[PROFILE_MOMENTS][CHEBYSHEV_TERMS];
  struct chain chain = {.albedo = albedo};
  for (int k = 0; k < CHEBYSHEV_TERMS; k++)
    chain.psi[k] = kernel_value(kernel, 2, node(k) * node(k));
  for (int n = 0; n < CHEBYSHEV_TERMS; n++) {
    double r2 = chebyshev_node(hi, n), moment[PROFILE_MOMENTS];
    chain.share = pi * r2 / area;
    chain_moments(&chain, from_wall, moment);
    // E[t] under the kernel is T E|u|^2 = 2 T mu_2.
    value[0][n] = -scattered / area * chain.share * 2 * kernel->constants(2).mu2;
    for (int m = 1; m < PROFILE_MOMENTS; m++) value[m][n] = moment[m] / r2;
  }
  for (int m = 0; m < PROFILE_MOMENTS; m++) profile.moment[m] = chebyshev_fit(hi, value[m]);
  return profile;
}

// ---- scenes ----

struct ball {
  struct vec centre;
  double radius;
};

// A rotated and scaled sphere is one to some roundings of its matrix.
static const double round_off = 1e-12;

static bool is_ball(const struct scene *scene, struct ball *ball) {
  if (scene->n_shapes != 1 || scene->n_motions > 0) return false;
  const struct shape *shape = &scene->shape[0];
  if (strcmp(shape->type->name, "sphere") || shape->alpha) return false;
  const struct quadric *q = &scene->quadric[shape->local];
  ball->centre = transform_point(&q->world_from_object, vec(0, 0, 0));
  ball->radius = vec_length(transform_direction(&q->world_from_object, vec(q->radius, 0, 0)));
  double full = 4 * pi * ball->radius * ball->radius;
  return q->mean_stretch == 0 &&
         fabs(shape->type->area(scene, shape, shape->first) - full) <= round_off * full;
}

// Diffuse, gray and the same everywhere.
static bool find_albedo(const struct scene *scene, double *albedo) {
  const struct material *material = &scene->material[scene->shape[0].material];
  if (strcmp(material->type->name, "diffuse") || (material->needs & MATERIAL_DETAIL)) return false;
  if (!material->type->is_gray(scene, material)) return false;
  struct bsdf bsdf = {.type = NULL};
  material->type->bsdf(scene, material, &(struct surface){0}, &bsdf);
  *albedo = bsdf.type ? bsdf.x[0] : 0;
  return *albedo < 1;
}

static bool is_at_centre(const struct emission *emission, const struct ball *ball) {
  return vec_length(vec_sub(emission->ray.o, ball->centre)) <= round_off * ball->radius;
}

// Photons that fly inwards from anywhere on the wall, or from the centre as often in all
// directions, and carry the same flux: so do these few.
static bool find_light(const struct scene *scene, const struct ball *ball, bool *from_wall,
                       double flux[3]) {
  if (scene->n_lights != 1 || scene->n_infinite > 0) return false;
  const struct light *light = &scene->light[0];
  *from_wall = light->type->area;
  if (!*from_wall && strcmp(light->type->name, "point")) return false;
  for (int k = 0; k < 32; k++) {
    double u[LIGHT_U] = {(k + 0.5) / 32, (k * 7 % 32 + 0.5) / 32, (k * 13 % 32 + 0.5) / 32,
                         (k * 5 % 32 + 0.5) / 32};
    struct emission emission;
    light->type->emit(scene, light, u, &emission);
    for (int c = 0; c < 3; c++)
      if (emission.flux[c] != light->power[c]) return false;
    struct vec inwards = vec_sub(ball->centre, emission.ray.o);
    if (*from_wall ? !(vec_dot(emission.ray.d, inwards) > 0) : !is_at_centre(&emission, ball))
      return false;
  }
  for (int c = 0; c < 3; c++) flux[c] = light->power[c];
  return true;
}

// A Lambertian point is seen brighter on its axis.
static bool is_isotropic(const struct scene *scene, const struct ball *ball) {
  const struct light *light = &scene->light[0];
  double seen[2] = {0, 0};
  for (int k = 0; k < 6; k++) {
    double sign = k % 2 ? -ball->radius : ball->radius;
    struct vec p = vec_add(ball->centre, k < 2   ? vec(sign, 0, 0)
                                         : k < 4 ? vec(0, sign, 0)
                                                 : vec(0, 0, sign));
    struct light_sample sample;
    if (!light->type->sample(scene, light, p, NULL, &sample)) return false;
    seen[k > 0] = sample.radiance_over_pdf[0];
    if (fabs(seen[k > 0] - seen[0]) > round_off * seen[0]) return false;
  }
  return true;
}

bool sphere_find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                 double radius, struct profile *profile) {
  struct ball ball;
  double albedo, flux[3];
  bool from_wall;
  if (!probe->hit || scene_features(scene).media || cell->direct != DIRECT_PHOTONS ||
      cell->left_out || cell->footprint || !cell->integrator->photons)
    return false;
  if (!is_ball(scene, &ball) || !(radius < 2 * ball.radius)) return false;
  if (!find_albedo(scene, &albedo) || !find_light(scene, &ball, &from_wall, flux)) return false;
  if (!from_wall && !is_isotropic(scene, &ball)) return false;
  if (pow(albedo, cell->depth) > round_off) return false; // of the light is left out
  if (!(vec_dot(probe->n, vec_sub(ball.centre, probe->p)) > 0)) return false;
  for (int c = 0; c < 3; c++) flux[c] *= probe->scale_rgb[c];
  double area = 4 * pi * ball.radius * ball.radius;
  *profile = sphere_profile(luminance(flux, 3), area, albedo, from_wall, cell->kernel, radius);
  return true;
}
