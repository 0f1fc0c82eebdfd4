#include "scene/shape/triangle.h"
#include "scene/skip.h"

static bool shapes_are_gray(const struct scene *scene) {
  for (uint32_t i = 0; i < scene->n_shapes; i++) {
    const struct material *material = &scene->material[scene->shape[i].material];
    if (!material->type->is_gray(scene, material)) return false;
  }
  return true;
}

static bool lights_are_gray(const struct scene *scene) {
  for (uint32_t i = 0; i < scene->n_lights; i++)
    if (!scene->light[i].type->is_gray(&scene->light[i])) return false;
  return true;
}

// Bits of enum material_needs that any shape's material has.
static unsigned material_needs(const struct scene *scene) {
  unsigned needs = 0;
  for (uint32_t i = 0; i < scene->n_shapes; i++)
    needs |= scene->material[scene->shape[i].material].needs;
  return needs;
}

static bool any_see_through(const struct scene *scene) {
  for (uint32_t i = 0; i < scene->n_shapes; i++)
    if (scene->shape[i].see_through) return true;
  return false;
}

bool scene_uses_medium(const struct scene *scene, uint32_t row) {
  if (scene->camera_medium == row) return true;
  for (uint32_t i = 0; i < scene->n_lights; i++)
    if (scene->light[i].medium == row) return true;
  for (uint32_t i = 0; i < scene->n_shapes; i++)
    if (scene->shape[i].inside == row || scene->shape[i].outside == row) return true;
  return false;
}

struct media_use {
  bool any, coloured;
};

static struct media_use media_use(const struct scene *scene) {
  struct media_use use = {0};
  for (uint32_t row = 0; row < scene->n_media; row++) {
    const struct medium *medium = &scene->medium[row];
    if (!scene_uses_medium(scene, row)) continue;
    use.any = true;
    use.coloured = use.coloured || !medium->type->is_gray(medium);
  }
  return use;
}

struct features scene_features(const struct scene *scene) {
  struct media_use media = media_use(scene);
  bool gray = shapes_are_gray(scene) && lights_are_gray(scene) && !media.coloured;
  unsigned needs = material_needs(scene);
  struct features features = {
      .gray = gray,
      .n_channels = gray ? 1 : 3,
      .random_materials = needs & MATERIAL_RANDOM,
      .see_through = any_see_through(scene),
      .motion = scene->n_motions > 0 || scene->camera.animation.moves,
      .background = scene->n_infinite > 0,
      .media = media.any,
  };
  features.random_eye = features.motion || features.see_through || features.media ||
                        needs & (MATERIAL_RANDOM | MATERIAL_DELTA) || scene->camera.lens_radius > 0;
  return features;
}

bool scene_is_few_triangles(const struct scene *scene) {
  if (scene->n_primitives > SKIP_FEW_TRIANGLES) return false;
  for (uint32_t s = 0; s < scene->n_shapes; s++)
    if (scene->shape[s].type->intersect != triangle_intersect) return false;
  return true;
}
