// Stochastic progressive photon mapping (Hachisuka, Jensen 2009): a new eye pass each iteration;
// radius and count belong to the pixel, whatever point of its footprint, lens or shutter is seen.
#include "estimate/local.h"
#include "integrator/integrator.h"

static void *sppm_new(const struct measurement *measure, struct arena *arena) {
  return local_new(measure, arena);
}

static void sppm_begin(void *state, uint64_t run) { local_begin(state, run); }

static void sppm_step(void *state, uint64_t i, double *frame) {
  local_see(state, i);
  local_pass(state, i, frame);
}

static int64_t sppm_bytes(const void *state) { return local_bytes(state); }

static const struct local *sppm_local(const void *state) { return state; }

const struct integrator_type integrator_sppm = {
    .name = "sppm",
    .about = "a new eye pass each iteration, radius and count shared by the pixel",
    .source = "Hachisuka and Jensen 2009",
    .law = "hachisuka",
    .photons = true,
    .independent = false,
    .volume_dimension = 3,
    .create = sppm_new,
    .begin = sppm_begin,
    .step = sppm_step,
    .bytes = sppm_bytes,
    .local = sppm_local,
};
