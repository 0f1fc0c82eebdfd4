// Progressive photon mapping (Hachisuka, Ogaki, Jensen 2008): one eye pass a run gives the hit
// points, each with a radius and count of its own; photon passes follow. A pixel is the mean of its
// hit points. What is random at the camera (place in the pixel, lens, choice between a mirror and
// what lies under it) is drawn with them, so that a run tends to what its own points see: more
// points, or more runs, bring that to the pixel's mean, more iterations do not. Nothing may move:
// photons of other times do not belong to these points.
#include "estimate/local.h"
#include "integrator/integrator.h"

#include <assert.h>
#include <string.h>

struct ppm {
  const struct measurement *measure;
  struct measurement points; // hit points for pixels, set after set
  struct local *local;
  double *frame; // of the hit points
  bool seen;     // in this run
};

static void *ppm_new(const struct measurement *measure, struct arena *arena) {
  struct ppm *state = arena_new(arena, struct ppm, 1);
  int sets = measure->hit_points > 1 ? measure->hit_points : 1, n = measure->n_points;
  assert(!scene_features(measure->scene).motion);
  struct pixel *pixel = arena_new(arena, struct pixel, (ptrdiff_t)sets * n);
  for (int s = 0; s < sets; s++)
    memcpy(pixel + (ptrdiff_t)s * n, measure->pixel, (size_t)n * sizeof *pixel);
  state->measure = measure;
  state->points = *measure;
  state->points.pixel = pixel;
  state->points.n_points = sets * n;
  state->points.keep_points = true;
  state->frame = arena_new(arena, double, photon_map_frame(&state->points));
  state->local = local_new(&state->points, arena);
  state->local->map->sets = sets;
  return state;
}

static void ppm_begin(void *data, uint64_t run) {
  struct ppm *state = data;
  state->seen = false;
  local_begin(state->local, run);
}

// The mean over each pixel's hit points.
static void average(const struct ppm *state, double *frame) {
  int sets = state->local->map->sets;
  long film = (long)state->measure->n_points * state->measure->features.n_channels;
  for (int e = 0; e < state->measure->n_estimators; e++)
    for (long k = 0; k < film; k++) {
      double sum = 0;
      for (int s = 0; s < sets; s++) sum += state->frame[(e * sets + s) * film + k];
      frame[e * film + k] = sum / sets;
    }
}

static void ppm_step(void *data, uint64_t i, double *frame) {
  struct ppm *state = data;
  if (!state->seen) local_see(state->local, 0);
  state->seen = true;
  local_pass(state->local, i, state->frame);
  average(state, frame);
}

static int64_t ppm_bytes(const void *data) {
  return local_bytes(((const struct ppm *)data)->local);
}

static const struct local *ppm_local(const void *data) { return ((const struct ppm *)data)->local; }

static bool ppm_accepts(const struct scene *scene, bool footprint, struct problem *problem) {
  (void)footprint;
  return !scene_features(scene).media ||
         problem_set(problem,
                     "%s: integrator ppm draws its points once, and in participating media where "
                     "a ray ends is random: take sppm or probabilistic",
                     scene->path);
}

const struct integrator_type integrator_ppm = {
    .name = "ppm",
    .about = "hit points of one eye pass, then photon passes that shrink each point's own radius",
    .source = "Hachisuka, Ogaki and Jensen 2008",
    .law = "hachisuka",
    .photons = true,
    .independent = false,
    .one_eye_pass = true,
    .accepts = ppm_accepts,
    .create = ppm_new,
    .begin = ppm_begin,
    .step = ppm_step,
    .bytes = ppm_bytes,
    .local = ppm_local,
};
