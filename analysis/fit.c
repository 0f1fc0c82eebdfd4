#include "analysis/fit.h"

#include "analysis/fit_methods.h"
#include "analysis/fit_rows.h"
#include "analysis/special.h"

#include <math.h>
#include <string.h>

const char *const verdict_names[N_VERDICTS] = {"agree", "disagree", "not-detected",
                                               "not-resolvable", "none"};

static const double family_wise_level = 0.01;

// ---- verdicts ----

static bool rejects(const struct fit_row *row, bool lack_of_fit) {
  for (int t = 0; t < row->n_tests; t++)
    if (row->test[t].rejects && lack_of_fit == (strcmp(row->test[t].name, "lack-of-fit") == 0))
      return true;
  return false;
}

// Theory's statement about a scene without closed form is asymptotic: that its first terms do not
// describe the first iterations is no contradiction, but then the rate rests on nothing.
static enum verdict row_verdict(const struct fit_row *row) {
  if (rejects(row, false) || (row->closed_form && rejects(row, true))) return VERDICT_DISAGREE;
  if (rejects(row, true)) return VERDICT_NOT_RESOLVABLE;
  if (row->quantity == QUANTITY_BIAS && !row->detected && isfinite(row->snr))
    return VERDICT_NOT_DETECTED;
  return row->resolved ? VERDICT_AGREE : VERDICT_NOT_RESOLVABLE;
}

// A row that speaks against theory without contradicting it: a bias that theory says must show
// (twice the threshold of detection) and does not, a lack of fit, or discs too large to tell.
static bool is_doubtful(const struct fit_row *row) {
  if (row->verdict == VERDICT_NOT_RESOLVABLE)
    return rejects(row, true) || row->why == fit_large_discs;
  return row->verdict == VERDICT_NOT_DETECTED && row->expected_snr >= 2 * fit_detection_snr;
}

// Any disagreement decides; otherwise the run agrees if any row does and none is doubtful. Rows
// that cannot tell do not spoil those that can. That no bias was detected is all there is to say
// only if there is no other row.
static enum verdict run_verdict(const struct fit *fit) {
  int count[N_VERDICTS] = {0};
  bool any_doubtful = false;
  for (int r = 0; r < fit->n_rows; r++) {
    count[fit->row[r].verdict]++;
    any_doubtful |= is_doubtful(&fit->row[r]);
  }
  if (count[VERDICT_DISAGREE]) return VERDICT_DISAGREE;
  if (any_doubtful) return VERDICT_NOT_RESOLVABLE;
  if (count[VERDICT_AGREE]) return VERDICT_AGREE;
  return count[VERDICT_NOT_RESOLVABLE] || !count[VERDICT_NOT_DETECTED] ? VERDICT_NOT_RESOLVABLE
                                                                       : VERDICT_NOT_DETECTED;
}

// A rate is only stated where a verdict stands on it.
static void withdraw_rate(struct fit_row *row) {
  row->rate = row->rate_se = row->rate_lo = row->rate_hi = NAN;
}

// Why nothing is said of a rate, where no fit or test has said so.
static const char *why_unresolved(const struct fit_row *row) {
  if (row->verdict != VERDICT_NOT_RESOLVABLE || rejects(row, true)) return NULL;
  return row->first >= row->cell->iterations ? "one iteration"
                                             : "too little data (photonlab plan: how many runs)";
}

// A rate that differs only by the first discs says nothing of the limit.
static void set_rejections(struct fit_row *row, double level) {
  for (int t = 0; t < row->n_tests; t++) {
    struct fit_test *test = &row->test[t];
    if (strcmp(test->name, "rate") == 0 && test->p < level && row->later_p >= level) {
      test->statistic = row->later_deviate, test->p = row->later_p;
      row->resolved = false, row->why = fit_large_discs;
    }
    test->rejects = test->p < level;
  }
}

static void leave_unjudged(struct fit *fit) {
  for (int r = 0; r < fit->n_rows; r++) fit->row[r].verdict = VERDICT_NONE;
  fit->verdict = VERDICT_NONE;
}

static void judge(struct fit *fit) {
  int n_tests = 0;
  for (int r = 0; r < fit->n_rows; r++) n_tests += fit->row[r].n_tests * fit->row[r].looks;
  fit->level = family_wise_level;
  fit->test_level = special_sidak(fit->level, n_tests);
  for (int r = 0; r < fit->n_rows; r++) {
    struct fit_row *row = &fit->row[r];
    set_rejections(row, fit->test_level);
    row->verdict = row_verdict(row);
    if (!row->why) row->why = why_unresolved(row);
    if (row->verdict == VERDICT_NOT_DETECTED || row->verdict == VERDICT_NOT_RESOLVABLE)
      withdraw_rate(row);
  }
  fit->verdict = run_verdict(fit);
}

void fit_predicted(const struct results *results, const struct prediction *prediction,
                   struct arena *arena, struct fit *fit) {
  fit_predicted_by(&fit_methods[0], results, prediction, arena, fit);
}

void fit_predicted_by(const struct fit_method *method, const struct results *results,
                      const struct prediction *prediction, struct arena *arena, struct fit *fit) {
  int max_points = 0;
  for (int s = 0; s < results->n_series; s++)
    max_points += 2 * N_CURVE_SERIES * results->series[s].n_checkpoints;
  *fit = (struct fit){
      .experiment = &results->experiment,
      .method = method,
      .row = arena_new(arena, struct fit_row, 2 * results->n_series),
      .point = arena_new(arena, struct fit_point, max_points),
  };
  for (int s = 0; s < results->n_series; s++)
    method->series(results, &results->series[s], &prediction[s], *arena, fit);
  method->caveat ? leave_unjudged(fit) : judge(fit);
}

// ---- predictions for a results directory ----

// What several series share is made once.
struct shared {
  struct scenes {
    struct known_scene {
      const char *path;
      struct scene scene;
    } * item;
    ptrdiff_t count, capacity;
  } scenes;
  struct tables {
    struct family_table **item;
    ptrdiff_t count, capacity;
  } tables;
  struct families {
    struct known_family {
      double alpha;
      struct family family;
    } * item;
    ptrdiff_t count, capacity;
  } families;
};

static const struct scene *shared_scene(struct shared *shared, const struct results *results,
                                        const struct cell *cell, struct arena *arena,
                                        struct problem *problem) {
  struct scenes *scenes = &shared->scenes;
  for (ptrdiff_t k = 0; k < scenes->count; k++)
    if (strcmp(scenes->item[k].path, cell->scene_path) == 0) return &scenes->item[k].scene;
  struct known_scene *known = arena_push(arena, scenes);
  *known = (struct known_scene){.path = cell->scene_path};
  if (!scene_read(cell->scene_path, arena, &known->scene, problem)) return NULL;
  if (known->scene.hash != results->scene_hash[cell->number]) {
    problem_set(problem, "%s: has changed since %s was made; run the experiment again",
                cell->scene_path, results->directory);
    return NULL;
  }
  return &known->scene;
}

static const struct family *shared_family(struct shared *shared, const struct cell *cell,
                                          uint64_t n, struct arena *arena) {
  const struct law *law = prediction_law(cell);
  for (ptrdiff_t k = 0; k < shared->families.count; k++) {
    struct known_family *known = &shared->families.item[k];
    if (known->family.table->law == law && known->family.n == n && known->alpha == cell->alpha)
      return &known->family;
  }
  struct family_table *table = NULL;
  for (ptrdiff_t k = 0; k < shared->tables.count; k++)
    if (shared->tables.item[k]->law == law && shared->tables.item[k]->n == n)
      table = shared->tables.item[k];
  if (!table) {
    table = arena_new(arena, struct family_table, 1);
    *table = family_table_new(law, n, arena);
    *arena_push(arena, &shared->tables) = table;
  }
  struct known_family *known = arena_push(arena, &shared->families);
  *known = (struct known_family){cell->alpha, family_new(table, cell->alpha, arena)};
  return &known->family;
}

static bool check_finite(const struct results *results, const struct series *series,
                         struct problem *problem) {
  for (uint64_t j = 0; j < series->n_iterations; j++) {
    struct moments m = series->iteration[j];
    if (isfinite(m.mean) && isfinite(m.m2) && isfinite(m.m4)) continue;
    const struct probe *probe = &results->probe[series->cell][series->probe];
    return problem_set(problem, "%s/log.csv: cell %d, probe %d,%d, iteration %llu is not finite",
                       results->directory, series->cell, probe->x, probe->y,
                       (unsigned long long)j + 1);
  }
  return true;
}

bool fit_results(const struct results *results, struct arena *arena, struct fit *fit,
                 struct problem *problem) {
  return fit_results_by(&fit_methods[0], results, arena, fit, problem);
}

bool fit_results_by(const struct fit_method *method, const struct results *results,
                    struct arena *arena, struct fit *fit, struct problem *problem) {
  if (method->accepts && !method->accepts(results, problem)) return false;
  struct shared shared = {0};
  struct prediction *prediction = arena_new(arena, struct prediction, results->n_series);
  for (int s = 0; s < results->n_series; s++) {
    const struct series *series = &results->series[s];
    const struct cell *cell = &results->experiment.cell[series->cell];
    if (!check_finite(results, series, problem)) return false;
    const struct scene *scene = shared_scene(&shared, results, cell, arena, problem);
    if (!scene) return false;
    const struct family *family = shared_family(&shared, cell, series->n_iterations, arena);
    prediction[s] =
        prediction_new(scene, cell, &results->probe[series->cell][series->probe], family, arena);
  }
  fit_predicted_by(method, results, prediction, arena, fit);
  return true;
}

double fit_largest_rate_se(const struct results *results, struct arena scratch,
                           struct problem *problem) {
  struct fit fit;
  double largest = 0;
  if (!fit_results(results, &scratch, &fit, problem)) return INFINITY;
  for (int r = 0; r < fit.n_rows; r++) {
    const struct fit_row *row = &fit.row[r];
    bool known = row->why != fit_no_reference && row->why != fit_dark_reference;
    bool asked = !isnan(row->rate_theory) && known;
    if (asked) largest = fmax(largest, isnan(row->rate_se) ? INFINITY : row->rate_se);
  }
  return largest;
}
