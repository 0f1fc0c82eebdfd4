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

// Keeps the photons that the point scatters, with f * flux of each, of paths of at most `depth`
// scatterings.
static int weigh(struct gather *gather, const struct photons *photons,
                 const struct eye_point *point, int depth, int found) {
  int kept = 0;
  for (int j = 0; j < found; j++) {
    uint32_t photon = gather->photon[j];
    if (photons->vertex[photon] + point->vertex >= depth) continue;
    struct vec wi = photons->wi[photon];
    double f[3], factor = bsdf_photon_factor(&point->bsdf, wi);
    bsdf_value(&point->bsdf, point->wo, wi, TRANSPORT_RADIANCE, f);
    if (f[0] == 0 && f[1] == 0 && f[2] == 0) continue;
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

void gather_point(struct gather *gather, const struct photons *photons, const struct grid *grid,
                  const struct eye_point *point, int depth, const struct disc *disc, int n_discs,
                  int64_t *count, double *out, long stride, struct arena *arena) {
  gather_reserve(gather, grid->count, photons->n_channels, arena);
  double r = 0;
  for (int e = 0; e < n_discs; e++) r = r < disc[e].r ? disc[e].r : r;
  int found = grid_find(grid, point->p, r, gather->photon, gather->distance2);
  int n = weigh(gather, photons, point, depth, found);
  if (n == 0) return;
  for (int e = 0; e < n_discs; e++) {
    int64_t within = evaluate(gather, &disc[e], n);
    if (count) count[e] = within;
    for (int c = 0; c < photons->n_channels; c++)
      out[e * stride + c] +=
          point->weight[c] * (disc[e].scale * weighted_sum(gather->weight, gather->value[c], n));
  }
}
