#include "analysis/fit_rows.h"

#include "analysis/special.h"

#include <float.h>
#include <math.h>

const char fit_no_reference[] = "no reference";
const char fit_dark_reference[] = "the reference found no light, but photons did";
const char fit_noisy_reference[] = "the reference is too noisy (photonlab plan: how precise)";
const char fit_large_discs[] = "the first discs are too large for a rate (smaller radius)";
static const double largest_rate_se = 0.1, widest_interval = 0.3;

static void add_test(struct fit_row *row, const char *name, double statistic, double p) {
  if (!isfinite(statistic)) return;
  row->test[row->n_tests++] = (struct fit_test){.name = name, .statistic = statistic, .p = p};
}

static void add_deviate(struct fit_row *row, const char *name, double z) {
  add_test(row, name, z, special_two_sided(z));
}

// A standard error rests on a measured variance.
static void add_t(struct fit_row *row, const char *name, double t, double variance_dof) {
  add_test(row, name, t, special_t_two_sided(t, variance_dof));
}

// Root of a likelihood ratio.
static void add_silence(struct fit_row *row, double p) {
  if (isfinite(p)) add_test(row, "silence", sqrt(-2 * log(fmax(p, DBL_MIN))), p);
}

static struct fit_row *new_row(const struct results *results, const struct series *series,
                               const struct prediction *theory, enum quantity quantity,
                               struct fit *fit) {
  struct fit_row *row = &fit->row[fit->n_rows++];
  *row = (struct fit_row){
      .cell = &results->experiment.cell[series->cell],
      .probe = &results->probe[series->cell][series->probe],
      .quantity = quantity,
      .looks = results->looks ? results->looks[series->cell] : 1,
      .closed_form = theory->closed_form,
      .first = theory->first + 1,
      .rate_theory = NAN,
      .rate = NAN,
      .rate_se = NAN,
      .rate_lo = NAN,
      .rate_hi = NAN,
      .coefficient_theory = NAN,
      .coefficient = NAN,
      .coefficient_se = NAN,
      .snr = NAN,
      .expected_snr = NAN,
      .upper_bound = NAN,
      .later_p = NAN,
  };
  return row;
}

static bool has_constants(const struct prediction *theory) {
  return theory->closed_form && theory->independent;
}

static bool has_bias_constant(const struct prediction *theory) {
  return has_constants(theory) || (theory->known_bias && theory->independent);
}

static void set_rate(struct fit_row *row, double rate, double se, double lo, double hi) {
  row->resolved = se <= largest_rate_se && hi - lo <= widest_interval;
  if (!row->resolved) return;
  row->rate = rate, row->rate_se = se, row->rate_lo = lo, row->rate_hi = hi;
}

// In closed form the fits are of theory's own unit, so that a coefficient is a ratio to theory's.
static void set_coefficient(struct fit_row *row, bool known, double unit, double value, double se) {
  double scale = known ? unit : 1;
  row->coefficient = value * scale;
  row->coefficient_se = se * fabs(scale);
}

static void variance_row(const struct variance_fit *v, const struct prediction *theory,
                         struct fit_row *row) {
  row->rate_theory = theory->family.theory;
  if (has_constants(theory)) row->coefficient_theory = theory->variance_coefficient;
  add_silence(row, v->silence);
  if (v->why) return;
  set_rate(row, v->rate, v->rate_se, v->rate_lo, v->rate_hi);
  set_coefficient(row, theory->closed_form, theory->variance_coefficient, v->coefficient,
                  v->coefficient_se);
  if (row->resolved) add_t(row, "rate", v->rate_deviate, v->deviate_dof);
  if (has_constants(theory)) add_t(row, "coefficient", v->coefficient_deviate, v->deviate_dof);
}

static void bias_row(const struct bias_fit *b, const struct variance_fit *v,
                     const struct prediction *theory, struct fit_row *row) {
  if (!theory->unbiased) row->rate_theory = bias_theory_rate(theory);
  double known = theory->unbiased ? 0 : theory->bias_coefficient;
  if (theory->unbiased || has_bias_constant(theory)) row->coefficient_theory = known;
  add_silence(row, v->silence);
  if (!b->measured) return;
  set_coefficient(row, theory->closed_form || theory->known_bias, theory->unbiased ? 1 : known,
                  b->coefficient, b->coefficient_se);
  row->snr = b->snr;
  row->upper_bound =
      fabs(row->coefficient) + special_t_quantile(0.025, b->dof) * row->coefficient_se;
  row->expected_snr = fabs(row->coefficient_theory) / row->coefficient_se;
  row->detected = b->snr >= fit_detection_snr && !theory->unbiased;
  // A rate that theory says cannot be known is not known because chance put the best fit where the
  // profile is narrow.
  if (row->detected && b->rate_found && b->rate_se_theory <= largest_rate_se)
    set_rate(row, b->rate, b->rate_se, b->rate_lo, b->rate_hi);
  if (row->resolved) add_t(row, "rate", b->rate_deviate, b->dof);
  if (theory->unbiased)
    add_t(row, "zero-bias", b->coefficient / b->coefficient_se, b->dof);
  else if (has_bias_constant(theory))
    add_t(row, "coefficient", (b->coefficient - 1) / b->coefficient_se, b->dof);
}

// ---- whether a rate differs in the limit ----

// Theory's first terms are a limit. That the first discs, too large for them, bend a curve is no
// contradiction, so a rate that differs must do so without them as well: from where r^2 is half the
// first one's, or in the later half.
static bool leave_first_discs(const struct fit_row *row, const struct prediction *theory,
                              struct prediction *later) {
  const double usual_level = 0.01; // no test's is above
  if (row->closed_form || !theory->rest || !row->resolved) return false;
  if (!(row->test[0].p < usual_level)) return false;
  *later = *theory;
  uint64_t half = theory->first + (theory->n - theory->first) / 2;
  while (later->first < half &&
         theory->family.rho[later->first] > theory->family.rho[theory->first] / 2)
    later->first++;
  return true;
}

static void set_later(struct fit_row *row, double deviate, double p) {
  row->later_deviate = isfinite(p) ? deviate : 0;
  row->later_p = isfinite(p) ? p : 1;
}

// The rate's own variance where it is known well, else theory's.
static const double *weights_of(const struct variance_fit *v) {
  return v->rate_se <= largest_rate_se ? v->variance : v->expected;
}

static void variance_later(const struct fit_estimators *by, const struct series *series,
                           const struct prediction *theory, struct arena scratch,
                           struct fit_row *row) {
  struct prediction later;
  if (!leave_first_discs(row, theory, &later)) return;
  struct variance_fit v = fit_variance(&later, series->iteration, &scratch);
  if (!v.why && by) v.why = by->variance(&later, series, weights_of(&v), &v, scratch);
  double t = v.why ? NAN : v.rate_deviate;
  set_later(row, t, special_t_two_sided(t, v.deviate_dof));
}

static void bias_later(const struct fit_estimators *by, const struct series *series,
                       const struct prediction *theory, const struct variance_fit *v,
                       struct arena scratch, struct fit_row *row) {
  struct prediction later;
  if (!leave_first_discs(row, theory, &later)) return;
  struct bias_fit b = fit_bias(&later, series->iteration, v, weights_of(v), &scratch);
  if (b.measured && by) by->bias(&later, series, weights_of(v), v, &b, scratch);
  double t = b.measured && b.rate_found ? b.rate_deviate : NAN;
  set_later(row, t, special_t_two_sided(t, b.dof));
}

// Whether half the variance of the bias' coefficient is the reference's.
static bool reference_dominates(const struct prediction *theory, const struct series *series,
                                const struct variance_fit *v, const struct bias_fit *b,
                                struct arena scratch) {
  if (!b->measured || !(theory->truth_se > 0)) return false;
  struct prediction exact = *theory;
  exact.truth_se = 0;
  struct bias_fit without = fit_bias(&exact, series->iteration, v, weights_of(v), &scratch);
  return without.measured && b->coefficient_se >= sqrt(2) * without.coefficient_se;
}

// Samples that all miss what light there is look exact. Where there is none runs say nothing
// either.
static bool found_no_light(const struct probe *probe, const struct prediction *theory) {
  return isfinite(probe->reference) && !theory->closed_form && theory->truth_se == 0 &&
         theory->truth == probe->emitted;
}

static const char *why_no_truth(const struct series *series, const struct prediction *theory,
                                const struct fit_row *row) {
  if (!isfinite(theory->truth)) return fit_no_reference;
  return !series->richardson && found_no_light(row->probe, theory) ? fit_dark_reference : NULL;
}

static void fit_bias_series(const struct fit_estimators *by, const struct results *results,
                            const struct series *series, const struct prediction *theory,
                            const struct variance_fit *v, double dependence, struct arena scratch,
                            struct fit *fit) {
  struct fit_row *row = new_row(results, series, theory, QUANTITY_BIAS, fit);
  struct bias_fit b = {0};
  row->why = v->why ? v->why : why_no_truth(series, theory, row);
  if (!row->why) b = fit_bias(theory, series->iteration, v, weights_of(v), &scratch);
  if (!row->why && theory->bias_kind == BIAS_STAYS) row->why = "an edge stays in the disc";
  struct bias_fit said = b;
  if (b.measured && by) by->bias(theory, series, weights_of(v), v, &said, scratch);
  bias_row(&said, v, theory, row);
  bias_later(by, series, theory, v, scratch, row);
  if (!row->why && !row->resolved && reference_dominates(theory, series, v, &b, scratch))
    row->why = fit_noisy_reference;
  if (theory->independent && said.measured) {
    add_deviate(row, "independence", dependence); // its standard errors rest on it
    if (said.lack_of_fit.dof >= 1)
      add_test(row, "lack-of-fit", said.lack_of_fit.value,
               special_f_upper(said.lack_of_fit.value, said.lack_of_fit.dof, v->dof));
  }
  fit_bias_points(series, theory, v, &b, row, fit);
}

// Their variances are not known.
static struct moments *means_of_averages(const struct series *series,
                                         const struct moments *iteration, struct arena *arena) {
  struct moments *average = arena_new(arena, struct moments, series->n_checkpoints);
  double sum = 0;
  uint64_t j = 0;
  for (int c = 0; c < series->n_checkpoints; c++) {
    for (; j < series->checkpoint[c]; j++) sum += iteration[j].mean;
    average[c] = (struct moments){iteration[0].n, sum / (double)j, NAN, NAN, NAN};
  }
  return average;
}

// Against the same photons at half the radius: the differences of the iterations are a series of
// their own, with a variance of the usual shape.
static void fit_richardson(const struct fit_estimators *by, const struct results *results,
                           const struct series *series, const struct prediction *theory,
                           double dependence, struct arena scratch, struct fit *fit) {
  struct series difference = *series;
  difference.iteration = series->richardson;
  difference.average = means_of_averages(series, series->richardson, &scratch);
  difference.run_average = series->run_richardson;
  // Pairs of photons in one ball are others in the half, so that their share is not theory's.
  struct terms terms = {.d = theory->d, .pairs = theory->pairs == 0 ? 0 : NAN};
  struct prediction shape = prediction_from_reference(0, 0, terms, &theory->family, &scratch);
  struct prediction bias = prediction_of_richardson(theory);
  shape.first = theory->first;
  struct variance_fit v = fit_variance(&shape, series->richardson, &scratch);
  fit_bias_series(by, results, &difference, &bias, &v, dependence, scratch, fit);
}

void fit_series(const struct results *results, const struct series *series,
                const struct prediction *theory, struct arena scratch, struct fit *fit) {
  fit_series_by(NULL, results, series, theory, scratch, fit);
}

void fit_series_by(const struct fit_estimators *by, const struct results *results,
                   const struct series *series, const struct prediction *theory,
                   struct arena scratch, struct fit *fit) {
  const struct cell *cell = &results->experiment.cell[series->cell];
  struct variance_fit v = fit_variance(theory, series->iteration, &scratch);
  double ratio, dependence = fit_independence(&v, series, &ratio);
  if (cell->quantities & QUANTITY_VARIANCE) {
    struct fit_row *row = new_row(results, series, theory, QUANTITY_VARIANCE, fit);
    struct variance_fit said = v;
    if (!v.why && by) said.why = by->variance(theory, series, weights_of(&v), &said, scratch);
    row->why = said.why;
    variance_row(&said, theory, row);
    variance_later(by, series, theory, scratch, row);
    if (theory->independent) add_deviate(row, "independence", dependence);
    if (theory->independent && !said.why && said.lack_of_fit.dof >= 1)
      add_test(row, "lack-of-fit", said.lack_of_fit.value,
               special_chi2_upper(said.lack_of_fit.value, said.lack_of_fit.dof));
    fit_variance_points(series, &v, row, fit);
  }
  if (!(cell->quantities & QUANTITY_BIAS)) return;
  if (series->richardson)
    fit_richardson(by, results, series, theory, dependence, scratch, fit);
  else
    fit_bias_series(by, results, series, theory, &v, dependence, scratch, fit);
}
