#include "estimate/reference_radius.h"

static double global_at(struct radii *radii, const struct eye_point *point, int k) {
  (void)radii, (void)point, (void)k;
  return 1;
}

static double pixel_at(struct radii *radii, const struct eye_point *point, int k) {
  (void)radii, (void)k;
  return point->across;
}

static double differentials_at(struct radii *radii, const struct eye_point *point, int k) {
  (void)radii, (void)k;
  return point->footprint;
}

// One pass with random numbers of its own, the same in all runs: radii that depend on no
// iteration's photons leave every iteration unbiased where density is uniform.
static void draw(struct radii *radii) {
  const struct measurement *measure = radii->map->measure;
  struct walk *walk = radii->map->walk;
  struct photon_pass pass = {.n_emitted = measure->n_emitted,
                             .depth = measure->depth,
                             .first_vertex = measure->nee ? 1 : 0};
  walk->key = rng_key(measure->seed, 0, RNG_RADII);
  walk_begin(walk, measure->seed, 0, 0);
  struct photon_sinks sinks = {.surface = {&radii->photons, NULL}};
  photons_trace(walk, &pass, &sinks, radii->arena);
  knn_build(&radii->tree, radii->photons.position, radii->photons.count, radii->arena);
  radii->drawn = true;
}

// Infinite where fewer than k photons were found that the point scatters.
static double nearest_at(struct radii *radii, const struct eye_point *point, int k) {
  if (!radii->drawn) draw(radii);
  return gather_distance(&radii->gather, &radii->photons, &radii->tree, point,
                         radii->map->measure->depth, k, radii->arena);
}

// clang-format off
const struct reference_radius reference_radii[] = {
  {"global", "1: the radius is in scene units", "Knaus and Zwicker 2011",
   .global = true, .at = global_at},
  {"pixel", "the pixel's width across a straight ray as long as the eye path",
   "Igehy 1999, without bounces", .differentials = true, .at = pixel_at},
  {"knn", "distance to the k-th nearest photon of a pass drawn once", "Knaus and Zwicker 2011",
   .nearest = true, .at = nearest_at},
  {"ray-differentials", "the pixel's width on the surface, through specular bounces", "Igehy 1999",
   .differentials = true, .at = differentials_at},
};
// clang-format on
const int n_reference_radii = sizeof reference_radii / sizeof *reference_radii;

static const struct reference_radius *row_of(const struct estimator *estimator) {
  return estimator->reference ? estimator->reference : &reference_radii[0];
}

struct radii radii_new(struct photon_map *map, struct arena *arena) {
  const struct measurement *measure = map->measure;
  struct radii radii = {.map = map, .arena = arena, .global = true};
  bool differentials = false;
  for (int e = 0; e < measure->n_estimators; e++) {
    radii.global &= row_of(&measure->estimator[e])->global;
    differentials |= row_of(&measure->estimator[e])->differentials;
  }
  if (differentials) walk_follow_differentials(map->walk, arena);
  long points = map->point ? measure->n_points : TILE_POINTS;
  radii.value = arena_new(arena, double, points * measure->n_estimators);
  radii.r = arena_new(arena, double, measure->n_estimators);
  return radii;
}

void radii_set(struct radii *radii) {
  const struct measurement *measure = radii->map->measure;
  for (int j = 0; j < radii->map->tile.n; j++)
    for (int e = 0; e < measure->n_estimators; e++) {
      const struct estimator *estimator = &measure->estimator[e];
      const struct eye_point *point = &radii->map->tile.point[j];
      double *value = &radii->value[(long)j * measure->n_estimators + e];
      *value = point->bsdf.type ? row_of(estimator)->at(radii, point, estimator->k) : 0;
    }
}

const double *radii_scale(struct radii *radii, int point, const double *r) {
  int n = radii->map->measure->n_estimators, j = point - radii->map->tile.first;
  for (int e = 0; e < n; e++) radii->r[e] = r[e] * radii->value[(long)j * n + e];
  return radii->r;
}

int64_t radii_bytes(const struct radii *radii) {
  return photons_bytes(&radii->photons) + radii->tree.count * (int64_t)sizeof(struct knn_item);
}
