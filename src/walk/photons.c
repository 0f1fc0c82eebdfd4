#include "walk/photons.h"

#include "walk/dimension.h"
#include "walk/light.h"

#include <string.h>

static void *grown(struct arena *arena, void *old, int64_t count, int64_t capacity, size_t size) {
  void *fresh = arena_alloc(arena, capacity, (ptrdiff_t)size, alignof(double));
  if (count) memcpy(fresh, old, (size_t)count * size);
  return fresh;
}

static void photons_reserve(struct photons *photons, int64_t more, struct arena *arena) {
  if (photons->count + more <= photons->capacity) return;
  int64_t capacity = 2 * (photons->count + more), count = photons->count;
  photons->position = grown(arena, photons->position, count, capacity, sizeof(struct vec));
  photons->wi = grown(arena, photons->wi, count, capacity, sizeof(struct vec));
  for (int c = 0; c < photons->n_channels; c++)
    photons->flux[c] = grown(arena, photons->flux[c], count, capacity, sizeof(double));
  photons->vertex = grown(arena, photons->vertex, count, capacity, sizeof(uint16_t));
  photons->capacity = capacity;
}

// Emission: one ray a path, with the flux that the choice of its light leaves it.
static void emit(struct walk *walk) {
  const struct scene *scene = walk->scene;
  walk->transport = TRANSPORT_IMPORTANCE;
  walk_random(walk, 1, PAIR_POSITION);
  walk_random(walk, 2, PAIR_DIRECTION);
  if (scene->n_lights > 1) walk_random(walk, 0, PAIR_LIGHT);
  for (int j = 0; j < walk->n; j++) {
    const struct light *light = light_choose(scene, scene->n_lights > 1 ? walk->u[0][0][j] : 0);
    double u[LIGHT_U] = {walk->u[1][0][j], walk->u[1][1][j], walk->u[2][0][j], walk->u[2][1][j]};
    struct emission emission;
    light->type->emit(scene, light, u, &emission);
    walk_start(walk, j, emission.ray);
    for (int c = 0; c < walk->n_channels; c++)
      walk->throughput[c][j] = emission.flux[c] / light->probability;
  }
}

static void store(const struct walk *walk, int j, struct vec p, struct photons *photons) {
  int64_t at = photons->count++;
  photons->position[at] = p;
  photons->wi[at] = vec_scale(walk->ray[j].d, -1);
  for (int c = 0; c < walk->n_channels; c++) photons->flux[c][at] = walk->throughput[c][j];
  photons->vertex[at] = walk->vertex < UINT16_MAX ? (uint16_t)walk->vertex : UINT16_MAX;
}

static bool has_smooth_part(const struct bsdf *bsdf, struct vec wo) {
  return bsdf_delta_probability(bsdf, wo, TRANSPORT_IMPORTANCE) < 1;
}

// At every hit: store what can scatter towards an eye, then scatter.
static void meet(struct walk *walk, const struct photon_pass *pass,
                 const struct photon_filter *filter, struct photons *photons) {
  bool stored = walk->vertex >= pass->first_vertex, last = walk->vertex + 1 >= pass->depth;
  walk_vertex_random(walk);
  int alive = 0;
  for (int j = 0; j < walk->n; j++) {
    struct surface surface = scene_surface(walk->scene, &walk->ray[j], walk->hit[j]);
    struct bsdf bsdf = walk_bsdf(walk, j, &surface);
    if (!bsdf.type) continue;
    bool seen = stored && has_smooth_part(&bsdf, vec_scale(walk->ray[j].d, -1));
    if (seen && (!filter || filter->keep(filter->data, surface.p)))
      store(walk, j, surface.p, photons);
    if (!last && walk_scatter(walk, j, &surface, &bsdf)) walk_move(walk, alive++, j);
  }
  walk->n = alive;
}

void photons_trace(struct walk *walk, const struct photon_pass *pass,
                   const struct photon_filter *filter, struct photons *photons,
                   struct arena *arena) {
  photons->count = 0;
  photons->n_channels = walk->n_channels;
  if (walk->scene->n_lights == 0) return;
  for (uint64_t first = 0; first < pass->n_emitted; first += WALK_BATCH) {
    uint64_t left = pass->n_emitted - first;
    walk->n = left < WALK_BATCH ? (int)left : WALK_BATCH;
    for (int j = 0; j < walk->n; j++) walk->path[j] = first + (uint64_t)j;
    emit(walk);
    for (walk->vertex = 0; walk->n > 0 && walk->vertex < pass->depth; walk->vertex++) {
      walk_trace(walk);
      walk_drop_escaped(walk);
      photons_reserve(photons, walk->n, arena);
      meet(walk, pass, filter, photons);
    }
  }
}
