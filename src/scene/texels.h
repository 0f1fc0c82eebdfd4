// An image that a light emits: its texels, constant each, and a choice of one in proportion to a
// weight. As pbrt-v4 takes them: linear, negative values are zero, rows from the top.
#ifndef SCENE_TEXELS_H
#define SCENE_TEXELS_H

#include "image/raster.h"
#include "scene/read.h"

struct texels {
  struct raster raster;
  int width, height;
  double *row;    // [height + 1] cumulative weights of the rows
  double *column; // [height][width + 1] cumulative weights within each
};

struct texel {
  int x, y;
  double u, v;   // the point of the image in [0, 1)^2, uniform within the texel
  double chance; // of this texel: its weight over that of all
};

// The image that `string filename` names.
bool texels_read(struct scene_builder *, struct params *, struct texels *);

void texels_rgb(const struct texels *, int x, int y, double rgb[3]);
// Bilinear between the centres of texels, constant beyond the outermost.
void texels_between(const struct texels *, double u, double v, double rgb[3]);
bool texels_are_gray(const struct texels *);

// The texel of a point of the image; the last ones where u or v is 1.
struct texel texels_at(const struct texels *, double u, double v);

// Chances in proportion to the mean over channels times factor(data, x, y) (NULL: 1); where all of
// these are zero, the same for all.
void texels_weigh(struct texels *, double (*factor)(const void *data, int x, int y),
                  const void *data, struct arena *);

struct texel texels_choose(const struct texels *, const double u[2]);

// The sums over all texels of rgb times factor(data, x, y), for powers; the order is fixed.
void texels_sum(const struct texels *, double (*factor)(const void *data, int x, int y),
                const void *data, double rgb[3]);

#endif
