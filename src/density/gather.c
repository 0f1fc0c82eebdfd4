#include "density/gather.h"

#include "density/gather_level.h"
#include "numeric/sum.h"

#include <string.h>

static void gather_reserve(struct gather *gather, int64_t count, int n_channels,
                           struct arena *arena) {
  if (count + GRID_ROOM <= gather->capacity) return;
  gather->capacity = 2 * count + GRID_ROOM;
  gather->photon = arena_new(arena, uint32_t, gather->capacity);
  gather->wi = arena_new(arena, struct vec, gather->capacity);
  gather->distance2 = arena_new(arena, double, gather->capacity);
  gather->weight = arena_new(arena, double, gather->capacity);
  for (int c = 0; c < n_channels; c++)
    gather->value[c] = arena_new(arena, double, gather->capacity);
}

// ---- the photons found ----

// Keeps those of paths of at most `depth` scatterings, with their directions and flux. Those that
// are left out have none.
static int fetch_sorted(struct gather *gather, const struct grid *grid,
                        const struct eye_point *point, int depth, int found) {
  int kept = 0;
  for (int j = 0; j < found; j++) {
    uint32_t at = gather->photon[j];
    if (grid->vertex[at] + point->vertex >= depth) continue;
    gather->distance2[kept] = gather->distance2[j];
    gather->wi[kept] = vec(grid->wi[0][at], grid->wi[1][at], grid->wi[2][at]);
    bool out = gather->left_out && (grid->kind[at] & gather->left_out);
    for (int c = 0; c < grid->n_channels; c++) gather->value[c][kept] = out ? 0 : grid->flux[c][at];
    kept++;
  }
  return kept;
}

static bool is_deeper(const struct photons *photons, const struct eye_point *point, int depth,
                      uint32_t photon) {
  return photons->vertex[photon] + point->vertex >= depth;
}

// The same.
static int fetch(struct gather *gather, const struct photons *photons,
                 const struct eye_point *point, int depth, int found) {
  int kept = 0;
  for (int j = 0; j < found; j++) {
    uint32_t photon = gather->photon[j];
    if (is_deeper(photons, point, depth, photon)) continue;
    gather->distance2[kept] = gather->distance2[j];
    gather->wi[kept] = photons->wi[photon];
    bool out = gather->left_out && (photons->kind[photon] & gather->left_out);
    for (int c = 0; c < photons->n_channels; c++)
      gather->value[c][kept] = out ? 0 : photons->flux[c][photon];
    kept++;
  }
  return kept;
}

// By how much the point scatters a photon; false: not at all.
static bool scatters(const struct eye_point *point, struct vec wi, double f[3]) {
  bsdf_value(&point->bsdf, point->wo, wi, TRANSPORT_RADIANCE, f);
  return f[0] != 0 || f[1] != 0 || f[2] != 0;
}

// Keeps the photons that the point scatters, with f * flux of each.
static int weigh(struct gather *gather, int n_channels, const struct eye_point *point, int found) {
  int kept = 0;
  for (int j = 0; j < found; j++) {
    double f[3];
    if (!scatters(point, gather->wi[j], f)) continue;
    double factor = bsdf_photon_factor(&point->bsdf, gather->wi[j]);
    gather->distance2[kept] = gather->distance2[j];
    for (int c = 0; c < n_channels; c++)
      gather->value[c][kept] = f[c] * factor * gather->value[c][j];
    kept++;
  }
  return kept;
}

// f where wi is on the side of z; any direction there has it. False: none.
static bool side_scatters(const struct bsdf *bsdf, struct vec wo, double z, double f[3]) {
  bsdf->type->value(bsdf, wo, vec(0, 0, z), TRANSPORT_RADIANCE, f);
  return f[0] != 0 || f[1] != 0 || f[2] != 0;
}

// Whether photons of one side are scattered, all alike, and none is left out.
static bool is_sided(const struct gather *gather, const struct grid *grid,
                     const struct eye_point *point, int depth, struct sided_bsdf *sided) {
  const struct bsdf *bsdf = &point->bsdf;
  double cosine = vec_dot(point->wo, bsdf->n), f[3];
  if (!bsdf->type->by_side || bsdf->bent || gather->left_out || cosine == 0) return false;
  if (grid->deepest + point->vertex >= depth) return false;
  struct vec wo = vec(0, 0, cosine);
  bool above = side_scatters(bsdf, wo, 1, sided->f), below = side_scatters(bsdf, wo, -1, f);
  sided->n = above ? bsdf->n : vec_scale(bsdf->n, -1);
  if (below) memcpy(sided->f, f, sizeof f);
  return above != below;
}

// All that the point scatters within r, with f * flux of each.
static int find(struct gather *gather, const struct grid *grid, const struct eye_point *point,
                int depth, double r) {
  struct sided_bsdf sided;
  if (grid->count == 0) return 0;
  if (is_sided(gather, grid, point, depth, &sided)) {
    struct grid_range range[GRID_RANGES];
    int n = grid_ranges(grid, point->p, r, range);
    return SIMD_TABLE(gather_level)
        ->find_on_side(grid, range, n, point->p, r * r, &sided, gather->distance2, gather->value);
  }
  int found = grid_find(grid, point->p, r, gather->photon, gather->distance2);
  found = fetch_sorted(gather, grid, point, depth, found);
  return weigh(gather, grid->n_channels, point, found);
}

// ---- the estimates ----

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

// The estimates from n photons, all that the point scatters in the largest disc.
static void estimate(struct gather *gather, int n_channels, const struct eye_point *point, int n,
                     const struct disc *disc, int n_discs, int64_t *count, double *out,
                     long stride) {
  if (n == 0) return;
  for (int e = 0; e < n_discs; e++) {
    if (!is_a_disc(disc[e].r)) continue;
    int within = kernel_weigh(disc[e].kernel, gather->distance2, disc[e].r, gather->weight, n);
    if (count) count[e] = within;
    add(gather, point, n_channels, n, disc[e].scale, out + e * stride);
  }
}

void gather_point(struct gather *gather, const struct grid *grid, const struct eye_point *point,
                  int depth, const struct disc *disc, int n_discs, int64_t *count, double *out,
                  long stride, struct arena *arena) {
  gather_reserve(gather, grid->count, grid->n_channels, arena);
  int n = find(gather, grid, point, depth, largest_radius(disc, n_discs));
  estimate(gather, grid->n_channels, point, n, disc, n_discs, count, out, stride);
}

void gather_point_in_tree(struct gather *gather, const struct photons *photons,
                          const struct knn *tree, const struct eye_point *point, int depth,
                          const struct disc *disc, int n_discs, int64_t *count, double *out,
                          long stride, struct arena *arena) {
  gather_reserve(gather, tree->count, photons->n_channels, arena);
  double r = largest_radius(disc, n_discs);
  int n = knn_within(tree, point->p, r, gather->photon, gather->distance2);
  n = fetch(gather, photons, point, depth, n);
  n = weigh(gather, photons->n_channels, point, n);
  estimate(gather, photons->n_channels, point, n, disc, n_discs, count, out, stride);
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
         scatters(seeking->point, seeking->photons->wi[photon], f);
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
  fetch(gather, photons, point, depth, n);      // keeps them all
  weigh(gather, photons->n_channels, point, n); // and these
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
