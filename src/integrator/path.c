// Path tracing with next-event estimation, combined with the material's sampling by the balance
// heuristic (Veach, Guibas 1995): the unbiased reference. One sample a point and iteration.
#include "integrator/integrator.h"

#include "walk/connect.h"
#include "walk/dimension.h"
#include "walk/eye.h"

#include <string.h>

struct path {
  const struct measurement *measure;
  struct walk *walk;
  uint64_t run;
  struct connection *connection;
};

static void *path_new(const struct measurement *measure, struct arena *arena) {
  struct path *state = arena_new(arena, struct path, 1);
  state->measure = measure;
  state->walk = walk_new(measure->scene, measure->bvh, measure->features.n_channels, arena);
  state->connection = arena_new(arena, struct connection, WALK_BATCH);
  return state;
}

static void path_begin(void *data, uint64_t run) {
  struct path *state = data;
  state->run = run;
}

// Emission met by path j: all of it where next-event estimation could not have found it.
static void add_emission(struct path *state, int j, const struct surface *surface, double *frame) {
  struct walk *walk = state->walk;
  if (walk->scene->shape[surface->shape].light == LIGHT_NONE) return;
  double emitted[3], weight = 1;
  eye_emitted(walk->scene, surface, vec_scale(walk->ray[j].d, -1), emitted);
  if (walk->vertex > 0)
    weight = connect_mis_weight(walk->scene, surface, walk->ray[j].o, walk->ray[j].d, walk->pdf[j]);
  for (int c = 0; c < walk->n_channels; c++)
    frame[walk->owner[j] * walk->n_channels + c] += weight * walk->throughput[c][j] * emitted[c];
}

static struct connection connection_of(const struct walk *walk, int j, const struct surface *at) {
  struct connection connection = {.surface = *at,
                                  .wo = vec_scale(walk->ray[j].d, -1),
                                  .owner = walk->owner[j],
                                  .path = walk->path[j]};
  for (int c = 0; c < walk->n_channels; c++) connection.weight[c] = walk->throughput[c][j];
  return connection;
}

// At every hit: add what it emits, connect it to a light, scatter.
static void meet(struct path *state, double *frame) {
  struct walk *walk = state->walk;
  bool last = walk->vertex >= state->measure->depth;
  int n = walk->n, alive = 0, connections = 0;
  if (!last) {
    walk_random(walk, 0, pair_of_vertex(walk->vertex, VERTEX_DIRECTION));
    walk_random(walk, 1, pair_of_vertex(walk->vertex, VERTEX_CHOICE));
  }
  for (int j = 0; j < n; j++) {
    struct surface surface = scene_surface(walk->scene, &walk->ray[j], walk->hit[j]);
    add_emission(state, j, &surface, frame);
    const struct material *material = scene_material(walk->scene, &surface);
    if (last || material->type->is_black(material)) continue;
    state->connection[connections++] = connection_of(walk, j, &surface);
    if (walk_scatter(walk, j, &surface)) walk_move(walk, alive++, j);
  }
  connect_lights(walk, state->connection, connections, walk->vertex, true, frame);
  walk->n = alive;
}

// Replicas of a pixel are told apart by the path number.
static uint64_t path_number(const struct measurement *measure, int j) {
  const struct camera *camera = &measure->scene->camera;
  uint64_t replica = (uint64_t)(j % measure->n_replicas);
  uint64_t pixels = (uint64_t)camera->width * (uint64_t)camera->height;
  return eye_path(camera, measure->pixel[j]) + replica * pixels;
}

// Kernel, law and radius mean nothing here: estimators that differ in them get the same values.
static void copy_to_others(const struct measurement *measure, long size, double *frame) {
  for (int e = 1; e < measure->n_estimators; e++)
    memcpy(frame + e * size, frame, (size_t)size * sizeof *frame);
}

static void path_step(void *data, uint64_t i, double *frame) {
  struct path *state = data;
  const struct measurement *measure = state->measure;
  struct walk *walk = state->walk;
  long size = (long)measure->n_points * walk->n_channels;
  memset(frame, 0, (size_t)size * sizeof *frame);
  walk->key = rng_key(measure->seed, state->run, RNG_EYE);
  walk->iteration = i;
  for (int first = 0; first < measure->n_points; first += WALK_BATCH) {
    int n = measure->n_points - first < WALK_BATCH ? measure->n_points - first : WALK_BATCH;
    for (int j = 0; j < n; j++) walk->path[j] = path_number(measure, first + j);
    eye_rays(walk, &measure->scene->camera, measure->pixel + first, n, measure->footprint);
    double *out = frame + (long)first * walk->n_channels;
    for (walk->vertex = 0; walk->n > 0 && walk->vertex <= measure->depth; walk->vertex++) {
      walk_trace(walk);
      meet(state, out);
    }
  }
  copy_to_others(measure, size, frame);
}

const struct integrator_type integrator_path = {
    .name = "path",
    .about = "path tracing with next-event estimation and multiple importance sampling, unbiased",
    .source = "Kajiya 1986; Veach and Guibas 1995",
    .photons = false,
    .independent = true,
    .create = path_new,
    .begin = path_begin,
    .step = path_step,
};
