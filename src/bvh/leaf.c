#include "bvh/tree.h"

#include "scene/shape/triangle.h"

void bvh_block_set(const struct scene *scene, struct bvh_block *block, const uint32_t *primitive,
                   uint32_t count) {
  static const struct bvh_block nothing = {.vertex = {{{NAN, NAN}}},
                                           .primitive = {PRIMITIVE_NONE, PRIMITIVE_NONE}};
  *block = nothing;
  for (uint32_t lane = 0; lane < count && lane < LANES; lane++) {
    float vertex[3][3];
    uint32_t p = primitive[lane];
    triangle_gather(scene, &scene->shape[scene->shape_of[p]], p, vertex);
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) block->vertex[i][k][lane] = vertex[i][k];
    block->primitive[lane] = p;
  }
}

void bvh_other_set(const struct scene *scene, struct bvh_other *other, uint32_t primitive) {
  const struct shape *shape = &scene->shape[scene->shape_of[primitive]];
  *other = (struct bvh_other){shape->type->bounds(scene, shape, primitive), primitive};
}
