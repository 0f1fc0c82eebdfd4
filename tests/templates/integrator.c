// An integrator, here path tracing that meets its lights by chance (Kajiya 1986, without next-event
// estimation). Copy this file to src/integrator/chance.c: the build finds integrator_chance by the
// file's name. `photonlab render --integrator chance` and an experiment's `integrator: chance` find
// it by its .name; the tests of all integrators include it.
#include "integrator/integrator.h"

#include "walk/eye.h"

#include <string.h>

// The state of one thread. Everything random is a function of (seed, run, iteration, path,
// dimension), so nothing of an iteration need be remembered for the next.
struct chance {
  const struct measurement *measure;
  struct walk *walk;
  uint64_t run;
};

static void *chance_new(const struct measurement *measure, struct arena *arena) {
  struct chance *state = arena_new(arena, struct chance, 1);
  state->measure = measure;
  state->walk = walk_new(measure->scene, measure->bvh, measure->features, arena);
  return state;
}

static void chance_begin(void *data, uint64_t run) {
  struct chance *state = data;
  state->run = run;
}

// `left_out`: light paths that the experiment's `view` does not ask for.
static void add(const struct chance *state, int j, const double rgb[3], double *frame) {
  const struct walk *walk = state->walk;
  if (walk->kind[j] & state->measure->left_out) return;
  for (int c = 0; c < walk->n_channels; c++)
    frame[walk->owner[j] * walk->n_channels + c] += walk->throughput[c][j] * rgb[c];
}

// What the paths that hit nothing see.
static void add_background(const struct chance *state, double *frame) {
  const struct walk *walk = state->walk;
  const struct scene *scene = walk->scene;
  for (int j = 0; j < walk->n; j++) {
    if (walk->hit[j].primitive != PRIMITIVE_NONE) continue;
    for (uint32_t k = 0; k < scene->n_infinite; k++) {
      const struct light *light = &scene->light[scene->infinite[k]];
      double rgb[3];
      light->type->background(scene, light, walk->ray[j].d, rgb);
      add(state, j, rgb, frame);
    }
  }
}

// At every hit: add what it emits, scatter; paths that go on close the gaps.
static void meet(const struct chance *state, double *frame) {
  struct walk *walk = state->walk;
  bool last = walk->vertex >= state->measure->depth;
  int alive = 0;
  if (!last) walk_vertex_random(walk);
  for (int j = 0; j < walk->n; j++) {
    struct surface surface;
    scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
    double emitted[3];
    eye_emitted(walk->scene, &surface, vec_scale(walk->ray[j].d, -1), emitted);
    add(state, j, emitted, frame);
    if (last) continue;
    struct bsdf bsdf;
    walk_bsdf(walk, j, &surface, &bsdf);
    if (bsdf.type && walk_scatter(walk, j, &surface, &bsdf)) walk_move(walk, alive++, j);
  }
  walk->n = alive;
}

// Iteration i of the run, in any order (.independent): radiance in frame[(estimator * n_points +
// point) * n_channels + channel].
static void chance_step(void *data, uint64_t i, double *frame) {
  struct chance *state = data;
  const struct measurement *measure = state->measure;
  struct walk *walk = state->walk;
  memset(frame, 0, (size_t)measure->n_points * (size_t)walk->n_channels * sizeof *frame);
  walk->key = rng_key(measure->seed, state->run, RNG_EYE);
  walk_begin(walk, measure->seed, state->run, i);
  for (int first = 0; first < measure->n_points; first += WALK_BATCH) {
    int n = measure->n_points - first < WALK_BATCH ? measure->n_points - first : WALK_BATCH;
    for (int j = 0; j < n; j++)
      walk->path[j] = eye_path(&measure->scene->camera, measure->pixel[first + j]);
    eye_rays(walk, measure->pixel + first, n, measure->footprint);
    double *out = frame + (long)first * walk->n_channels;
    for (walk->vertex = 0; walk->n > 0 && walk->vertex <= measure->depth; walk->vertex++) {
      walk_trace_through(walk);
      if (walk->features.background) add_background(state, out);
      walk_drop_escaped(walk);
      meet(state, out);
    }
  }
  measurement_copy(measure, frame); // kernels and laws mean nothing here
}

// What it cannot measure is refused, never left out silently.
static bool chance_accepts(const struct scene *scene, bool footprint, struct problem *problem) {
  (void)footprint;
  for (uint32_t k = 0; k < scene->n_lights; k++)
    if (scene->light[k].type->delta)
      return problem_set(problem, "%s: integrator chance never meets a %s light; use path",
                         scene->path, scene->light[k].type->name);
  return true;
}

const struct integrator_type integrator_chance = {
    .name = "chance",
    .about = "path tracing that meets its lights by chance, unbiased",
    .source = "Kajiya 1986",
    .photons = false, // true: takes kernel, law, radius and photons; see probabilistic.c
    .independent = true,
    .accepts = chance_accepts,
    .create = chance_new,
    .begin = chance_begin,
    .step = chance_step,
};
