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
  photons->kind = grown(arena, photons->kind, count, capacity, sizeof(uint8_t));
  photons->capacity = capacity;
}

void photons_append(struct photons *photons, const struct photons *more, struct arena *arena) {
  int64_t at = photons->count;
  size_t n = (size_t)more->count;
  photons->n_channels = more->n_channels;
  photons_reserve(photons, more->count, arena);
  if (n == 0) return;
  memcpy(photons->position + at, more->position, n * sizeof *more->position);
  memcpy(photons->wi + at, more->wi, n * sizeof *more->wi);
  for (int c = 0; c < more->n_channels; c++)
    memcpy(photons->flux[c] + at, more->flux[c], n * sizeof *more->flux[c]);
  memcpy(photons->vertex + at, more->vertex, n * sizeof *more->vertex);
  memcpy(photons->kind + at, more->kind, n * sizeof *more->kind);
  photons->count += more->count;
}

// What one call of photons_trace is about.
struct pass {
  const struct photon_pass *of;
  const struct photon_sinks *to;
  struct arena *arena;
};

uint32_t photons_start_in(const struct scene *scene, const struct light *light,
                          const struct ray *ray) {
  if (ray->leaving == PRIMITIVE_NONE) return light->medium;
  struct surface surface;
  scene_surface(scene, ray, (struct hit){0, ray->leaving}, &surface);
  const struct shape *shape = &scene->shape[surface.shape];
  return vec_dot(ray->d, surface.ng) > 0 ? shape->outside : shape->inside;
}

void photons_emit(struct walk *walk) {
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
    walk_start(walk, j, emission.ray.o, emission.ray.d, emission.ray.leaving);
    walk->kind[j] = LIGHT_PATH_DIRECT;
    if (walk->medium) walk->medium[j] = photons_start_in(scene, light, &emission.ray);
    for (int c = 0; c < walk->n_channels; c++)
      walk->throughput[c][j] = emission.flux[c] / light->probability;
  }
}

// Whether an eye point at this surface can scatter what arrives from wo. What a random material is
// to the eye is not what it is to this photon, so there every photon is stored.
static bool is_gathered(const struct scene *scene, const struct surface *surface,
                        const struct bsdf *bsdf, struct vec wo) {
  if (scene_material(scene, surface)->needs & MATERIAL_RANDOM) return true;
  return bsdf->type && bsdf_delta_probability(bsdf, wo, TRANSPORT_IMPORTANCE) < 1;
}

// The place of a new photon at p, its flux left to the caller; -1: nobody sees it.
static inline int64_t store(const struct walk *walk, int j, const struct pass *pass,
                            const struct photon_sink *sink, struct vec p) {
  struct photons *photons = sink->photons;
  if (walk->vertex < pass->of->first_vertex) return -1;
  if (sink->filter && !sink->filter->keep(sink->filter->data, p)) return -1;
  int64_t at = photons->count++;
  photons->position[at] = p;
  photons->wi[at] = vec_scale(walk->ray[j].d, -1);
  photons->vertex[at] = walk->vertex < UINT16_MAX ? (uint16_t)walk->vertex : UINT16_MAX;
  photons->kind[at] = walk->kind[j];
  return at;
}

static void store_at(const struct walk *walk, int j, const struct pass *pass, struct vec p) {
  const struct photon_sink *sink = &pass->to->surface;
  int64_t at = store(walk, j, pass, sink, p);
  if (at < 0) return;
  for (int c = 0; c < walk->n_channels; c++) sink->photons->flux[c][at] = walk->throughput[c][j];
}

static void store_on_surface(const struct walk *walk, int j, const struct pass *pass,
                             const struct surface *surface, const struct bsdf *bsdf) {
  if (is_gathered(walk->scene, surface, bsdf, vec_scale(walk->ray[j].d, -1)))
    store_at(walk, j, pass, surface->p);
}

// A surface of opacity a stops the fraction a of the photons, and an eye path with probability a,
// which then sees an opaque point with all of the light on it: those that pass are stored as well.
static void store_passed(struct walk *walk, const struct pass *pass) {
  const struct crossing *crossing = &walk->crossing;
  photons_reserve(pass->to->surface.photons, crossing->n_passed, pass->arena);
  for (int k = 0; k < crossing->n_passed; k++) {
    const struct surface *surface = &crossing->surface[k];
    if (scene_material(walk->scene, surface)->type->passed) continue;
    struct bsdf bsdf;
    surface_bsdf(walk->scene, surface, 0, &bsdf);
    store_on_surface(walk, crossing->passed[k], pass, surface, &bsdf);
  }
}

static void store_in_medium(const struct walk *walk, int j, const struct pass *pass) {
  const struct photon_sink *sink = &pass->to->volume;
  if (!sink->photons) return;
  int64_t at = store(walk, j, pass, sink, walk_point(walk, j));
  for (int c = 0; at >= 0 && c < walk->n_channels; c++)
    sink->photons->flux[c][at] = walk->collision[j].weight[c];
}

// True: the path goes on.
static bool meet_one(struct walk *walk, int j, const struct pass *pass, bool last) {
  if (walk_collided(walk, j)) {
    store_in_medium(walk, j, pass);
    return !last && walk_scatter_in_medium(walk, j);
  }
  if (walk_facet(walk, j)) {
    store_at(walk, j, pass, walk_point(walk, j));
    return !last && walk_scatter_facet(walk, j);
  }
  struct surface surface;
  scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
  struct bsdf bsdf;
  walk_bsdf(walk, j, &surface, &bsdf);
  store_on_surface(walk, j, pass, &surface, &bsdf);
  return !last && bsdf.type && walk_scatter(walk, j, &surface, &bsdf);
}

// At every vertex: store what can scatter towards an eye, then scatter.
static void meet(struct walk *walk, const struct pass *pass) {
  bool last = walk->vertex + 1 >= pass->of->depth && !pass->of->past_last;
  int alive = 0;
  walk_vertex_random(walk);
  photons_reserve(pass->to->surface.photons, walk->n, pass->arena);
  if (pass->to->volume.photons) photons_reserve(pass->to->volume.photons, walk->n, pass->arena);
  for (int first = 0; first < walk->n; first += FACETS) {
    int on[FACETS], n = 0, count = walk_sample_facets(walk, first);
    for (int j = first; j < first + count; j++) {
      on[n] = j;
      n += meet_one(walk, j, pass, last);
    }
    walk_pack(walk, alive, on, n);
    alive += n;
  }
  walk->n = alive;
}

static void empty(const struct photon_sink *sink, const struct walk *walk) {
  if (!sink->photons) return;
  sink->photons->count = 0;
  sink->photons->n_channels = walk->n_channels;
}

static void trace(struct walk *walk, const struct pass *pass) {
  const struct photon_pass *of = pass->of;
  for (uint64_t first = of->first; first < of->n_emitted; first += WALK_BATCH) {
    uint64_t left = of->n_emitted - first;
    walk->n = left < WALK_BATCH ? (int)left : WALK_BATCH;
    for (int j = 0; j < walk->n; j++) walk->path[j] = first + (uint64_t)j;
    photons_emit(walk);
    for (walk->vertex = 0; walk->n > 0 && walk->vertex < of->depth; walk->vertex++) {
      walk_trace(walk);
      while (walk->crossing.n > 0) {
        walk_cross(walk);
        store_passed(walk, pass);
      }
      walk_drop_escaped(walk);
      meet(walk, pass);
    }
  }
}

void photons_trace(struct walk *walk, const struct photon_pass *of, const struct photon_sinks *to,
                   struct arena *arena) {
  struct pass pass = {of, to, arena};
  empty(&to->surface, walk);
  empty(&to->volume, walk);
  if (to->beams) beams_begin(to->beams, walk, of->first_vertex, arena);
  if (walk->scene->n_lights > 0) trace(walk, &pass);
  if (to->beams) beams_end(walk);
}
