#include "walk/walk.h"

#include "walk/dimension.h"

static struct shadow shadow_new(int n_channels, struct arena *arena) {
  struct shadow shadow = {
      .ray = arena_new(arena, struct ray, WALK_BATCH),
      .hit = arena_new(arena, struct hit, WALK_BATCH),
      .distance = arena_new(arena, double, WALK_BATCH),
      .emitter = arena_new(arena, uint32_t, WALK_BATCH),
      .owner = arena_new(arena, int, WALK_BATCH),
      .path = arena_new(arena, uint64_t, WALK_BATCH),
  };
  for (int c = 0; c < n_channels; c++) shadow.value[c] = arena_new(arena, double, WALK_BATCH);
  return shadow;
}

struct walk *walk_new(const struct scene *scene, const struct bvh *bvh, int n_channels,
                      struct arena *arena) {
  struct walk *walk = arena_new(arena, struct walk, 1);
  walk->scene = scene;
  walk->bvh = bvh;
  walk->n_channels = n_channels;
  walk->path = arena_new(arena, uint64_t, WALK_BATCH);
  walk->ray = arena_new(arena, struct ray, WALK_BATCH);
  walk->hit = arena_new(arena, struct hit, WALK_BATCH);
  walk->pdf = arena_new(arena, double, WALK_BATCH);
  walk->owner = arena_new(arena, int, WALK_BATCH);
  for (int c = 0; c < n_channels; c++) walk->throughput[c] = arena_new(arena, double, WALK_BATCH);
  for (int slot = 0; slot < 4; slot++)
    for (int k = 0; k < 2; k++) walk->u[slot][k] = arena_new(arena, double, WALK_BATCH);
  walk->shadow = shadow_new(n_channels, arena);
  return walk;
}

void walk_random(struct walk *walk, int slot, uint32_t pair) {
  rng_fill(walk->key, walk->iteration, walk->path, walk->n, pair, walk->u[slot][0],
           walk->u[slot][1]);
}

void walk_move(struct walk *walk, int to, int from) {
  if (to == from) return;
  walk->path[to] = walk->path[from];
  walk->ray[to] = walk->ray[from];
  walk->hit[to] = walk->hit[from];
  walk->pdf[to] = walk->pdf[from];
  walk->owner[to] = walk->owner[from];
  for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][to] = walk->throughput[c][from];
}

void walk_trace(struct walk *walk) {
  bvh_closest(walk->bvh, walk->ray, walk->hit, walk->n);
  int alive = 0;
  for (int j = 0; j < walk->n; j++)
    if (walk->hit[j].primitive != PRIMITIVE_NONE) walk_move(walk, alive++, j);
  walk->n = alive;
}

static double largest(const double *value, int n) {
  double most = value[0];
  for (int c = 1; c < n; c++) most = most < value[c] ? value[c] : most;
  return most;
}

bool walk_scatter(struct walk *walk, int j, const struct surface *surface) {
  const struct material *material = scene_material(walk->scene, surface);
  double u[3] = {walk->u[0][0][j], walk->u[0][1][j], walk->u[1][0][j]};
  struct bsdf_sample sample;
  struct vec wo = vec_scale(walk->ray[j].d, -1);
  if (!material->type->sample(material, surface, wo, u, &sample)) return false;
  double survive = largest(sample.weight, walk->n_channels);
  if (!(walk->u[1][1][j] < survive)) return false;
  // A weight above 1 (no diffuse surface has one) always survives and keeps its weight.
  double divisor = survive < 1 ? survive : 1;
  for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] *= sample.weight[c] / divisor;
  walk->ray[j] = (struct ray){surface->p, sample.wi, INFINITY, surface->primitive};
  walk->pdf[j] = sample.pdf_solid_angle;
  return true;
}
