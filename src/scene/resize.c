// Resampling as pbrt's: a Lanczos filter of radius 2, first along rows, then along columns, each
// normalised; negative results become 0.
#include "scene/resize.h"

#include "base/exact.h"
#include "numeric/elementary.h"

enum { TAPS = 4 };

// Of one new texel: the first of the old ones and their weights.
struct weights {
  int first;
  double w[TAPS];
};

static double sinc(double x) { // sin(pi x) / (pi x)
  double sine, cosine;
  if (x == 0) return 1;
  num_sincos_turns(0.5 * x, &sine, &cosine);
  return sine / (0x1.921fb54442d18p+1 * x);
}

static double lanczos(double x) { return fabs(x) > 2 ? 0 : sinc(x) * sinc(0.5 * x); }

static struct weights *make_weights(int old_size, int new_size, struct arena *arena) {
  struct weights *weights = arena_new(arena, struct weights, new_size);
  for (int i = 0; i < new_size; i++) {
    double centre = (i + 0.5) * old_size / new_size, sum = 0;
    weights[i].first = (int)floor(centre - 2 + 0.5);
    for (int k = 0; k < TAPS; k++)
      sum += weights[i].w[k] = lanczos(weights[i].first + k + 0.5 - centre);
    for (int k = 0; k < TAPS; k++) weights[i].w[k] /= sum;
  }
  return weights;
}

// One old row, wrapped, enlarged along itself.
static void stretch_row(const struct raster *raster, const struct wrap *wrap, int y,
                        const struct weights *weights, int new_width, float *to) {
  int n = raster->n_channels;
  for (int x = 0; x < new_width; x++) {
    double sum[4] = {0}, texel[4];
    for (int k = 0; k < TAPS; k++) {
      wrap_texel(wrap, raster, weights[x].first + k, y, 0, n, texel);
      for (int c = 0; c < n; c++) sum[c] += weights[x].w[k] * texel[c];
    }
    for (int c = 0; c < n; c++) to[(ptrdiff_t)x * n + c] = (float)sum[c];
  }
}

// Linear values halfway between bytes, in their encoding.
struct steps {
  double between[256]; // b - 1 and b
};

static struct steps make_steps(struct encoding encoding) {
  struct steps steps = {{0}};
  for (int b = 1; b < 256; b++) steps.between[b] = encoding_decode(encoding, (b - 0.5) / 255);
  return steps;
}

static unsigned char nearest_byte(const struct steps *steps, double v) {
  int b = 0;
  for (int step = 128; step > 0; step /= 2)
    if (v >= steps->between[b + step]) b += step;
  return (unsigned char)b;
}

static int power_of_two(int size) {
  int power = 1;
  while (power < size) power *= 2;
  return power;
}

// The old rows weights[y] needs are consecutive in `rows`, which begin with row -2.
static void stretch_columns(const float *rows, ptrdiff_t length, const struct weights *weights,
                            struct raster *out, unsigned char *byte, float *value) {
  struct steps steps = make_steps(out->encoding);
  for (int y = 0; y < out->height; y++)
    for (ptrdiff_t j = 0; j < length; j++) {
      double sum = 0;
      for (int k = 0; k < TAPS; k++)
        sum += weights[y].w[k] * (double)rows[(weights[y].first + 2 + k) * length + j];
      if (!(sum > 0)) sum = 0;
      if (byte)
        byte[y * length + j] = nearest_byte(&steps, sum);
      else
        value[y * length + j] = (float)sum;
    }
}

void resize_to_powers_of_two(struct raster *raster, const struct wrap *wrap, struct arena *arena,
                             struct arena scratch) {
  struct raster old = *raster;
  raster->width = power_of_two(old.width);
  raster->height = power_of_two(old.height);
  if (raster->width == old.width && raster->height == old.height) return;
  const struct weights *across = make_weights(old.width, raster->width, &scratch);
  const struct weights *down = make_weights(old.height, raster->height, &scratch);
  ptrdiff_t length = (ptrdiff_t)raster->width * old.n_channels;
  float *rows = arena_new(&scratch, float, length *(old.height + 4));
  for (int y = -2; y < old.height + 2; y++)
    stretch_row(&old, wrap, y, across, raster->width, rows + (y + 2) * length);
  unsigned char *byte = NULL;
  float *value = NULL;
  if (old.byte)
    raster->byte = byte = arena_new(arena, unsigned char, length * raster->height);
  else
    raster->value = value = arena_new(arena, float, length * raster->height);
  stretch_columns(rows, length, down, raster, byte, value);
}
