// Progressive photon mapping (Hachisuka, Ogaki, Jensen 2008): one eye pass a run gives the points, each
// with a radius and count of its own; photon passes follow.
#include "estimate/local.h"
#include "integrator/integrator.h"

#include <string.h>

struct ppm {
  struct photon_map *map;
  struct local local;
};

static void *ppm_new(const struct measurement *measure, struct arena *arena) {
  struct ppm *state = arena_new(arena, struct ppm, 1);
  state->map = photon_map_new(measure, arena);
  state->local = local_new(measure, arena);
  return state;
}

static void ppm_begin(void *data, uint64_t run) {
  struct ppm *state = data;
  state->map->run = run;
  local_begin(&state->local, state->map->measure);
}

static void ppm_step(void *data, uint64_t i, double *frame) {
  struct ppm *state = data;
  memset(frame, 0, (size_t)photon_map_frame(state->map->measure) * sizeof *frame);
  if (i == 1) photon_map_see(state->map, 0);
  local_pass(&state->local, state->map, i, frame);
  photon_map_add_seen(state->map, i, frame);
}

const struct integrator_type integrator_ppm = {
    .name = "ppm",
    .about = "one eye pass, then photon passes that shrink each point's own radius",
    .source = "Hachisuka, Ogaki and Jensen 2008",
    .photons = true,
    .independent = false,
    .create = ppm_new,
    .begin = ppm_begin,
    .step = ppm_step,
};
