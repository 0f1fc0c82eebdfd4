#include "analysis/furnace.h"

#include "analysis/flat.h"
#include "analysis/special.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// (e^y - 1 - y) / y^2, by its series where the difference cancels.
static double second_remainder(double y) {
  if (fabs(y) > 0.5) return (expm1(y) - y) / (y * y);
  double term = 0.5, sum = 0;
  for (int k = 3; k < 20; k++) {
    sum += term;
    term *= y / k;
  }
  return sum;
}

double furnace_bias(const struct furnace *furnace, const struct kernel *kernel, double r) {
  enum { NODES = 64 };
  double s[NODES], ds[NODES], x = furnace->sigma * r / furnace->cosine, sum = 0;
  special_gauss_legendre(NODES, s, ds);
  for (int k = 0; k < NODES; k++)
    sum += ds[k] * 2 * pi * s[k] * s[k] * s[k] * kernel_value(kernel, 3, s[k] * s[k]) *
           second_remainder(x * s[k]);
  return -furnace->radiance * exp(-furnace->sigma * furnace->distance) * x * sum;
}

// ---- scenes ----

static const double round_off = 1e-6; // vertices are floats

// Diffuse and gray; the same at all walls as at the first.
static bool find_albedo(const struct scene *scene, const struct shape *shape, double *albedo) {
  const struct material *material = &scene->material[shape->material];
  if (strcmp(material->type->name, "diffuse") || (material->needs & MATERIAL_DETAIL)) return false;
  if (!material->type->is_gray(scene, material)) return false;
  struct bsdf bsdf = {.type = NULL};
  material->type->bsdf(scene, material, &(struct surface){0}, &bsdf);
  *albedo = bsdf.type ? bsdf.x[0] : 0;
  return *albedo < 1;
}

// The same everywhere on the wall and to all directions of one side, on which p is: photons that
// carry the same flux, as do these few, and leave towards p's side.
static bool find_emitted(const struct scene *scene, const struct shape *shape, struct vec p,
                         double radiance[3]) {
  if (shape->light == LIGHT_NONE) return false;
  const struct light *light = &scene->light[shape->light];
  double area = 0;
  for (uint32_t k = 0; k < shape->count; k++)
    area += shape->type->area(scene, shape, shape->first + k);
  for (int k = 0; k < 32; k++) {
    double u[LIGHT_U] = {(k + 0.5) / 32, (k * 7 % 32 + 0.5) / 32, (k * 13 % 32 + 0.5) / 32,
                         (k * 5 % 32 + 0.5) / 32};
    struct emission emission;
    light->type->emit(scene, light, u, &emission);
    for (int c = 0; c < 3; c++)
      if (fabs(emission.flux[c] - light->power[c]) > round_off * light->power[c]) return false;
    struct surface surface;
    scene_surface(scene, &emission.ray, (struct hit){0, emission.ray.leaving}, &surface);
    struct vec inwards = vec_sub(p, emission.ray.o);
    if (!(vec_dot(emission.ray.d, surface.ng) * vec_dot(inwards, surface.ng) > 0)) return false;
  }
  for (int c = 0; c < 3; c++) radiance[c] = light->power[c] / (pi * area);
  return true;
}

// Each edge belongs to two triangles.
static bool is_closed(const struct scene *scene, struct arena scratch) {
  struct edges edges = {0};
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    if (!flat_is_triangles(shape) || shape->alpha) return false;
    for (uint32_t t = 0; t < shape->count; t++) {
      struct vec vertex[3];
      flat_triangle(scene, shape, t, vertex);
      flat_toggle(&edges, vertex, &scratch);
    }
  }
  return edges.count == 0;
}

// Of all walls but the one the ray ends at, planes: no nearer than that to either end of the ray.
static double nearest_other(const struct scene *scene, const struct plane *end, struct vec o) {
  double nearest = INFINITY;
  for (uint32_t s = 0; s < scene->n_shapes; s++)
    for (uint32_t t = 0; t < scene->shape[s].count; t++) {
      struct vec v[3];
      flat_triangle(scene, &scene->shape[s], t, v);
      if (flat_contains_triangle(end, v)) continue;
      struct vec n = vec_normalize(vec_cross(vec_sub(v[1], v[0]), vec_sub(v[2], v[0])));
      nearest = fmin(nearest, fabs(vec_dot(vec_sub(o, v[0]), n)));
      nearest = fmin(nearest, fabs(vec_dot(vec_sub(end->p, v[0]), n)));
    }
  return nearest;
}

// All around, the same walls and the same medium; p is inside.
static bool find_walls(const struct scene *scene, struct vec p, double *albedo,
                       double radiance[3]) {
  for (uint32_t s = 0; s < scene->n_shapes; s++) {
    const struct shape *shape = &scene->shape[s];
    double own_albedo, own[3];
    if (!find_albedo(scene, shape, &own_albedo) || !find_emitted(scene, shape, p, own))
      return false;
    if (shape->inside != scene->camera_medium || shape->outside != scene->camera_medium)
      return false;
    if (s == 0) *albedo = own_albedo, memcpy(radiance, own, sizeof own);
    if (own_albedo != *albedo) return false;
    for (int c = 0; c < 3; c++)
      if (fabs(own[c] - radiance[c]) > round_off * radiance[c]) return false;
  }
  return scene->n_shapes > 0 && scene->n_lights == scene->n_shapes;
}

static bool find_medium(const struct scene *scene, double *sigma) {
  if (scene->camera_medium == MEDIUM_NONE) return false;
  const struct medium *medium = &scene->medium[scene->camera_medium];
  struct medium_point at;
  if (!medium->type->uniform || !medium->type->is_gray(medium)) return false;
  medium->type->at(medium, (struct vec){0}, &at);
  *sigma = at.sigma_s[0];
  return at.sigma_a[0] == 0 && at.emission[0] == 0 && *sigma > 0;
}

bool furnace_find(const struct scene *scene, const struct cell *cell, const struct probe *probe,
                  double radius, struct arena scratch, struct furnace *furnace) {
  double albedo = 0, emitted[3];
  if (!probe->volume || !probe->hit || cell->footprint || cell->left_out ||
      cell->direct != DIRECT_PHOTONS || cell->integrator->volume_dimension != 3 ||
      scene->n_motions > 0 || scene->camera.animation.moves || scene->camera.lens_radius > 0)
    return false;
  struct ray ray = camera_ray(&scene->camera, probe->x + 0.5, probe->y + 0.5, NULL);
  struct plane end = flat_plane(scene, probe->p, probe->n);
  if (!find_medium(scene, &furnace->sigma) || !find_walls(scene, ray.o, &albedo, emitted) ||
      !is_closed(scene, scratch))
    return false;
  furnace->distance = vec_length(vec_sub(probe->p, ray.o));
  furnace->cosine = -vec_dot(ray.d, probe->n);
  furnace->radiance = luminance(emitted, 3) / (1 - albedo);
  // Paths of more than `depth` collisions and walls are cut; of rooms some mean free paths wide,
  // with a few of them between walls, this leaves less than e^-30 of the light out.
  if (cell->depth * (1 - albedo) < 500) return false;
  return furnace->distance * furnace->cosine > radius && nearest_other(scene, &end, ray.o) > radius;
}
