#include "walk/walk.h"

#include "walk/dimension.h"
#include "walk/facets_level.h"
#include "walk/flight.h"

static struct shadow shadow_new(int n_channels, struct arena *arena) {
  struct shadow shadow = {
      .ray = arena_new(arena, struct ray, WALK_BATCH),
      .hit = arena_new(arena, struct hit, WALK_BATCH),
      .distance = arena_new(arena, double, WALK_BATCH),
      .emitter = arena_new(arena, uint32_t, WALK_BATCH),
      .owner = arena_new(arena, int, WALK_BATCH),
  };
  for (int c = 0; c < n_channels; c++) shadow.value[c] = arena_new(arena, double, WALK_BATCH);
  return shadow;
}

static struct crossing crossing_new(struct arena *arena) {
  return (struct crossing){
      .ray = arena_new(arena, struct ray, WALK_BATCH),
      .hit = arena_new(arena, struct hit, WALK_BATCH),
      .slot = arena_new(arena, int, WALK_BATCH),
      .passed = arena_new(arena, int, WALK_BATCH),
      .surface = arena_new(arena, struct surface, WALK_BATCH),
      .path = arena_new(arena, uint64_t, WALK_BATCH),
      .u = {arena_new(arena, double, WALK_BATCH), arena_new(arena, double, WALK_BATCH)},
  };
}

static void enter_media(struct walk *walk, struct arena *arena) {
  walk->medium = arena_new(arena, uint32_t, WALK_BATCH);
  walk->collision = arena_new(arena, struct collision, WALK_BATCH);
  walk->flights = arena_new(arena, uint32_t, WALK_BATCH);
  walk->shadow.medium = arena_new(arena, uint32_t, WALK_BATCH);
  walk->shadow.flights = arena_new(arena, uint32_t, WALK_BATCH);
  walk->shadow.path = arena_new(arena, uint64_t, WALK_BATCH);
}

struct walk *walk_new(const struct scene *scene, const struct bvh *bvh, struct features features,
                      struct arena *arena) {
  struct walk *walk = arena_new(arena, struct walk, 1);
  walk->view = view_new(scene, bvh, features.motion, arena);
  walk->scene = walk->view.scene;
  walk->bvh = walk->view.bvh;
  walk->features = features;
  walk->n_channels = features.n_channels;
  walk->path = arena_new(arena, uint64_t, WALK_BATCH);
  walk->ray = arena_new(arena, struct ray, WALK_BATCH);
  walk->hit = arena_new(arena, struct hit, WALK_BATCH);
  walk->from = arena_new(arena, struct vec, WALK_BATCH);
  walk->pdf = arena_new(arena, double, WALK_BATCH);
  walk->owner = arena_new(arena, int, WALK_BATCH);
  walk->kind = arena_new(arena, uint8_t, WALK_BATCH);
  for (int c = 0; c < walk->n_channels; c++)
    walk->throughput[c] = arena_new(arena, double, WALK_BATCH);
  for (int slot = 0; slot < 4; slot++)
    for (int k = 0; k < 2; k++) walk->u[slot][k] = arena_new(arena, double, WALK_BATCH);
  walk->shadow = shadow_new(walk->n_channels, arena);
  if (features.see_through) walk->crossing = crossing_new(arena);
  if (features.media) enter_media(walk, arena);
  return walk;
}

void walk_follow_differentials(struct walk *walk, struct arena *arena) {
  walk->differential = arena_new(arena, struct differential, WALK_BATCH);
}

void walk_begin(struct walk *walk, uint64_t seed, uint64_t run, uint64_t i) {
  walk->iteration = i;
  if (!walk->features.motion) return;
  const uint64_t path = 0;
  double time, unused;
  rng_fill(rng_key(seed, run, RNG_TIME), i, &path, 1, 0, &time, &unused);
  view_set(&walk->view, time);
}

void walk_random(struct walk *walk, int slot, uint32_t pair) {
  rng_fill(walk->key, walk->iteration, walk->path, walk->n, pair, walk->u[slot][0],
           walk->u[slot][1]);
}

#define MOVE(array)                                                                                \
  for (int k = 0; k < n; k++) (array)[to + k] = (array)[from[k]]

void walk_pack(struct walk *walk, int to, const int *from, int n) {
  while (n > 0 && *from == to) n--, from++, to++;
  MOVE(walk->path);
  MOVE(walk->ray);
  MOVE(walk->hit);
  MOVE(walk->from);
  MOVE(walk->pdf);
  MOVE(walk->owner);
  MOVE(walk->kind);
  if (walk->differential) MOVE(walk->differential);
  if (walk->medium) {
    MOVE(walk->medium);
    MOVE(walk->collision);
  }
  if (walk->owed) MOVE(walk->owed);
  for (int c = 0; c < walk->n_channels; c++) MOVE(walk->throughput[c]);
}

void walk_move(struct walk *walk, int to, int from) { walk_pack(walk, to, &from, 1); }

// ---- passing through surfaces ----
// What opacity stops is random: one number a crossing decides, so that the average over iterations
// is what alpha says. The ray goes on from the surface; nothing else of the path changes.

bool walk_meets_see_through(const struct scene *scene, struct hit hit) {
  return hit.primitive != PRIMITIVE_NONE &&
         scene->shape[scene->shape_of[hit.primitive]].see_through;
}

struct ray walk_ray_beyond(const struct surface *surface, const struct ray *ray) {
  return (struct ray){surface->p, ray->d, INFINITY, surface->primitive};
}

static void list_crossings(struct walk *walk) {
  struct crossing *crossing = &walk->crossing;
  crossing->n = crossing->number = 0;
  for (int j = 0; j < walk->n; j++)
    if (walk_meets_see_through(walk->scene, walk->hit[j])) crossing->slot[crossing->n++] = j;
}

void walk_trace(struct walk *walk) {
  bvh_closest(walk->bvh, walk->ray, walk->hit, walk->n);
  if (walk->medium) flight_all(walk);
  if (walk->features.see_through) list_crossings(walk);
}

static void decide_crossings(struct walk *walk) {
  struct crossing *crossing = &walk->crossing;
  crossing->n_passed = 0;
  for (int k = 0; k < crossing->n; k++) {
    int j = crossing->slot[k];
    struct surface surface;
    scene_surface(walk->scene, &walk->ray[j], walk->hit[j], &surface);
    if (crossing->u[0][k] < surface_opacity(walk->scene, &surface)) continue;
    int to = crossing->n_passed++;
    if (walk->medium && scene_material(walk->scene, &surface)->type->passed)
      walk->medium[j] = surface_medium(walk->scene, &surface, walk->ray[j].d, walk->medium[j]);
    walk->ray[j] = walk_ray_beyond(&surface, &walk->ray[j]);
    crossing->ray[to] = walk->ray[j];
    crossing->surface[to] = surface;
    crossing->passed[to] = j;
  }
}

void walk_cross(struct walk *walk) {
  struct crossing *crossing = &walk->crossing;
  for (int k = 0; k < crossing->n; k++) crossing->path[k] = walk->path[crossing->slot[k]];
  rng_fill(walk->key, walk->iteration, crossing->path, crossing->n,
           pair_between(BETWEEN_CROSSING, walk->vertex, (uint32_t)crossing->number++),
           crossing->u[0], crossing->u[1]);
  decide_crossings(walk);
  bvh_closest(walk->bvh, crossing->ray, crossing->hit, crossing->n_passed);
  crossing->n = 0;
  for (int k = 0; k < crossing->n_passed; k++) {
    int j = crossing->passed[k];
    walk->hit[j] = crossing->hit[k];
    if (walk->medium) flight_path(walk, j);
    if (walk_meets_see_through(walk->scene, walk->hit[j])) crossing->slot[crossing->n++] = j;
  }
}

void walk_trace_through(struct walk *walk) {
  walk_trace(walk);
  while (walk->crossing.n > 0) walk_cross(walk);
}

void walk_drop_escaped(struct walk *walk) {
  int here[WALK_BATCH], n = 0;
  for (int j = 0; j < walk->n; j++) {
    here[n] = j;
    n += !walk_escaped(walk, j);
  }
  walk_pack(walk, 0, here, n);
  walk->n = n;
}

// ---- scattering ----

void walk_vertex_random(struct walk *walk) {
  walk_random(walk, 0, pair_of_vertex(walk->vertex, VERTEX_DIRECTION));
  walk_random(walk, 1, pair_of_vertex(walk->vertex, VERTEX_CHOICE));
  if (walk->features.random_materials)
    walk_random(walk, 2, pair_of_vertex(walk->vertex, VERTEX_LIGHT));
}

void walk_bsdf(const struct walk *walk, int j, const struct surface *surface, struct bsdf *bsdf) {
  surface_bsdf(walk->scene, surface, walk->features.random_materials ? walk->u[2][1][j] : 0, bsdf);
}

// Roulette with u[1][1] of path j, whose weight its last scattering multiplies by up to `weight`.
// True: it goes on, its weight divided by *divisor. A weight above 1 always survives and is kept.
static bool survives(struct walk *walk, int j, double weight, double *divisor) {
  *divisor = 1;
  if (walk->owed) {
    weight *= walk->owed[j];
    walk->owed[j] = weight;
    if (walk->vertex == 0) return weight > 0;
  }
  if (!(walk->u[1][1][j] < weight)) return false;
  if (weight < 1) *divisor = weight;
  if (walk->owed && weight < 1) walk->owed[j] = 1;
  return true;
}

void walk_delay_roulette(struct walk *walk, struct arena *arena) {
  walk->owed = arena_new(arena, double, WALK_BATCH);
}

bool walk_scatter(struct walk *walk, int j, const struct surface *surface,
                  const struct bsdf *bsdf) {
  double u[3] = {walk->u[0][0][j], walk->u[0][1][j], walk->u[1][0][j]};
  struct bsdf_sample sample;
  struct vec wo = vec_scale(walk->ray[j].d, -1);
  if (!bsdf_sample(bsdf, wo, u, walk->transport, &sample)) return false;
  double divisor;
  if (!survives(walk, j, walk_largest(sample.weight, walk->n_channels) * sample.eta2, &divisor))
    return false;
  for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] *= sample.weight[c] / divisor;
  if (walk->differential && walk->transport == TRANSPORT_RADIANCE)
    differential_scatter(&walk->differential[j], walk->scene, surface, bsdf->n, walk->ray[j].d,
                         sample.wi, sample.eta2);
  walk_start(walk, j, surface->p, sample.wi, surface->primitive);
  if (walk->medium)
    walk->medium[j] = surface_medium(walk->scene, surface, sample.wi, walk->medium[j]);
  walk->pdf[j] = sample.pdf;
  walk->kind[j] = (uint8_t)light_path_after(walk->kind[j], sample.pdf == 0);
  return true;
}

// ---- facets ----
void walk_facet_bsdf(const struct walk *walk, int j, const struct shape *shape, struct bsdf *bsdf) {
  bsdf->type = shape->bsdf->type;
  bsdf->n = bsdf->ng = walk->scene->facet[walk->hit[j].primitive];
  bsdf->bent = bsdf->volume = false;
  for (int c = 0; c < 3; c++) bsdf->x[c] = shape->bsdf->x[c];
}

int walk_sample_facets(struct walk *walk, int first) {
  struct facets *facets = &walk->block.facets;
  int n = 0, count = walk->n - first < FACETS ? walk->n - first : FACETS;
  walk->block.first = first;
  for (int k = 0; k < count; k++) {
    int j = first + k;
    const struct shape *shape = walk_facet_shape(walk, j);
    walk->block.row[k] = -1;
    walk->block.shape[k] = shape;
    if (!shape) continue;
    const struct vec *d = &walk->ray[j].d, *ng = &walk->scene->facet[walk->hit[j].primitive];
    facets->d[0][n] = d->x, facets->d[1][n] = d->y, facets->d[2][n] = d->z;
    facets->n[0][n] = ng->x, facets->n[1][n] = ng->y, facets->n[2][n] = ng->z;
    facets->u[0][n] = walk->u[0][0][j], facets->u[1][n] = walk->u[0][1][j];
    walk->block.row[k] = (int8_t)n++;
  }
  SIMD_TABLE(facets_level)->sample(facets, n);
  return count;
}

bool walk_scatter_facet(struct walk *walk, int j) {
  const struct facets *facets = &walk->block.facets;
  int row = walk->block.row[j - walk->block.first];
  const double *albedo = walk_facet(walk, j)->bsdf->x;
  double divisor;
  if (facets->cosine[row] == 0 ||
      !survives(walk, j, walk_largest(albedo, walk->n_channels), &divisor))
    return false;
  for (int c = 0; c < walk->n_channels; c++) walk->throughput[c][j] *= albedo[c] / divisor;
  struct vec wi = {facets->wi[0][row], facets->wi[1][row], facets->wi[2][row]};
  struct vec p = walk_point(walk, j);
  walk_start(walk, j, p, wi, walk->hit[j].primitive);
  walk->pdf[j] = facets->pdf[row];
  walk->kind[j] = (uint8_t)light_path_after(walk->kind[j], false);
  return true;
}

bool walk_scatter_in_medium(struct walk *walk, int j) {
  const struct collision *collision = &walk->collision[j];
  const struct medium_point *at = &collision->at;
  double u[3] = {walk->u[0][0][j], walk->u[0][1][j], walk->u[1][0][j]}, albedo[3] = {0};
  for (int c = 0; c < walk->n_channels; c++) {
    double sigma_t = at->sigma_a[c] + at->sigma_s[c];
    albedo[c] = sigma_t > 0 ? at->sigma_s[c] / sigma_t : 0;
  }
  double divisor;
  if (!survives(walk, j, walk_largest(albedo, walk->n_channels), &divisor)) return false;
  struct bsdf phase = medium_bsdf(&walk->scene->medium[walk->medium[j]]);
  struct bsdf_sample sample;
  phase.type->sample(&phase, vec_scale(walk->ray[j].d, -1), u, walk->transport, &sample);
  for (int c = 0; c < walk->n_channels; c++)
    walk->throughput[c][j] = collision->weight[c] * at->sigma_s[c] * sample.weight[c] / divisor;
  struct vec p = walk_point(walk, j);
  walk_start(walk, j, p, sample.wi, PRIMITIVE_NONE);
  walk->pdf[j] = sample.pdf;
  walk->kind[j] = (uint8_t)light_path_after(walk->kind[j], false);
  return true;
}
