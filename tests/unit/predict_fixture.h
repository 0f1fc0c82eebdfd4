// A cell and a probe on the plane z = 0, for the tests of predictions.
#ifndef TESTS_PREDICT_FIXTURE_H
#define TESTS_PREDICT_FIXTURE_H

#include "experiment/experiment.h"
#include "log/results.h"

#include <math.h>

static const struct integrator_type photons = {
    .name = "probabilistic", .photons = true, .independent = true};

static inline struct cell cell_of(const char *kernel, double radius) {
  return (struct cell){.integrator = &photons,
                       .reference_radius = &reference_radii[0],
                       .kernel = kernel_find(kernel),
                       .law = law_find("knaus-zwicker"),
                       .alpha = 2.0 / 3,
                       .radius = radius,
                       .photons = 1000,
                       .direct = DIRECT_PHOTONS,
                       .depth = 64};
}

// Scaled by 1, 1 and 1: values are irradiances.
static inline struct probe probe_at(double x, double y) {
  return (struct probe){.hit = true,
                        .p = vec(x, y, 0),
                        .n = vec(0, 0, 1),
                        .scale = 1,
                        .scale_rgb = {1, 1, 1},
                        .reference = NAN,
                        .reference_se = NAN};
}

#endif
