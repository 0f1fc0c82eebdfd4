#include "analysis/prediction.h"

#include "analysis/receiver.h"

#include <math.h>

// Excess kurtosis of a mean of `photons` values with these raw moments.
static double excess_kurtosis(const double m[PROFILE_MOMENTS], double photons) {
  double variance = m[1] - m[0] * m[0];
  if (variance == 0) return 0; // no photon, ever
  double fourth = m[3] + m[0] * (-4 * m[2] + m[0] * (6 * m[1] - 3 * m[0] * m[0]));
  return (fourth / (variance * variance) - 3) / photons;
}

// A bias below the rounding of the quadrature (CHEBYSHEV_TERMS^2 products) is none; to see it would
// take 1e24 photons.
static bool is_zero_bias(const double *bias, uint64_t n, double exact) {
  double largest = 0;
  for (uint64_t j = 0; j < n; j++) largest = fmax(largest, fabs(bias[j]));
  return largest <= 1e-12 * fabs(exact);
}

// At an edge nearer than 1 % of the last radius r the bias, half the light less 4 a / (pi r) of it
// for the box, falls as r^0.03 at most: nobody measures that.
static const double at_edge = 0.01;

static enum bias_kind kind_of_bias(const struct profile *profile, double last_radius) {
  if (profile->shadow.shade == SHADE_NONE) return BIAS_SMOOTH;
  if (profile->shadow.distance >= last_radius) return BIAS_ENDS;
  return profile->shadow.distance < at_edge * last_radius ? BIAS_EDGE : BIAS_STAYS;
}

static uint64_t count_biased(const double *bias, uint64_t n) {
  while (n > 0 && bias[n - 1] == 0) n--;
  return n;
}

struct prediction prediction_from_profile(const struct profile *profile, double radius,
                                          double photons, double emitted,
                                          const struct family *family, struct arena *arena) {
  uint64_t n = family->n;
  double *divergent = arena_new(arena, double, (ptrdiff_t)n);
  double *rest = arena_new(arena, double, (ptrdiff_t)n);
  double *bias = arena_new(arena, double, (ptrdiff_t)n);
  double *kurtosis = arena_new(arena, double, (ptrdiff_t)n);
  double *richardson = arena_new(arena, double, (ptrdiff_t)n);
  for (uint64_t j = 0; j < n; j++) {
    double r = radius * sqrt(family->rho[j]), moment[PROFILE_MOMENTS];
    for (int k = 0; k < PROFILE_MOMENTS; k++) moment[k] = profile_moment(profile, k + 1, r);
    divergent[j] = moment[1] / photons;
    rest[j] = -moment[0] * moment[0] / photons;
    bias[j] = profile_bias(profile, r);
    richardson[j] = 4.0 / 3 * (bias[j] - profile_bias(profile, r / 2));
    kurtosis[j] = excess_kurtosis(moment, photons);
  }
  bool unbiased = is_zero_bias(bias, n, profile->exact);
  for (uint64_t j = 0; unbiased && j < n; j++) bias[j] = richardson[j] = family->rho[j];
  bool darkens = profile->shadow.shade == SHADE_DARK && !unbiased && divergent[n - 1] == 0;
  return (struct prediction){
      .d = 2,
      .n = n,
      .family = *family,
      .why_not = darkens ? "no light in the last discs" : NULL,
      .closed_form = true,
      .independent = true,
      .unbiased = unbiased,
      .bias_kind =
          unbiased ? BIAS_SMOOTH : kind_of_bias(profile, radius * sqrt(family->rho[n - 1])),
      .bias_end = count_biased(bias, n),
      .truth = profile->exact + emitted,
      .variance_coefficient = profile_roughness(profile) / (photons * radius * radius),
      .bias_coefficient = unbiased ? 0 : bias[0],
      .divergent = divergent,
      .rest = rest,
      .bias = bias,
      .kurtosis = kurtosis,
      .richardson = richardson,
  };
}

struct prediction prediction_of_richardson(const struct prediction *theory) {
  struct prediction p = *theory;
  p.truth = p.truth_se = 0;
  if (!theory->closed_form) return p;
  p.bias = theory->richardson;
  if (!p.unbiased) p.bias_coefficient = p.bias[0];
  return p;
}

// Powers of rho: variance d^0, rho^(2/d - 1) and 1/rho; bias rho^(2/d) and rho^(4/d).
struct prediction prediction_from_reference(double reference, double reference_se, int d,
                                            const struct family *family, struct arena *arena) {
  uint64_t n = family->n;
  double *divergent = arena_new(arena, double, (ptrdiff_t)n);
  double *rest = arena_new(arena, double, (ptrdiff_t)n);
  double *bias = arena_new(arena, double, (ptrdiff_t)n);
  double *bias2 = arena_new(arena, double, (ptrdiff_t)n);
  bool constant = true;
  for (uint64_t j = 0; j < n; j++) {
    double rho = family->rho[j];
    divergent[j] = 1 / rho;
    rest[j] = pow(rho, 2.0 / d - 1);
    bias[j] = pow(rho, 2.0 / d);
    bias2[j] = pow(rho, 4.0 / d);
    constant &= rho == 1;
  }
  return (struct prediction){
      .d = d,
      .n = n,
      .family = *family,
      .independent = true,
      .truth = reference,
      .truth_se = reference_se,
      .variance_coefficient = NAN,
      .bias_coefficient = NAN,
      .divergent = divergent,
      .rest = constant ? NULL : rest, // with a constant radius the terms are one
      .bias = bias,
      .bias2 = constant ? NULL : bias2,
  };
}

// The expansion in r^2 stands once the disc is clear of edges and other surfaces.
static uint64_t first_clear(const struct scene *scene, const struct probe *probe, double radius,
                            const struct family *family, struct arena scratch) {
  if (!probe->hit) return 0;
  double clear = receiver_surroundings(scene, probe->p, probe->n, scratch);
  uint64_t first = family->n;
  while (first > 0 && radius * sqrt(family->rho[first - 1]) < clear) first--;
  return first;
}

// What is true where a light has a closed form, also if the radius is not known: that of a disc so
// small (2^-20 of what is clear) that no closed form changes within it. NAN: no closed form.
static double truth_at(const struct scene *scene, const struct cell *cell,
                       const struct probe *probe, struct arena scratch) {
  struct profile profile;
  if (!probe->hit) return NAN;
  double clear = receiver_clearance(scene, probe->p, probe->n, scratch);
  double radius = 0x1p-20 * (clear < INFINITY ? clear : 1);
  if (!profile_find(scene, cell, probe, radius, scratch, &profile)) return NAN;
  return profile.exact + probe->emitted;
}

struct prediction prediction_new(const struct scene *scene, const struct cell *cell,
                                 const struct probe *probe, const struct family *family,
                                 struct arena *arena) {
  struct profile profile;
  struct prediction p;
  if (cell_radius_is_known(cell) &&
      profile_find(scene, cell, probe, cell->radius, *arena, &profile)) {
    p = prediction_from_profile(&profile, cell->radius, (double)cell->photons, probe->emitted,
                                family, arena);
  } else {
    double truth = probe->reference, se = probe->reference_se;
    if (isnan(truth) && !cell_radius_is_known(cell))
      truth = truth_at(scene, cell, probe, *arena), se = 0;
    p = prediction_from_reference(truth, se, 2, family, arena);
    p.unbiased = !cell->integrator->photons;
    if (!p.unbiased && cell_radius_is_known(cell))
      p.first = first_clear(scene, probe, cell->radius, family, *arena);
  }
  p.independent = cell->integrator->independent;
  return p;
}
