#include "density/gather_level.h"
#include "numeric/lanes.h"

// One pass over the photons: those that are near and on the side are moved to the front and stored.
static int find_on_side(const struct grid *grid, const struct grid_range *range, int n,
                        struct vec p, double r2, const struct sided_bsdf *bsdf, double *distance2,
                        double *const value[3]) {
  const double *x = grid->position[0], *y = grid->position[1], *z = grid->position[2];
  const double *wx = grid->wi[0], *wy = grid->wi[1], *wz = grid->wi[2];
  const struct vec normal = bsdf->n;
  const int n_channels = grid->n_channels;
  int found = 0;
  for (int k = 0; k < n; k++)
    for (int64_t j = range[k].begin, end = range[k].end; j < end; j += LANES) {
      lanes dx = lanes_load(x + j) - lanes_set(p.x), dy = lanes_load(y + j) - lanes_set(p.y),
            dz = lanes_load(z + j) - lanes_set(p.z);
      lanes d2 = dx * dx + dy * dy + dz * dz;
      lanes cosine = lanes_load(wx + j) * lanes_set(normal.x) +
                     lanes_load(wy + j) * lanes_set(normal.y) +
                     lanes_load(wz + j) * lanes_set(normal.z);
      lanes_some in = lanes_and(lanes_less(d2, lanes_set(r2)), lanes_first((int)(end - j)));
      in = lanes_and(in, lanes_less(lanes_set(0), cosine));
      lanes_pack(in, distance2 + found, d2);
      for (int c = 0; c < n_channels; c++)
        lanes_pack(in, value[c] + found, lanes_set(bsdf->f[c]) * lanes_load(grid->flux[c] + j));
      found += lanes_count(in);
    }
  return found;
}

const struct gather_level SIMD_NAME(gather_level) = {find_on_side};
