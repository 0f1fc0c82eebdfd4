// Material "interface": a surface between media, which rays pass without scattering.
#include "scene/read.h"

static bool read(struct scene_builder *builder, struct params *params, struct material *material) {
  (void)builder, (void)material;
  return params_finish(params);
}

static bool is_gray(const struct scene *scene, const struct material *material) {
  (void)scene, (void)material;
  return true;
}

const struct material_type material_interface = {
    .name = "interface",
    .about = "nothing but a boundary of media: rays pass",
    .passed = true,
    .read = read,
    .is_gray = is_gray,
};
