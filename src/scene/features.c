#include "scene/scene.h"

static bool shapes_are_gray(const struct scene *scene) {
  for (uint32_t i = 0; i < scene->n_shapes; i++) {
    const struct material *material = &scene->material[scene->shape[i].material];
    if (!material->type->is_gray(material)) return false;
  }
  return true;
}

static bool lights_are_gray(const struct scene *scene) {
  for (uint32_t i = 0; i < scene->n_lights; i++)
    if (!scene->light[i].type->is_gray(&scene->light[i])) return false;
  return true;
}

struct features scene_features(const struct scene *scene) {
  bool gray = shapes_are_gray(scene) && lights_are_gray(scene);
  return (struct features){.gray = gray, .n_channels = gray ? 1 : 3};
}
