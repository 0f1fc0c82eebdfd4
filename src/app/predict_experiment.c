// What an experiment is predicted to show, where its scenes have a closed form.
#include "app/predict.h"

#include <math.h>
#include <string.h>

static const uint64_t most_terms = 10000000; // iteration by iteration

// In powers of r^2.
static bool is_series(const struct prediction *p) {
  return p->bias_kind == BIAS_SMOOTH || p->bias_kind == BIAS_FOURTH;
}

// The light a closed form has around a probe, as far as two terms of the bias tell. At an edge of
// the light there are none.
static struct local_light light_in(const struct prediction *p, const struct cell *cell,
                                   const struct probe *probe) {
  double mu = p->truth - probe->emitted;
  struct local_light light = {
      .mu = mu, .photons = (double)cell->photons, .lambda = NAN, .curvature = NAN};
  if (p->closed_form)
    light.lambda = cell->kernel->constants(p->d).roughness * predict_ball(p->d, 1) * mu * mu /
                   p->variance_coefficient;
  if (p->unbiased)
    light.curvature = 0;
  else if (p->closed_form && is_series(p))
    local_light_set_bias(&light, cell->kernel, p->d, p->bias_terms[0], p->bias_terms[1]);
  return light;
}

// Where the bias is no power series in r^2 (theory 1.5, 5 iv).
static struct asymptote edge_limit(const struct prediction *p, const struct model *model,
                                   const struct curve *curve) {
  double n = (double)p->n, average = curve->point[curve->n - 1].bias;
  if (p->bias_kind == BIAS_EDGE) return (struct asymptote){p->bias[p->n - 1], 0, false};
  if (p->bias_kind == BIAS_ENDS) return (struct asymptote){average * n, 1, false};
  if (p->bias_kind != BIAS_SIDE) return (struct asymptote){NAN, NAN, false};
  struct expansion side = {1, {{p->closed_form ? p->bias[0] : NAN, 1.0 / p->d}}};
  return expansion_asymptote(&side, model->law, model->alpha, 1);
}

// No photon from some iteration on: only those of before are averaged.
static struct asymptote dark_limit(const struct curve *curve) {
  const struct curve_point *last = &curve->point[curve->n - 1];
  return (struct asymptote){last->variance * (double)last->n * (double)last->n, 2, false};
}

// At an edge the last disc still has the share of light that is there, not that of r = 0.
static double lit_share(const struct prediction *p) {
  return p->divergent[p->n - 1] * p->family.rho[p->n - 1] / p->variance_coefficient;
}

static struct predicted predict_probe(const struct scene *scene, const struct cell *cell,
                                      const struct probe *probe, struct arena *arena,
                                      struct arena scratch) {
  const struct law *law = cell->integrator->photons ? cell->law : law_find("fixed");
  struct family_table table = {.law = law, .n = cell->iterations};
  struct family family = family_new(&table, cell->alpha, &scratch);
  struct prediction p = prediction_new(scene, cell, probe, &family, &scratch);
  struct predicted predicted = {
      .cell = cell,
      .probe = probe,
      .model = model_new(law, cell->kernel, cell->alpha, p.d, light_in(&p, cell, probe)),
      .curve = curve_of_prediction(&p, cell, arena),
  };
  predicted.rates = rates_new(&predicted.model, cell->iterations);
  if (!is_series(&p)) predicted.rates.bias = edge_limit(&p, &predicted.model, &predicted.curve);
  if (p.closed_form && p.bias_kind == BIAS_EDGE) predicted.rates.variance.constant *= lit_share(&p);
  if (p.closed_form && p.divergent[p.n - 1] == 0)
    predicted.rates.variance = dark_limit(&predicted.curve);
  return predicted;
}

static bool check_experiment(const struct cli *cli, const struct experiment *experiment,
                             struct problem *problem) {
  for (int k = 0; k < cli->n_settings; k++)
    if (strcmp(cli->setting[k].key, "seed") != 0)
      return problem_set(problem, "%s: an experiment says that itself", cli->setting[k].option);
  for (int c = 0; c < experiment->n_cells; c++)
    if (experiment->cell[c].iterations > most_terms)
      return problem_set(problem, "%s: scenes are predicted up to %llu iterations, not %llu",
                         experiment->path, (unsigned long long)most_terms,
                         (unsigned long long)experiment->cell[c].iterations);
  return true;
}

// What the cells of an experiment look at, by cell.
struct sight {
  const struct scene *scene;
  const struct probe *probe;
  int n_probes;
};

static struct sight *sights_new(const struct plan *plan, int *n, struct arena *arena) {
  struct sight *sight = arena_new(arena, struct sight, plan->experiment->n_cells);
  *n = 0;
  for (int g = 0; g < plan->n_groups; g++) {
    const struct group_plan *group = &plan->group[g];
    struct probe *probe = arena_new(arena, struct probe, group->n_probes);
    plan_probes(group, probe, *arena);
    for (int e = 0; e < group->group->n_cells; e++)
      sight[group->group->cell[e]] = (struct sight){&group->loaded->scene, probe, group->n_probes};
    *n += group->n_probes * group->group->n_cells;
  }
  return sight;
}

struct predicted *predict_experiment(const struct cli *cli, uint64_t from, int *n,
                                     struct problem *problem) {
  struct experiment experiment;
  struct plan plan;
  const char *quality = cli->quality ? cli->quality : "default";
  if (!experiment_read(cli->argument, quality, cli->arena, &experiment, problem) ||
      !check_experiment(cli, &experiment, problem) ||
      !plan_make(&experiment, cli->options, cli->arena, &plan, problem))
    return NULL;
  struct sight *sight = sights_new(&plan, n, cli->arena);
  struct predicted *predicted = arena_new(cli->arena, struct predicted, *n), *next = predicted;
  struct arena scratch = arena_reserve();
  for (int c = 0; c < experiment.n_cells; c++)
    for (int p = 0; p < sight[c].n_probes; p++, next++) {
      *next = predict_probe(sight[c].scene, &experiment.cell[c], &sight[c].probe[p], cli->arena,
                            scratch);
      if (!predict_line(next, from, problem)) return NULL;
    }
  arena_release(scratch);
  return predicted;
}
