#include "density/gather.h"

#include "density/gather_level.h"
#include "numeric/sum.h"

#include <limits.h>

static void gather_reserve(struct gather *gather, int64_t count, int n_channels,
                           struct arena *arena) {
  if (count + GRID_ROOM <= gather->capacity) return;
  gather->capacity = 2 * count + GRID_ROOM;
  gather->photon = arena_new(arena, uint32_t, gather->capacity);
  gather->distance2 = arena_new(arena, double, gather->capacity);
  gather->weight = arena_new(arena, double, gather->capacity);
  for (int c = 0; c < n_channels; c++)
    gather->value[c] = arena_new(arena, double, gather->capacity);
}

// By how much the point scatters a photon; false: not at all.
static bool scatters(const struct photons *photons, const struct eye_point *point, uint32_t photon,
                     double f[3]) {
  bsdf_value(&point->bsdf, point->wo, photons->wi[photon], TRANSPORT_RADIANCE, f);
  return f[0] != 0 || f[1] != 0 || f[2] != 0;
}

static bool is_deeper(const struct photons *photons, const struct eye_point *point, int depth,
                      uint32_t photon) {
  return photons->vertex[photon] + point->vertex >= depth;
}

// Of `found` photons those of paths of at most `depth` scatterings.
static int leave_deeper(struct gather *gather, const struct photons *photons,
                        const struct eye_point *point, int depth, int found) {
  int kept = 0;
  for (int j = 0; j < found; j++) {
    gather->photon[kept] = gather->photon[j];
    gather->distance2[kept] = gather->distance2[j];
    kept += !is_deeper(photons, point, depth, gather->photon[j]);
  }
  return kept;
}

static int weigh_by_side(struct gather *gather, const struct photons *photons,
                         const struct eye_point *point, int found) {
  const struct bsdf *bsdf = &point->bsdf;
  struct sided_bsdf sided = {.n = bsdf->n};
  bsdf_value(bsdf, point->wo, bsdf->n, TRANSPORT_RADIANCE, sided.above);
  bsdf_value(bsdf, point->wo, vec_scale(bsdf->n, -1), TRANSPORT_RADIANCE, sided.below);
  return LEVEL_TABLE(gather_level)->weigh_by_side(gather, photons, &sided, found);
}

// Keeps the photons that the point scatters, with f * flux of each.
static int weigh(struct gather *gather, const struct photons *photons,
                 const struct eye_point *point, int found) {
  int kept = 0;
  if (point->bsdf.type->by_side && !point->bsdf.bent && !gather->left_out)
    return weigh_by_side(gather, photons, point, found);
  for (int j = 0; j < found; j++) {
    uint32_t photon = gather->photon[j];
    double f[3];
    if (!scatters(photons, point, photon, f)) continue;
    double factor = bsdf_photon_factor(&point->bsdf, photons->wi[photon]);
    gather->distance2[kept] = gather->distance2[j];
    if (gather->left_out && (photons->kind[photon] & gather->left_out)) factor = 0;
    for (int c = 0; c < photons->n_channels; c++)
      gather->value[c][kept] = f[c] * factor * photons->flux[c][photon];
    kept++;
  }
  return kept;
}

static void add(const struct gather *gather, const struct eye_point *point, int n_channels, int n,
                double scale, double *out) {
  for (int c = 0; c < n_channels; c++)
    out[c] += point->weight[c] * (scale * sum_products(gather->weight, gather->value[c], n));
}

static bool is_a_disc(double r) { return r * r > 0 && r * r < INFINITY; }

static double largest_radius(const struct disc *disc, int n_discs) {
  double r = 0;
  for (int e = 0; e < n_discs; e++)
    if (is_a_disc(disc[e].r)) r = r < disc[e].r ? disc[e].r : r;
  return r;
}

// The estimates from `found` photons, all there are in the largest disc; deepest: of their paths.
static void add_found(struct gather *gather, const struct photons *photons,
                      const struct eye_point *point, int depth, int deepest, int found,
                      const struct disc *disc, int n_discs, int64_t *count, double *out,
                      long stride) {
  if (deepest + point->vertex >= depth) found = leave_deeper(gather, photons, point, depth, found);
  int n = weigh(gather, photons, point, found);
  if (n == 0) return;
  for (int e = 0; e < n_discs; e++) {
    if (!is_a_disc(disc[e].r)) continue;
    int within = kernel_weigh(disc[e].kernel, gather->distance2, disc[e].r, gather->weight, n);
    if (count) count[e] = within;
    add(gather, point, photons->n_channels, n, disc[e].scale, out + e * stride);
  }
}

void gather_point(struct gather *gather, const struct grid *grid, const struct eye_point *point,
                  int depth, const struct disc *disc, int n_discs, int64_t *count, double *out,
                  long stride, struct arena *arena) {
  gather_reserve(gather, grid->count, grid->sorted.n_channels, arena);
  double r = largest_radius(disc, n_discs);
  int found = grid_find(grid, point->p, r, gather->photon, gather->distance2);
  add_found(gather, &grid->sorted, point, depth, grid->deepest, found, disc, n_discs, count, out,
            stride);
}

void gather_point_in_tree(struct gather *gather, const struct photons *photons,
                          const struct knn *tree, const struct eye_point *point, int depth,
                          const struct disc *disc, int n_discs, int64_t *count, double *out,
                          long stride, struct arena *arena) {
  gather_reserve(gather, tree->count, photons->n_channels, arena);
  double r = largest_radius(disc, n_discs);
  int found = knn_within(tree, point->p, r, gather->photon, gather->distance2);
  add_found(gather, photons, point, depth, INT_MAX / 2, found, disc, n_discs, count, out, stride);
}

// ---- the nearest ----

struct seeking {
  const struct photons *photons;
  const struct eye_point *point;
  int depth;
};

static bool accept(void *data, uint32_t photon) {
  const struct seeking *seeking = data;
  double f[3];
  return !is_deeper(seeking->photons, seeking->point, seeking->depth, photon) &&
         scatters(seeking->photons, seeking->point, photon, f);
}

// The k nearest that the point scatters, the nearest first; how many there are.
static int find_nearest(struct gather *gather, const struct photons *photons,
                        const struct knn *tree, const struct eye_point *point, int depth, int k,
                        struct arena *arena) {
  struct seeking seeking = {photons, point, depth};
  struct knn_filter filter = {accept, &seeking};
  gather_reserve(gather, tree->count, photons->n_channels, arena);
  return knn_nearest(tree, point->p, k, &filter, gather->photon, gather->distance2);
}

void gather_nearest(struct gather *gather, const struct photons *photons, const struct knn *tree,
                    const struct eye_point *point, int depth, const struct disc *disc, const int *k,
                    int n_discs, double *out, long stride, struct arena *arena) {
  int most = 0;
  for (int e = 0; e < n_discs; e++) most = most < k[e] ? k[e] : most;
  int n = find_nearest(gather, photons, tree, point, depth, most, arena);
  weigh(gather, photons, point, n); // keeps them all
  for (int e = 0; e < n_discs; e++) {
    if (k[e] == 0 || k[e] > n) continue;
    double r2 = gather->distance2[k[e] - 1], r = sqrt(r2);
    if (!is_a_disc(r)) continue;
    kernel_weigh(disc[e].kernel, gather->distance2, r, gather->weight, k[e] - 1);
    add(gather, point, photons->n_channels, k[e] - 1, disc[e].scale / r2, out + e * stride);
  }
}

double gather_distance(struct gather *gather, const struct photons *photons, const struct knn *tree,
                       const struct eye_point *point, int depth, int k, struct arena *arena) {
  int n = find_nearest(gather, photons, tree, point, depth, k, arena);
  return n < k ? INFINITY : sqrt(gather->distance2[k - 1]);
}
