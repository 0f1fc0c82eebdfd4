#include "run/resolved.h"

#include "estimate/reference_radius.h"

static bool counts_in_scene_units(const struct estimator *estimator) {
  return !estimator->reference || estimator->reference->global;
}

static bool all_count_in_scene_units(const struct measurement *measure) {
  for (int e = 0; e < measure->n_estimators; e++)
    if (!counts_in_scene_units(&measure->estimator[e])) return false;
  return true;
}

// Of every estimator at probe p; one that is 0 or infinite is none.
static bool check_probe(const struct group_plan *plan, const struct measurement *measure, int p,
                        const double *r, struct problem *problem) {
  const struct scene *scene = measure->scene;
  for (int e = 0; e < measure->n_estimators; e++) {
    struct problem small = {0};
    if (counts_in_scene_units(&measure->estimator[e]) || !(r[e] > 0 && r[e] < INFINITY)) continue;
    if (grid_radius_is_resolved(scene->bounds, r[e], &small)) continue;
    return problem_set(problem, "%s: probe [%d, %d]: %s", plan->cell->scene_path,
                       plan->probe_pixel[p].x, plan->probe_pixel[p].y, small.text);
  }
  return true;
}

bool resolved_at_probes(const struct group_plan *plan, struct arena scratch,
                        struct problem *problem) {
  struct measurement measure = plan->measure;
  measure.pixel = plan->probe_pixel;
  measure.n_points = plan->n_probes;
  measure.keep_points = true;
  if (!plan->cell->integrator->photons || all_count_in_scene_units(&measure)) return true;
  struct photon_map *map = photon_map_new(&measure, &scratch);
  struct radii radii = radii_new(map, &scratch);
  double *last = arena_new(&scratch, double, measure.n_estimators);
  for (int e = 0; e < measure.n_estimators; e++) {
    const struct estimator *of = &measure.estimator[e];
    last[e] = law_radius(of->law, of->alpha, of->r1, 2, plan->cell->iterations);
  }
  map->run = 1;
  photon_map_see(map, 1);
  radii_set(&radii);
  for (int p = 0; p < plan->n_probes; p++)
    if (!check_probe(plan, &measure, p, radii_scale(&radii, p, last), problem)) return false;
  return true;
}
