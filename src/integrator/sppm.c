// Stochastic progressive photon mapping (Hachisuka, Jensen 2009): a new eye pass each iteration; radius
// and count belong to the pixel, whatever point of its footprint, lens or shutter is seen.
#include "estimate/local.h"
#include "integrator/integrator.h"

#include <string.h>

struct sppm {
  struct photon_map *map;
  struct local local;
};

static void *sppm_new(const struct measurement *measure, struct arena *arena) {
  struct sppm *state = arena_new(arena, struct sppm, 1);
  state->map = photon_map_new(measure, arena);
  state->local = local_new(measure, arena);
  return state;
}

static void sppm_begin(void *data, uint64_t run) {
  struct sppm *state = data;
  state->map->run = run;
  local_begin(&state->local, state->map->measure);
}

static void sppm_step(void *data, uint64_t i, double *frame) {
  struct sppm *state = data;
  memset(frame, 0, (size_t)photon_map_frame(state->map->measure) * sizeof *frame);
  photon_map_see(state->map, i);
  local_pass(&state->local, state->map, i, frame);
  photon_map_add_seen(state->map, i, frame);
}

const struct integrator_type integrator_sppm = {
    .name = "sppm",
    .about = "a new eye pass each iteration, radius and count shared by the pixel",
    .source = "Hachisuka and Jensen 2009",
    .photons = true,
    .independent = false,
    .create = sppm_new,
    .begin = sppm_begin,
    .step = sppm_step,
};
