// The radii of experiments/kernels.yaml, which are written out there: each kernel has the box's
// radius in one cell of a scene and its leading variance, R / r^2 (theory 1.3), in another.
#include "experiment/experiment.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

static struct arena arena;

static const struct cell *find_cell(const struct experiment *experiment, const struct cell *like,
                                    const char *kernel, int which) {
  for (int c = 0; c < experiment->n_cells; c++) {
    const struct cell *cell = &experiment->cell[c];
    if (cell->integrator != like->integrator || strcmp(cell->scene, like->scene) != 0) continue;
    if (strcmp(cell->kernel->name, kernel) == 0 && which-- == 0) return cell;
  }
  return NULL;
}

static double roughness(const struct cell *cell) { return cell->kernel->constants(2).roughness; }

static void test_radii(void **state) {
  (void)state;
  struct experiment experiment;
  struct problem problem = {0};
  if (!experiment_read("experiments/kernels.yaml", "default", &arena, &experiment, &problem))
    fail_msg("%s", problem.text);
  int compared = 0;
  for (int c = 0; c < experiment.n_cells; c++) {
    const struct cell *cell = &experiment.cell[c];
    if (!cell->integrator->photons || strcmp(cell->kernel->name, "box") == 0) continue;
    const struct cell *box = find_cell(&experiment, cell, "box", 0);
    const struct cell *equal_radius = find_cell(&experiment, cell, cell->kernel->name, 0);
    const struct cell *equal_variance = find_cell(&experiment, cell, cell->kernel->name, 1);
    assert_non_null(box);
    assert_non_null(equal_variance);
    assert_true(equal_radius->radius == box->radius);
    double ratio = equal_variance->radius / box->radius; // its 16 digits are right to 1e-16
    if (!(fabs(ratio * ratio * roughness(box) / roughness(cell) - 1) < 4e-15))
      fail_msg("%s, %s: radius %.17g", cell->scene, cell->kernel->name, equal_variance->radius);
    compared++;
  }
  assert_true(compared > 0);
}

int main(void) {
  arena = arena_reserve();
  const struct CMUnitTest tests[] = {
      {"each kernel has the box's radius and its variance", test_radii, 0, 0, 0},
  };
  return cmocka_run_group_tests_name("equal_variance", tests, NULL, NULL);
}
