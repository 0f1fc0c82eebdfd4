#include "analysis/prediction.h"

#include "analysis/expected_radius.h"
#include "analysis/furnace.h"
#include "analysis/receiver.h"

#include <math.h>

// Of the mean of `photons` paths, from the raw moments of one: cumulants of the second to fourth
// order.
struct cumulants {
  double second, third, fourth;
};

static struct cumulants cumulants_of(const double m[PROFILE_MOMENTS], double photons) {
  double variance = m[1] - m[0] * m[0];
  double third = m[2] + m[0] * (2 * m[0] * m[0] - 3 * m[1]);
  double fourth = m[3] + m[0] * (-4 * m[2] + m[0] * (6 * m[1] - 3 * m[0] * m[0]));
  return (struct cumulants){variance / photons, third / (photons * photons),
                            (fourth - 3 * variance * variance) / (photons * photons * photons)};
}

struct iteration {
  double divergent, rest, bias, kurtosis; // as in struct prediction
};

// Where the probe is in its pixel is drawn once for all photons of an iteration: variances add up,
// the mean one at a place and that of the means.
static struct iteration one_iteration(const struct profile *profile, double r, double photons) {
  struct profile_view view[PROFILE_VIEWS];
  struct iteration out = {0, 0, 0, 0};
  int n = profile_views(profile, r, view);
  for (int k = 0; k < n; k++) out.bias += view[k].weight * view[k].bias;
  double mean = profile->exact + out.bias, square = 0, fourth = 0;
  for (int k = 0; k < n; k++) {
    const double *m = view[k].moment, weight = view[k].weight;
    struct cumulants c = cumulants_of(m, photons);
    double off = n > 1 ? m[0] - mean : 0, off2 = off * off;
    out.divergent += weight * m[1] / photons;
    out.rest += weight * (off2 - m[0] * m[0] / photons);
    square += weight * c.second * c.second;
    fourth += weight * (c.fourth + 4 * c.third * off + 6 * c.second * off2 + off2 * off2);
  }
  double variance = out.divergent + out.rest, variance2 = variance * variance;
  if (n == 1) square = variance2;
  if (variance2 > 0) out.kurtosis = (fourth + 3 * (square - variance2)) / variance2;
  return out;
}

// A bias below the rounding of the quadrature (CHEBYSHEV_TERMS^2 products) is none; to see it would
// take 1e24 photons.
static bool is_zero_bias(const double *bias, uint64_t n, double exact) {
  double largest = 0;
  for (uint64_t j = 0; j < n; j++) largest = fmax(largest, fabs(bias[j]));
  return largest <= 1e-12 * fabs(exact);
}

// What is below 1 % of something else is not measured beside it.
static const double negligible = 0.01;

// Where r^2 vanishes r^4 is left.
static enum bias_kind kind_in_smooth_light(const struct profile *profile, double last_radius) {
  double second, fourth, bias = profile_bias(profile, last_radius);
  profile_bias_terms(profile, &second, &fourth);
  bool none = fabs(second) * last_radius * last_radius < negligible * fabs(bias);
  return none ? BIAS_FOURTH : BIAS_SMOOTH;
}

// An edge nearer than that share of the last radius r is where the probe is: the bias, half the
// light less 4 a / (pi r) of it for the box, falls as r^0.03 at most. That of a pixel whose side
// the edge is differs by the square of it. The distances to the edge are those from the difference
// to the sum: places on both sides cancel if they are all there.
static enum bias_kind kind_of_bias(const struct profile *profile, double first_radius,
                                   double last_radius) {
  double distance = profile->shadow.distance, spread = profile->spread;
  double near = fabs(distance - spread), far = distance + spread;
  if (profile->shadow.shade == SHADE_NONE) return kind_in_smooth_light(profile, last_radius);
  if (near >= last_radius) return BIAS_ENDS;
  if (near >= negligible * last_radius) return BIAS_STAYS;
  if (spread == 0) return BIAS_EDGE;
  return far >= first_radius ? BIAS_SIDE : BIAS_STAYS;
}

static uint64_t count_biased(const double *bias, uint64_t n) {
  while (n > 0 && bias[n - 1] == 0) n--;
  return n;
}

// Of r1 where the measure is rho.
static double radius_at(int d, double r1, double rho) {
  return r1 * (d == 1 ? rho : d == 2 ? sqrt(rho) : cbrt(rho));
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
    double r = radius_at(profile->d, radius, family->rho[j]);
    struct iteration here = one_iteration(profile, r, photons);
    divergent[j] = here.divergent;
    rest[j] = here.rest;
    bias[j] = here.bias;
    richardson[j] = 4.0 / 3 * (here.bias - one_iteration(profile, r / 2, photons).bias);
    kurtosis[j] = here.kurtosis;
  }
  bool unbiased = is_zero_bias(bias, n, profile->exact);
  for (uint64_t j = 0; unbiased && j < n; j++) bias[j] = richardson[j] = family->rho[j];
  double second, fourth;
  bool smooth = profile_bias_terms(profile, &second, &fourth);
  if (unbiased) smooth = true, second = fourth = 0;
  double last = radius_at(profile->d, radius, family->rho[n - 1]);
  bool darkens = profile->shadow.shade == SHADE_DARK && !unbiased && divergent[n - 1] == 0;
  return (struct prediction){
      .d = profile->d,
      .n = n,
      .family = *family,
      .why_not = darkens ? "no light in the last discs" : NULL,
      .closed_form = true,
      .independent = true,
      .unbiased = unbiased,
      .bias_kind = unbiased ? BIAS_SMOOTH : kind_of_bias(profile, radius, last),
      .bias_end = count_biased(bias, n),
      .truth = profile->exact + emitted,
      .variance_coefficient = profile_roughness(profile) / (photons * pow(radius, profile->d)),
      .bias_coefficient = unbiased ? 0 : bias[0],
      .bias_terms = {smooth ? second * radius * radius : NAN,
                     smooth ? fourth * radius * radius * radius * radius : NAN},
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
  if (!theory->closed_form && !theory->known_bias) return p;
  p.bias = theory->richardson;
  if (!p.unbiased) p.bias_coefficient = p.bias[0];
  return p;
}

// Powers of rho, of r^d: variance 1/rho and a constant, in a medium with pairs on the way from one
// to the other; bias rho^(2/d) and rho^(4/d), or rho^(1/d) and rho^(2/d).
struct prediction prediction_from_reference(double reference, double reference_se,
                                            struct terms terms, const struct family *family,
                                            struct arena *arena) {
  uint64_t n = family->n;
  double *divergent = arena_new(arena, double, (ptrdiff_t)n);
  double *rest = arena_new(arena, double, (ptrdiff_t)n);
  double *bias = arena_new(arena, double, (ptrdiff_t)n);
  double *bias2 = arena_new(arena, double, (ptrdiff_t)n);
  double step = (terms.ends ? 1.0 : 2.0) / terms.d, pair_power = 1.0 / terms.d - 1;
  bool constant = true, unknown_pairs = isnan(terms.pairs);
  for (uint64_t j = 0; j < n; j++) {
    double rho = family->rho[j];
    divergent[j] = 1 / rho;
    if (terms.pairs > 0) divergent[j] += terms.pairs * pow(rho, pair_power);
    rest[j] = unknown_pairs ? pow(rho, pair_power) : 1;
    bias[j] = pow(rho, step);
    bias2[j] = pow(rho, 2 * step);
    constant &= rho == 1;
  }
  return (struct prediction){
      .d = terms.d,
      .pairs = terms.pairs,
      .n = n,
      .family = *family,
      .independent = true,
      .bias_kind = terms.ends ? BIAS_SIDE : BIAS_SMOOTH,
      .truth = reference,
      .truth_se = reference_se,
      .variance_coefficient = NAN,
      .bias_coefficient = NAN,
      .bias_terms = {NAN, NAN},
      .divergent = divergent,
      .rest = constant ? NULL : rest, // with a constant radius the terms are one
      .bias = bias,
      .bias2 = constant ? NULL : bias2,
  };
}

// The expansion in r^2 stands once the disc is clear of edges and other surfaces.
static uint64_t first_clear(const struct scene *scene, const struct probe *probe, double radius,
                            const struct family *family, struct arena scratch) {
  if (!probe->hit || probe->volume) return 0;
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
  if (!probe->hit || probe->volume) return NAN;
  double clear = receiver_clearance(scene, probe->p, probe->n, scratch);
  double radius = 0x1p-20 * (clear < INFINITY ? clear : 1);
  if (!profile_find(scene, cell, probe, radius, scratch, &profile)) return NAN;
  return profile.exact + probe->emitted;
}

// Radii that follow the photons found: those expected of them stand for the law's.
static struct family expected_family(const struct scene *scene, const struct cell *cell,
                                     const struct probe *probe, const struct family *family,
                                     struct arena *arena) {
  struct family own = *family;
  if (!cell->law->count) return own;
  double *rho = arena_new(arena, double, (ptrdiff_t)family->n);
  if (expected_radius(scene, cell, probe, cell->radius, 1, family->n, rho, *arena)) own.rho = rho;
  return own;
}

const struct law *prediction_law(const struct cell *cell) {
  return cell->integrator->photons ? cell->law : NULL;
}

struct family *prediction_family(const struct cell *cell, struct arena *arena) {
  struct family_table *table = arena_new(arena, struct family_table, 1);
  struct family *family = arena_new(arena, struct family, 1);
  *table = family_table_new(prediction_law(cell), cell->iterations, arena);
  *family = family_new(table, cell->alpha, arena);
  return family;
}

// What a wall takes of photons that are uniform.
static void set_bias_of_furnace(struct prediction *p, const struct furnace *furnace,
                                const struct cell *cell, double radius, struct arena *arena) {
  double *bias = arena_new(arena, double, (ptrdiff_t)p->n);
  double *richardson = arena_new(arena, double, (ptrdiff_t)p->n);
  for (uint64_t j = 0; j < p->n; j++) {
    double r = radius_at(p->d, radius, p->family.rho[j]);
    bias[j] = furnace_bias(furnace, cell->kernel, r);
    richardson[j] = 4.0 / 3 * (bias[j] - furnace_bias(furnace, cell->kernel, r / 2));
  }
  p->known_bias = true;
  p->bias = bias, p->bias2 = NULL, p->richardson = richardson;
  p->bias_coefficient = bias[0];
}

struct prediction prediction_new(const struct scene *scene, const struct cell *cell,
                                 const struct probe *probe, const struct family *family,
                                 struct arena *arena) {
  struct profile profile;
  struct prediction p;
  if (cell_radius_is_known(cell) &&
      profile_find(scene, cell, probe, probe_radius(cell, probe), *arena, &profile)) {
    struct family own = expected_family(scene, cell, probe, family, arena);
    p = prediction_from_profile(&profile, probe_radius(cell, probe), (double)cell->photons,
                                probe->emitted, &own, arena);
  } else {
    double truth = probe->reference, se = probe->reference_se;
    if (isnan(truth) && !cell_radius_is_known(cell))
      truth = truth_at(scene, cell, probe, *arena), se = 0;
    p = prediction_from_reference(truth, se, terms_of(scene, cell, probe), family, arena);
    p.unbiased = !cell->integrator->photons;
    if (p.unbiased) p.bias_kind = BIAS_SMOOTH;
    struct furnace furnace;
    double radius = probe_radius(cell, probe);
    if (!p.unbiased && cell_radius_is_known(cell) &&
        furnace_find(scene, cell, probe, radius, *arena, &furnace)) {
      p.truth = furnace.radiance, p.truth_se = 0;
      set_bias_of_furnace(&p, &furnace, cell, radius, arena);
    }
    if (!p.unbiased && cell_radius_is_known(cell))
      p.first = first_clear(scene, probe, cell->radius, family, *arena);
  }
  p.independent = cell->integrator->independent;
  p.radius = probe_radius(cell, probe);
  return p;
}
