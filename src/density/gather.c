#include "density/gather.h"

#include "numeric/sum.h"

static void gather_reserve(struct gather *gather, int64_t count, int n_channels,
                           struct arena *arena) {
  if (count <= gather->capacity) return;
  gather->capacity = 2 * count;
  gather->photon = arena_new(arena, uint32_t, gather->capacity);
  gather->distance2 = arena_new(arena, double, gather->capacity);
  gather->t2 = arena_new(arena, double, gather->capacity);
  gather->weight = arena_new(arena, double, gather->capacity);
  for (int c = 0; c < n_channels; c++)
    gather->value[c] = arena_new(arena, double, gather->capacity);
}

// Whether the point scatters a photon, of a path of at most `depth` scatterings; then f is by how
// much.
static bool scatters(const struct photons *photons, const struct eye_point *point, int depth,
                     uint32_t photon, double f[3]) {
  if (photons->vertex[photon] + point->vertex >= depth) return false;
  bsdf_value(&point->bsdf, point->wo, photons->wi[photon], TRANSPORT_RADIANCE, f);
  return f[0] != 0 || f[1] != 0 || f[2] != 0;
}

// Keeps the photons that the point scatters, with f * flux of each.
static int weigh(struct gather *gather, const struct photons *photons,
                 const struct eye_point *point, int depth, int found) {
  int kept = 0;
  for (int j = 0; j < found; j++) {
    uint32_t photon = gather->photon[j];
    double f[3];
    if (!scatters(photons, point, depth, photon, f)) continue;
    double factor = bsdf_photon_factor(&point->bsdf, photons->wi[photon]);
    gather->distance2[kept] = gather->distance2[j];
    if (gather->left_out && (photons->kind[photon] & gather->left_out)) factor = 0;
    for (int c = 0; c < photons->n_channels; c++)
      gather->value[c][kept] = f[c] * factor * photons->flux[c][photon];
    kept++;
  }
  return kept;
}

// weight[j] = psi(d_j / r) / c, zero outside the disc; how many are within.
static int64_t evaluate(struct gather *gather, const struct disc *disc, int n) {
  int64_t within = 0;
  double inverse_r2 = 1 / (disc->r * disc->r);
  for (int j = 0; j < n; j++) {
    double t2 = gather->distance2[j] * inverse_r2;
    gather->t2[j] = t2 < 1 ? t2 : 0;
  }
  disc->kernel->shape(gather->t2, gather->weight, n);
  for (int j = 0; j < n; j++) {
    bool in = gather->distance2[j] * inverse_r2 < 1;
    gather->weight[j] = in ? gather->weight[j] : 0;
    within += in;
  }
  return within;
}

static double weighted_sum(const double *weight, const double *value, int n) {
  double lane[SUM_LANES] = {0};
  for (int j = 0; j < n; j++) lane[j % SUM_LANES] += weight[j] * value[j];
  return sum_lanes(lane);
}

static void add(const struct gather *gather, const struct eye_point *point, int n_channels, int n,
                double scale, double *out) {
  for (int c = 0; c < n_channels; c++)
    out[c] += point->weight[c] * (scale * weighted_sum(gather->weight, gather->value[c], n));
}

static bool is_a_disc(double r) { return r * r > 0 && r * r < INFINITY; }

static double largest_radius(const struct disc *disc, int n_discs) {
  double r = 0;
  for (int e = 0; e < n_discs; e++)
    if (is_a_disc(disc[e].r)) r = r < disc[e].r ? disc[e].r : r;
  return r;
}

// The estimates from `found` photons, all there are in the largest disc.
static void add_found(struct gather *gather, const struct photons *photons,
                      const struct eye_point *point, int depth, int found, const struct disc *disc,
                      int n_discs, int64_t *count, double *out, long stride) {
  int n = weigh(gather, photons, point, depth, found);
  if (n == 0) return;
  for (int e = 0; e < n_discs; e++) {
    if (!is_a_disc(disc[e].r)) continue;
    int64_t within = evaluate(gather, &disc[e], n);
    if (count) count[e] = within;
    add(gather, point, photons->n_channels, n, disc[e].scale, out + e * stride);
  }
}

void gather_point(struct gather *gather, const struct photons *photons, const struct grid *grid,
                  const struct eye_point *point, int depth, const struct disc *disc, int n_discs,
                  int64_t *count, double *out, long stride, struct arena *arena) {
  gather_reserve(gather, grid->count, photons->n_channels, arena);
  double r = largest_radius(disc, n_discs);
  int found = grid_find(grid, point->p, r, gather->photon, gather->distance2);
  add_found(gather, photons, point, depth, found, disc, n_discs, count, out, stride);
}

void gather_point_in_tree(struct gather *gather, const struct photons *photons,
                          const struct knn *tree, const struct eye_point *point, int depth,
                          const struct disc *disc, int n_discs, int64_t *count, double *out,
                          long stride, struct arena *arena) {
  gather_reserve(gather, tree->count, photons->n_channels, arena);
  double r = largest_radius(disc, n_discs);
  int found = knn_within(tree, point->p, r, gather->photon, gather->distance2);
  add_found(gather, photons, point, depth, found, disc, n_discs, count, out, stride);
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
  return scatters(seeking->photons, seeking->point, seeking->depth, photon, f);
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
  weigh(gather, photons, point, depth, n); // keeps them all
  for (int e = 0; e < n_discs; e++) {
    if (k[e] == 0 || k[e] > n) continue;
    double r2 = gather->distance2[k[e] - 1], r = sqrt(r2);
    if (!is_a_disc(r)) continue;
    struct disc own = {disc[e].kernel, r, disc[e].scale / r2};
    evaluate(gather, &own, k[e] - 1);
    add(gather, point, photons->n_channels, k[e] - 1, own.scale, out + e * stride);
  }
}

double gather_distance(struct gather *gather, const struct photons *photons, const struct knn *tree,
                       const struct eye_point *point, int depth, int k, struct arena *arena) {
  int n = find_nearest(gather, photons, tree, point, depth, k, arena);
  return n < k ? INFINITY : sqrt(gather->distance2[k - 1]);
}
