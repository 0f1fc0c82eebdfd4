// The body of grid_find: those within r are moved to the front and stored.
#include "density/grid_level.h"
#include "numeric/lanes.h"

static int within(const struct grid *grid, const struct grid_range *range, int n, struct vec p,
                  double r2, uint32_t *at, double *distance2) {
  int found = 0;
  for (int k = 0; k < n; k++)
    for (int64_t j = range[k].begin, end = range[k].end; j < end; j += LANES) {
      lanes dx = lanes_load(grid->position[0] + j) - lanes_of(p.x);
      lanes dy = lanes_load(grid->position[1] + j) - lanes_of(p.y);
      lanes dz = lanes_load(grid->position[2] + j) - lanes_of(p.z);
      lanes d2 = dx * dx + dy * dy + dz * dz;
      lanes_mask in = lanes_and(lanes_less(d2, lanes_of(r2)), lanes_first((int)(end - j)));
      lanes_pack(in, distance2 + found, d2);
      lanes_pack_numbers(in, at + found, (uint32_t)j);
      found += lanes_count(in);
    }
  return found;
}

const struct grid_level LEVEL_NAME(grid_level) = {within};
