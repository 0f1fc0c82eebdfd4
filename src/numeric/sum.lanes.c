#include "numeric/lanes.h"
#include "numeric/sum_level.h"

// Where there is no item 0 is added, which changes no sum that begins with 0.
static double products(const double *a, const double *b, int n) {
  lanes part[SUM_PARTS];
  for (int p = 0; p < SUM_PARTS; p++) part[p] = lanes_set(0);
  for (int j = 0; j < n; j += SUM_LANES)
    for (int p = 0; p < SUM_PARTS; p++) {
      int at = j + p * LANES;
      lanes_some mine = lanes_first(n - at);
      part[p] += lanes_load_where(mine, a + at) * lanes_load_where(mine, b + at);
    }
  return lanes_total(part);
}

const struct sum_level SIMD_NAME(sum_level) = {products};
