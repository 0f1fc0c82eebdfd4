// Do the intervals of real experiments hold theory's value as often as they say? 400 small ones on
// the quadratic beam (100 iterations, 20 runs, seeds of their own), run, logged and fitted like any
// other: of 400 intervals of 95 % between 364 and 393 hold it, of 1000 (TEST_LONG=1) between 928
// and 970 (the 99.9 % range of a binomial). Caught with probability 0.95: a standard error 22 % too
// small. Also Kolmogorov and Smirnov's test of the p-values of all four tests, at 1e-4: uniform if
// theory and fit are right; found are deviates 0.7 or 1.45 times as large as they should be.
#define _GNU_SOURCE // mkdtemp, nftw
#include "tests/unit/run_fixture.h"

#include "analysis/fit.h"
#include "tests/p_values.h"

#include <math.h>
#include <stdio.h>

enum { MOST = 1000, NAMES = 4 };

struct size {
  int experiments, fewest, most;
};

static struct size size_asked(void) {
  bool is_long = getenv("TEST_LONG") != NULL;
  return is_long ? (struct size){1000, 928, 970} : (struct size){400, 364, 393};
}

static const char *const names[NAMES] = {"rate", "coefficient", "independence", "lack-of-fit"};

struct tally {
  int rates, covered;
  int n_p[NAMES];
  double p[NAMES][MOST];
};

static void count_row(struct tally *tally, const struct fit_row *row) {
  tally->rates += isfinite(row->rate);
  tally->covered += row->rate_lo <= row->rate_theory && row->rate_theory <= row->rate_hi;
  for (int t = 0; t < row->n_tests; t++)
    for (int k = 0; k < NAMES; k++)
      if (strcmp(row->test[t].name, names[k]) == 0) tally->p[k][tally->n_p[k]++] = row->test[t].p;
}

static void run_one(int number, struct tally tally[2]) {
  struct arena kept = arena;
  struct experiment experiment = experiment_of(
      "small", arena_format(&arena,
                            "scene: scenes/plane-quadratic-beam.pbrt\nradius: 0.7\nphotons: 100\n"
                            "depth: 1\nprobes: [[32, 32]]\niterations: 100\nruns: 20\n"
                            "seed: coverage-%d\n",
                            number));
  struct run_options options = {.threads = 2, .quiet = true};
  struct problem problem = {0};
  struct fit fit;
  if (run_experiment(&experiment, path_in("small"), options, &arena, &problem) != RUN_DONE)
    fail_msg("%s", problem.text);
  struct results results = results_of(path_in("small"));
  if (!fit_results(&results, &arena, &fit, &problem)) fail_msg("%s", problem.text);
  assert_int_equal(fit.n_rows, 2);
  for (int r = 0; r < 2; r++) count_row(&tally[r], &fit.row[r]);
  nftw(path_in("small"), remove_entry, 16, FTW_DEPTH | FTW_PHYS);
  arena = kept;
}

static void intervals_of_real_experiments_cover(void **state) {
  (void)state;
  struct size size = size_asked();
  struct tally *tally = arena_new(&arena, struct tally, 2);
  const double limit = 2.22; // 2 exp(-2 x^2) = 1e-4
  for (int k = 0; k < size.experiments; k++) run_one(k, tally);
  for (int r = 0; r < 2; r++) {
    printf("%s: %d of %d covered", r ? "bias" : "variance", tally[r].covered, size.experiments);
    for (int k = 0; k < NAMES; k++) {
      double distance = p_kolmogorov(tally[r].p[k], tally[r].n_p[k]);
      printf(", %s %.2f", names[k], distance);
      assert_int_equal(tally[r].n_p[k], size.experiments);
      assert_true(distance < limit);
    }
    printf("\n");
    assert_int_equal(tally[r].rates, size.experiments);
    assert_in_range(tally[r].covered, size.fewest, size.most);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(intervals_of_real_experiments_cover)};
  return cmocka_run_group_tests_name("coverage", tests, make_folder, remove_folder);
}
