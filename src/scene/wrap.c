#include "scene/wrap.h"

#include <math.h>
#include <string.h>

static bool move_repeat(double at[2], const int size[2]) {
  for (int k = 0; k < 2; k++) at[k] -= size[k] * floor(at[k] / size[k]);
  return true;
}

static bool move_black(double at[2], const int size[2]) {
  (void)at, (void)size;
  return false;
}

// to_index does the rest.
static bool move_clamp(double at[2], const int size[2]) {
  (void)at, (void)size;
  return true;
}

// Over an edge of an equal-area octahedral map the same edge is met, in the other direction. (Below
// zero pbrt counts from 0: texel -1 is texel 1.)
static bool move_octahedral(double at[2], const int size[2]) {
  for (int k = 0; k < 2; k++) {
    if (at[k] >= 0 && at[k] < size[k]) continue;
    at[k] = at[k] < 0 ? -at[k] : 2.0 * size[k] - 1 - at[k];
    at[1 - k] = size[1 - k] - 1 - at[1 - k];
  }
  return true;
}

static const struct wrap wraps[] = {
    {"repeat", move_repeat},
    {"black", move_black},
    {"clamp", move_clamp},
    {"octahedralsphere", move_octahedral},
};
enum { N_WRAPS = sizeof wraps / sizeof *wraps };

const struct wrap *wrap_find(const char *name) {
  for (int k = 0; k < N_WRAPS; k++)
    if (strcmp(wraps[k].name, name) == 0) return &wraps[k];
  return NULL;
}

static int to_index(double at, int size) {
  if (!(at > 0)) return 0;
  return at < size - 1 ? (int)at : size - 1;
}

void wrap_texel(const struct wrap *wrap, const struct raster *raster, double x, double y, int first,
                int n, double *texel) {
  double at[2] = {x, y};
  int size[2] = {raster->width, raster->height};
  bool inside = x >= 0 && x < size[0] && y >= 0 && y < size[1];
  bool black = !inside && !wrap->move(at, size);
  int column = to_index(at[0], size[0]), row = to_index(at[1], size[1]);
  for (int c = 0; c < n; c++) texel[c] = black ? 0 : raster_value(raster, column, row, first + c);
}
