// The photons at a point whose BSDF depends on sides alone, as that of most does: one dot product
// a photon.
#include "density/gather_level.h"
#include "numeric/lanes.h"

static bool scatters(const double f[3]) { return f[0] != 0 || f[1] != 0 || f[2] != 0; }

// wi . n, rounded as vec_dot does.
static inline lanes cosine(const struct vec *wi, lanes_mask mine, const uint32_t *photon,
                           struct vec n) {
  return lanes_gather(mine, &wi->x, 3, photon) * lanes_of(n.x) +
         lanes_gather(mine, &wi->y, 3, photon) * lanes_of(n.y) +
         lanes_gather(mine, &wi->z, 3, photon) * lanes_of(n.z);
}

static int weigh_by_side(struct gather *gather, const struct photons *photons,
                         const struct sided_bsdf *bsdf, int n) {
  lanes_mask above_counts = lanes_first(scatters(bsdf->above) ? LANES : 0);
  lanes_mask below_counts = lanes_first(scatters(bsdf->below) ? LANES : 0);
  int kept = 0;
  for (int j = 0; j < n; j += LANES) {
    lanes_mask mine = lanes_first(n - j);
    const uint32_t *photon = gather->photon + j;
    lanes z = cosine(photons->wi, mine, photon, bsdf->n);
    lanes_mask above = lanes_less(lanes_of(0), z), below = lanes_less(z, lanes_of(0));
    lanes_mask keep = lanes_or(lanes_and(above, above_counts), lanes_and(below, below_counts));
    lanes_pack(keep, gather->distance2 + kept, lanes_load(gather->distance2 + j));
    for (int c = 0; c < photons->n_channels; c++) {
      lanes f = lanes_where(above, lanes_of(bsdf->above[c])) +
                lanes_where(below, lanes_of(bsdf->below[c]));
      lanes flux = lanes_gather(mine, photons->flux[c], 1, photon);
      lanes_pack(keep, gather->value[c] + kept, f * flux);
    }
    kept += lanes_count(keep);
  }
  return kept;
}

const struct gather_level LEVEL_NAME(gather_level) = {weigh_by_side};
