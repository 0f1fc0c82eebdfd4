// Which light a path starts from or connects to.
#ifndef WALK_LIGHT_H
#define WALK_LIGHT_H

#include "scene/scene.h"

// In proportion to power: light l for light_cdf[l] <= u < light_cdf[l + 1]. A light of zero
// probability is never chosen. The scene has at least one light.
static inline const struct light *light_choose(const struct scene *scene, double u) {
  uint32_t lo = 0, hi = scene->n_lights;
  while (hi - lo > 1) {
    uint32_t middle = (lo + hi) / 2;
    if (u < scene->light_cdf[middle])
      hi = middle;
    else
      lo = middle;
  }
  return &scene->light[lo];
}

#endif
