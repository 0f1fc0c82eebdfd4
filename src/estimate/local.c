#include "estimate/local.h"

struct local local_new(const struct measurement *measure, struct arena *arena) {
  long size = (long)measure->n_points * measure->n_estimators;
  return (struct local){.r2 = arena_new(arena, double, size),
                        .n = arena_new(arena, double, size),
                        .r = arena_new(arena, double, measure->n_estimators),
                        .found = arena_new(arena, int64_t, measure->n_estimators)};
}

void local_begin(struct local *local, const struct measurement *measure) {
  for (long k = 0; k < (long)measure->n_points * measure->n_estimators; k++) {
    double r1 = measure->estimator[k % measure->n_estimators].r1;
    local->r2[k] = r1 * r1;
    local->n[k] = 0;
  }
}

static double largest_radius(const struct local *local, const struct measurement *measure) {
  double r2 = 0;
  for (long k = 0; k < (long)measure->n_points * measure->n_estimators; k++)
    r2 = r2 < local->r2[k] ? local->r2[k] : r2;
  return sqrt(r2);
}

// The next pass' radius of each estimator at a point.
static void shrink(struct local *local, const struct measurement *measure, int point, uint64_t i) {
  for (int e = 0; e < measure->n_estimators; e++) {
    const struct estimator *estimator = &measure->estimator[e];
    long k = (long)point * measure->n_estimators + e;
    double ratio = 1;
    if (estimator->law->count) {
      local->n[k] = estimator->law->count(estimator->alpha, local->n[k], (double)local->found[e],
                                          &ratio);
      local->r2[k] *= ratio;
    } else {
      local->r2[k] =
          estimator->r1 * estimator->r1 * estimator->law->rho(estimator->alpha, i + 1);
    }
  }
}

void local_pass(struct local *local, struct photon_map *map, uint64_t i, double *frame) {
  const struct measurement *measure = map->measure;
  photon_map_emit(map, i, largest_radius(local, measure));
  for (int j = 0; j < measure->n_points; j++) {
    for (int e = 0; e < measure->n_estimators; e++)
      local->r[e] = sqrt(local->r2[(long)j * measure->n_estimators + e]);
    photon_map_gather(map, j, local->r, local->found, frame);
    shrink(local, measure, j, i);
  }
}
