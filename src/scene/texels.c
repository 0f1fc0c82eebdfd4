#include "scene/texels.h"

static bool decode(struct scene_builder *builder, struct params *params, const char *filename,
                   struct arena scratch, struct raster *raster) {
  struct text text;
  struct problem problem = {0};
  struct encoding srgb;
  encoding_parse("sRGB", &srgb);
  if (!scene_read_file(builder, params, "filename", filename, &scratch, &text)) return false;
  return raster_decode(text, filename, srgb, builder->arena, scratch, raster, &problem) ||
         params_complain(params, "filename", "%s", problem.text);
}

bool texels_read(struct scene_builder *builder, struct params *params, struct texels *texels) {
  const char *filename = params_string(params, "filename", NULL);
  if (!filename) return params_complain(params, "filename", "needs \"string filename\", an image");
  struct arena scratch = arena_reserve();
  bool read = decode(builder, params, filename, scratch, &texels->raster);
  arena_release(scratch);
  texels->width = texels->raster.width;
  texels->height = texels->raster.height;
  return read;
}

void texels_rgb(const struct texels *texels, int x, int y, double rgb[3]) {
  const struct raster *raster = &texels->raster;
  for (int c = 0; c < 3; c++) {
    double value = raster_value(raster, x, y, raster->n_channels == 1 ? 0 : c);
    rgb[c] = value > 0 ? value : 0;
  }
}

// The texel left of a continuous coordinate, where its centre is 0, and the weight of the next.
static int texel_left_of(double x, int n, double *weight) {
  if (!(x > 0)) x = 0;
  if (x > n - 1) x = n - 1;
  int left = (int)x < n - 1 ? (int)x : n - 2;
  if (left < 0) left = 0;
  *weight = x - left;
  return left;
}

void texels_between(const struct texels *texels, double u, double v, double rgb[3]) {
  double s, t;
  int x = texel_left_of(u * texels->width - 0.5, texels->width, &s);
  int y = texel_left_of(v * texels->height - 0.5, texels->height, &t);
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (int k = 0; k < 4; k++) {
    double value[3], weight = (k % 2 ? s : 1 - s) * (k / 2 ? t : 1 - t);
    if (!(weight > 0)) continue;
    texels_rgb(texels, x + k % 2, y + k / 2, value);
    for (int c = 0; c < 3; c++) rgb[c] += weight * value[c];
  }
}

bool texels_are_gray(const struct texels *texels) {
  if (texels->raster.n_channels == 1) return true;
  for (int y = 0; y < texels->height; y++)
    for (int x = 0; x < texels->width; x++) {
      double rgb[3];
      texels_rgb(texels, x, y, rgb);
      if (rgb[0] != rgb[1] || rgb[1] != rgb[2]) return false;
    }
  return true;
}

static double texel_weight(const struct texels *texels, int x, int y,
                           double (*factor)(const void *, int, int), const void *data) {
  double rgb[3];
  texels_rgb(texels, x, y, rgb);
  return (rgb[0] + rgb[1] + rgb[2]) / 3 * (factor ? factor(data, x, y) : 1);
}

static double *row_of(const struct texels *texels, int y) {
  return texels->column + (ptrdiff_t)y * (texels->width + 1);
}

static void make_even(struct texels *texels) {
  for (int y = 0; y < texels->height; y++) {
    texels->row[y + 1] = y + 1;
    for (int x = 0; x < texels->width; x++) row_of(texels, y)[x + 1] = (x + 1.0) / texels->width;
  }
}

void texels_weigh(struct texels *texels, double (*factor)(const void *, int, int), const void *data,
                  struct arena *arena) {
  texels->row = arena_new(arena, double, (ptrdiff_t)texels->height + 1);
  texels->column = arena_new(arena, double, (ptrdiff_t)texels->height *(texels->width + 1));
  for (int y = 0; y < texels->height; y++) {
    double *cumulative = row_of(texels, y);
    for (int x = 0; x < texels->width; x++)
      cumulative[x + 1] = cumulative[x] + texel_weight(texels, x, y, factor, data);
    texels->row[y + 1] = texels->row[y] + cumulative[texels->width];
  }
  if (!(texels->row[texels->height] > 0)) make_even(texels);
}

static struct texel texel(const struct texels *texels, int x, int y, double u, double v) {
  const double *cumulative = row_of(texels, y);
  return (struct texel){.x = x,
                        .y = y,
                        .u = u,
                        .v = v,
                        .chance =
                            (cumulative[x + 1] - cumulative[x]) / texels->row[texels->height]};
}

struct texel texels_at(const struct texels *texels, double u, double v) {
  int x = (int)(u * texels->width), y = (int)(v * texels->height);
  if (x >= texels->width) x = texels->width - 1;
  if (y >= texels->height) y = texels->height - 1;
  return texel(texels, x, y, u, v);
}

// The interval k with cumulative[k] <= u total < cumulative[k + 1]: bisection keeps both true, and
// an interval of no weight is never found. *rest: where in it, in [0, 1), for both differences are
// an ulp apart at least.
static int choose(const double *cumulative, int n, double u, double *rest) {
  int lo = 0, hi = n;
  double x = u * cumulative[n];
  while (hi - lo > 1) {
    int middle = lo + (hi - lo) / 2;
    if (cumulative[middle] <= x)
      lo = middle;
    else
      hi = middle;
  }
  *rest = (x - cumulative[lo]) / (cumulative[lo + 1] - cumulative[lo]);
  return lo;
}

struct texel texels_choose(const struct texels *texels, const double u[2]) {
  double across, down;
  int y = choose(texels->row, texels->height, u[1], &down);
  int x = choose(row_of(texels, y), texels->width, u[0], &across);
  return texel(texels, x, y, (x + across) / texels->width, (y + down) / texels->height);
}

void texels_sum(const struct texels *texels, double (*factor)(const void *, int, int),
                const void *data, double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (int y = 0; y < texels->height; y++) {
    double row[3] = {0};
    for (int x = 0; x < texels->width; x++) {
      double value[3], f = factor ? factor(data, x, y) : 1;
      texels_rgb(texels, x, y, value);
      for (int c = 0; c < 3; c++) row[c] += value[c] * f;
    }
    for (int c = 0; c < 3; c++) rgb[c] += row[c];
  }
}
