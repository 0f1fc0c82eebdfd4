// radii.csv and the verdicts on radii of local statistics.
#define _GNU_SOURCE // mkdtemp, nftw
#include "analysis/fit_radii.h"
#include "tests/unit/run_fixture.h"

#include <math.h>

#define UNIFORM                                                                                    \
  "scene: scenes/plane-uniform-beam.pbrt\nintegrator: sppm\nradius: 0.3\nphotons: 100\ndepth: 1\n" \
  "probes: [[32, 32]]\nquantity: none\niterations: 12\nruns: 16\n"

static struct fit_radii fit_of(const struct results *results) {
  struct fit_radii fit;
  struct problem problem = {0};
  if (!fit_radii(results, &arena, &fit, &problem)) fail_msg("%s", problem.text);
  return fit;
}

// Two local laws and a global one; the last has nothing to test.
static struct results three_laws(void) {
  return run("laws", UNIFORM "law: [hachisuka, pbrt, knaus-zwicker]\n");
}

// Nine photons in the first disc. A mean moved by 100 of its standard errors is refused.
static void radii_are_judged_by_their_expectation(void **state) {
  (void)state;
  struct results results = three_laws();
  struct fit_radii fit = fit_of(&results);
  assert_int_equal(fit.count, 3);
  for (int k = 0; k < 2; k++) {
    const struct radius_row *row = &fit.item[k];
    assert_true(fabs(row->first_disc - 9) < 1e-9);
    assert_true(fabs(row->se / (row->spread[11] / 4) - 1) < 1e-12);
    assert_true(fabs(row->mean / row->expected[11] - 1) < 0.2);
    assert_int_equal(row->verdict, VERDICT_AGREE);
  }
  assert_true(isnan(fit.item[2].p) && fit.item[2].verdict == VERDICT_NOT_RESOLVABLE);
  assert_true(fabs(fit.test_level - (1 - sqrt(0.99))) < 1e-12); // Sidak, two tests

  results.series[1].radius2[11].mean += 100 * fit.item[1].se * 0.09;
  struct fit_radii moved = fit_of(&results);
  assert_int_equal(moved.item[0].verdict, VERDICT_AGREE);
  assert_int_equal(moved.item[1].verdict, VERDICT_DISAGREE);
  assert_true(fabs((moved.item[1].mean - fit.item[1].mean) / fit.item[1].se - 100) < 1e-6);
}

// A line for each law and checkpoint; r_2^2 of hachisuka is (1 + alpha) / 2 unless nothing was
// found, and that of the global law exactly.
static void the_table_has_a_line_per_checkpoint(void **state) {
  (void)state;
  struct results results = three_laws();
  struct fit_radii fit = fit_of(&results);
  struct problem problem = {0};
  if (!fit_radii_write(&fit, path_in("radii.csv"), &problem)) fail_msg("%s", problem.text);
  const char *text = read_text(path_in("radii.csv"));
  int lines = 0, seconds = 0;
  for (const char *at = text; (at = strchr(at, '\n')); at++) lines++;
  assert_int_equal(lines, 1 + 3 * results.series[0].n_checkpoints);
  assert_non_null(strstr(text, ",x,y,first_disc,i,runs,mean,sd,rho,expected,spread\n"));
  for (const char *at = text; (at = strstr(at, ",2,16,")); at++, seconds++) {
    double mean, sd, rho;
    assert_int_equal(sscanf(at, ",2,16,%lf,%lf,%lf", &mean, &sd, &rho), 3);
    if (seconds != 1) assert_true(fabs(mean - 5.0 / 6) < 1e-3 && fabs(rho - 5.0 / 6) < 1e-8);
    if (seconds == 1) assert_true(fabs(mean - 2.0 / 3) < 1e-3 && fabs(rho - 2.0 / 3) < 1e-8);
  }
  assert_int_equal(seconds, 3);
}

// Where nobody knows the light, where the disc is not at a point, and without local statistics.
static void what_has_no_expectation_is_not_judged(void **state) {
  (void)state;
  struct results box = run("box", BOX "integrator: sppm\nquantity: none\nprobes: [[20, 60]]\n");
  struct results pixel = run("pixel", UNIFORM "pixel: footprint\n");
  struct results global = run("global", BEAM);
  struct fit_radii in_box = fit_of(&box), in_pixel = fit_of(&pixel);
  assert_true(in_box.count == 1 && !in_box.item[0].expected && isnan(in_box.item[0].first_disc));
  assert_true(in_pixel.count == 1 && !in_pixel.item[0].expected && isnan(in_pixel.item[0].p));
  assert_int_equal(fit_of(&global).count, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(radii_are_judged_by_their_expectation),
      cmocka_unit_test(the_table_has_a_line_per_checkpoint),
      cmocka_unit_test(what_has_no_expectation_is_not_judged),
  };
  return cmocka_run_group_tests_name("fit_radii", tests, make_folder, remove_folder);
}
