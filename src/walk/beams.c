#include "walk/beams.h"

#include <assert.h>

static void reserve(struct beams *beams) {
  if (beams->count < beams->capacity) return;
  int64_t old = beams->capacity, capacity = old ? 2 * old : WALK_BATCH;
  beams->beam = arena_grow(beams->arena, beams->beam, old, capacity, sizeof *beams->beam,
                           alignof(struct photon_beam));
  for (int c = 0; c < beams->n_channels; c++)
    beams->flux[c] =
        arena_grow(beams->arena, beams->flux[c], old, capacity, sizeof(double), alignof(double));
  beams->capacity = capacity;
}

static bool scatters(const struct medium *medium, int n_channels) {
  if (!medium->type->uniform) return true;
  struct medium_point at;
  medium->type->at(medium, (struct vec){0}, &at);
  for (int c = 0; c < n_channels; c++)
    if (at.sigma_s[c] > 0) return true;
  return false;
}

// Whether the piece from t0 goes on where the last beam ends: the cells of a medium's bounds part
// what the photon has not changed in.
static bool continues(const struct beams *beams, const struct walk *walk, int j, double t0) {
  if (beams->count == 0 || t0 == 0 || beams->last_path != j || beams->last_end != t0) return false;
  for (int c = 0; c < beams->n_channels; c++)
    if (beams->flux[c][beams->count - 1] != walk->throughput[c][j]) return false;
  return true;
}

static bool carries_nothing(const struct walk *walk, int j) {
  for (int c = 0; c < walk->n_channels; c++)
    if (walk->throughput[c][j] != 0) return false;
  return true;
}

static void store(void *data, const struct walk *walk, int j, double t0, double t1) {
  struct beams *beams = data;
  if (walk->vertex < beams->first_vertex || carries_nothing(walk, j)) return;
  if (!scatters(&walk->scene->medium[walk->medium[j]], walk->n_channels)) return;
  assert(t1 < INFINITY);
  if (continues(beams, walk, j, t0)) {
    beams->beam[beams->count - 1].length += t1 - t0;
  } else if (t0 < t1) {
    reserve(beams);
    int64_t at = beams->count++;
    assert(at < UINT32_MAX);
    for (int c = 0; c < beams->n_channels; c++) beams->flux[c][at] = walk->throughput[c][j];
    beams->beam[at] = (struct photon_beam){
        .o = vec_along(walk->ray[j].o, walk->ray[j].d, t0),
        .d = walk->ray[j].d,
        .length = t1 - t0,
        .vertex = walk->vertex < UINT16_MAX ? (uint16_t)walk->vertex : UINT16_MAX,
        .kind = walk->kind[j],
    };
  }
  beams->last_path = j;
  beams->last_end = t1;
}

void beams_begin(struct beams *beams, struct walk *walk, int first_vertex, struct arena *arena) {
  beams->count = 0;
  beams->n_channels = walk->n_channels;
  beams->first_vertex = first_vertex;
  beams->arena = arena;
  walk->flown = store;
  walk->flown_data = beams;
}

void beams_end(struct walk *walk) { walk->flown = NULL; }
