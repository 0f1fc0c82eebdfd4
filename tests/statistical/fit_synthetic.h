// Experiments whose truth is known, drawn as a photon mapper would draw them: counts of photons in
// a disc, K runs of N iterations, written into struct results as a results directory would be read.
#ifndef TESTS_STATISTICAL_FIT_SYNTHETIC_H
#define TESTS_STATISTICAL_FIT_SYNTHETIC_H

#include "analysis/fit.h"
#include "numeric/rng.h"
#include "run/plan.h"

#include <math.h>
#include <string.h>

struct synthetic {
  const char *name; // the seed
  const char *law;  // theory's; NULL: Knaus and Zwicker's
  double alpha;
  uint64_t iterations, runs;
  double photons_1; // lambda_1, expected in the first disc
  double curvature; // irradiance 1 - curvature (distance / r_1)^2
  double peak;      // more than 0: irradiance (1 + peak d^2)^-2, as under a Lambertian light
  double edge;      // distance of a shadow's edge from the probe in the light, in r_1; 0: none
  bool gaussian;    // normal values instead of counts
  // What is planted: the squared radius the defect uses, in units of theory's first, at iteration i
  // where theory's is rho; values times `factor`; the same photons in every iteration.
  double (*r2)(double alpha, double rho, uint64_t i);
  double factor;
  bool reuse;
  bool black;          // every value is 0
  double reference_se; // without closed form: the reference is off by a draw of this
  bool closed_form;
  bool log_checkpoints; // those of log.csv, ten a decade, instead of the middle and the end
};

static const struct integrator_type synthetic_integrator = {
    .name = "probabilistic", .photons = true, .independent = true};

// Uniform numbers and normals of one run.
struct stream {
  struct rng_key key;
  uint64_t next;
};

static inline double stream_uniform(struct stream *stream) {
  double u0, u1;
  uint64_t path = stream->next++;
  rng_fill(stream->key, 1, &path, 1, 0, &u0, &u1);
  return u0;
}

static inline double stream_normal(struct stream *stream) {
  double u = 1 - stream_uniform(stream), v = stream_uniform(stream);
  return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

// Poisson by inversion: one uniform number.
static inline double poisson(double mean, double u) {
  double probability = exp(-mean), sum = probability;
  int count = 0;
  while (sum < u && count < 1000) {
    count++;
    probability *= mean / count;
    sum += probability;
  }
  return count;
}

// The share of a disc of radius r beyond the edge (theory 1.5).
static inline double synthetic_beyond(double edge, double r) {
  double t = edge / r;
  return t < 1 ? (acos(t) - t * sqrt(1 - t * t)) / 3.14159265358979323846 : 0;
}

// One iteration's value: E = 1 at the probe, r_1 = 1, so that a photon carries pi / lambda_1 per
// unit of area.
static inline double synthetic_value(const struct synthetic *s, double rho, uint64_t i,
                                     struct stream *stream) {
  if (s->black) return 0;
  double r2 = s->r2 ? s->r2(s->alpha, rho, i) : rho, mean = 1 - s->curvature * r2 / 2;
  if (s->peak > 0) mean = 1 / (1 + s->peak * r2);
  if (s->edge > 0) mean -= synthetic_beyond(s->edge, sqrt(r2));
  double photons = s->photons_1 * r2 * mean, value;
  if (s->gaussian)
    value = mean * (1 + stream_normal(stream) / sqrt(photons));
  else
    value = poisson(photons, stream_uniform(stream)) / (s->photons_1 * r2);
  return s->factor != 0 ? s->factor * value : value;
}

static inline struct ring_mean synthetic_ring(const struct synthetic *s) {
  // In units of r_1: density p (1 - curvature d^2), with 1e9 emitted photons. chi(x) on [0, 1].
  double density = s->photons_1 / 1e9 / 3.14159265358979323846;
  struct ring_mean ring = {.d = 2, .flux = 1 / density, .density.hi = 1};
  ring.density.coefficient[0] = density * (1 - s->curvature / 2);
  ring.density.coefficient[1] = -density * s->curvature / 2;
  if (s->edge > 0) ring.shadow = (struct half_shadow){.shade = SHADE_LIT, .distance = s->edge};
  return ring;
}

static inline const struct law *synthetic_law(const struct synthetic *s) {
  return law_find(s->law ? s->law : "knaus-zwicker");
}

// The kernel is the box.
static inline struct prediction synthetic_prediction(const struct synthetic *s,
                                                     struct arena *arena) {
  struct family_table *table = arena_new(arena, struct family_table, 1);
  *table = family_table_new(synthetic_law(s), s->iterations, arena);
  struct family *family = arena_new(arena, struct family, 1);
  *family = family_new(table, s->alpha, arena);
  if (!s->closed_form)
    return prediction_from_reference(1, s->reference_se, (struct terms){.d = 2}, family, arena);
  struct ring_mean ring = synthetic_ring(s);
  struct profile profile = profile_new(&ring, kernel_find("box"), 1);
  return prediction_from_profile(&profile, 1, 1e9, 0, family, arena);
}

static inline uint64_t *synthetic_checkpoints(const struct synthetic *s, int *count,
                                              struct arena *arena) {
  if (s->log_checkpoints) return plan_checkpoints(s->iterations, count, arena);
  uint64_t *checkpoint = arena_new(arena, uint64_t, 2);
  checkpoint[0] = (s->iterations + 1) / 2, checkpoint[1] = s->iterations;
  *count = s->iterations > 1 ? 2 : 1;
  return checkpoint;
}

static inline struct series synthetic_series(const struct synthetic *s, const double *rho,
                                             uint64_t experiment, struct arena *arena) {
  uint64_t n = s->iterations;
  struct series series = {.n_iterations = n};
  series.iteration = arena_new(arena, struct moments, (ptrdiff_t)n);
  series.checkpoint = synthetic_checkpoints(s, &series.n_checkpoints, arena);
  series.average = arena_new(arena, struct moments, series.n_checkpoints);
  series.run_average = arena_new(arena, double, series.n_checkpoints *(ptrdiff_t)s->runs);
  for (uint64_t run = 1; run <= s->runs; run++) {
    struct stream stream = {rng_key(rng_hash_name(s->name) + experiment, run, RNG_TEST), 0};
    double sum = 0;
    for (uint64_t i = 1, c = 0; i <= n; i++) {
      if (s->reuse) stream.next = 0;
      double value = synthetic_value(s, rho[i - 1], i, &stream);
      series.iteration[i - 1] = moments_merge(series.iteration[i - 1], moments_of(value));
      sum += value;
      if (i != series.checkpoint[c]) continue;
      series.average[c] = moments_merge(series.average[c], moments_of(sum / (double)i));
      series.run_average[c * s->runs + run - 1] = sum / (double)i;
      c++;
    }
  }
  return series;
}

// The prediction is the same for all experiments but for the truth.
static inline struct prediction *synthetic_truth(const struct synthetic *s,
                                                 const struct prediction *theory,
                                                 uint64_t experiment, struct arena *arena) {
  struct stream off = {rng_key(rng_hash_name(s->name) + experiment, 0, RNG_REFERENCE), 0};
  struct prediction *prediction = arena_new(arena, struct prediction, 1);
  *prediction = *theory;
  if (s->reference_se > 0) prediction->truth = 1 + s->reference_se * stream_normal(&off);
  return prediction;
}

// One cell at one probe.
static inline struct results *synthetic_results(const struct synthetic *s, const double *rho,
                                                uint64_t experiment, struct arena *arena) {
  struct results *results = arena_new(arena, struct results, 1);
  struct cell *cell = arena_new(arena, struct cell, 1);
  *cell = (struct cell){.scene = "synthetic",
                        .reference_radius = &reference_radii[0],
                        .integrator = &synthetic_integrator,
                        .kernel = kernel_find("box"),
                        .law = synthetic_law(s),
                        .alpha = s->alpha,
                        .radius = 1,
                        .iterations = s->iterations,
                        .runs = s->runs,
                        .quantities = QUANTITY_VARIANCE | QUANTITY_BIAS};
  struct probe **probe = arena_new(arena, struct probe *, 1);
  probe[0] = arena_new(arena, struct probe, 1);
  probe[0]->hit = true;
  struct series *series = arena_new(arena, struct series, 1);
  *series = synthetic_series(s, rho, experiment, arena);
  *results = (struct results){
      .directory = "synthetic",
      .experiment = {.name = s->name, .quality = "default", .cell = cell, .n_cells = 1},
      .probe = probe,
      .series = series,
      .n_series = 1};
  return results;
}

static inline struct fit synthetic_fit_with(const struct synthetic *s,
                                            const struct prediction *theory, uint64_t experiment,
                                            struct arena *arena) {
  struct results *results = synthetic_results(s, theory->family.rho, experiment, arena);
  struct fit fit;
  fit_predicted(results, synthetic_truth(s, theory, experiment, arena), arena, &fit);
  return fit;
}

static inline struct fit synthetic_fit(const struct synthetic *s, uint64_t experiment,
                                       struct arena *arena) {
  struct prediction theory = synthetic_prediction(s, arena);
  return synthetic_fit_with(s, &theory, experiment, arena);
}

static inline const struct fit_test *synthetic_test(const struct fit_row *row, const char *name) {
  for (int t = 0; t < row->n_tests; t++)
    if (strcmp(row->test[t].name, name) == 0) return &row->test[t];
  return NULL;
}

#endif
