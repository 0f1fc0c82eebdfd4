// Texture "bilerp": bilinear between `v00` [0], `v01` [1], `v10` [0], `v11` [1] at the corners (s,
// t) of the unit square, and on beyond it.
#include "scene/mapping.h"
#include "scene/texture/inputs.h"

struct bilerp {
  struct mapping mapping;
  double v00[3], v01[3], v10[3], v11[3];
};

static bool read(struct scene_builder *builder, struct params *params, bool spectrum,
                 struct texture *texture) {
  struct bilerp *bilerp = arena_new(builder->arena, struct bilerp, 1);
  texture_value(builder, params, spectrum, "v00", 0, bilerp->v00);
  texture_value(builder, params, spectrum, "v01", 1, bilerp->v01);
  texture_value(builder, params, spectrum, "v10", 0, bilerp->v10);
  texture_value(builder, params, spectrum, "v11", 1, bilerp->v11);
  texture->data = bilerp;
  return mapping_read(builder, params, &bilerp->mapping) && params_finish(params);
}

static void evaluate(const struct texture *texture, const struct surface *surface,
                     double value[3]) {
  const struct bilerp *bilerp = texture->data;
  double st[2];
  mapping_st(&bilerp->mapping, surface, st);
  double s = st[0], t = st[1];
  for (int c = 0; c < 3; c++)
    value[c] = (1 - s) * (1 - t) * bilerp->v00[c] + s * (1 - t) * bilerp->v10[c] +
               (1 - s) * t * bilerp->v01[c] + s * t * bilerp->v11[c];
}

static bool is_gray(const struct texture *texture) {
  const struct bilerp *bilerp = texture->data;
  return is_gray_rgb(bilerp->v00) && is_gray_rgb(bilerp->v01) && is_gray_rgb(bilerp->v10) &&
         is_gray_rgb(bilerp->v11);
}

const struct texture_type texture_bilerp = {
    .name = "bilerp",
    .about = "bilinear between four corners",
    .read = read,
    .evaluate = evaluate,
    .is_gray = is_gray,
};
