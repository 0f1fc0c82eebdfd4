#include "bvh/tree.h"

#include "scene/shape/triangle.h"

void bvh_block_update(const struct scene *scene, struct bvh_block *block) {
  for (int lane = 0; lane < BVH_BLOCK; lane++) {
    float vertex[3][3] = {{NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}};
    uint32_t p = block->primitive[lane];
    if (p != PRIMITIVE_NONE) triangle_gather(scene, &scene->shape[scene->shape_of[p]], p, vertex);
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) block->vertex[i][k][lane] = vertex[i][k];
  }
}

void bvh_other_update(const struct scene *scene, struct bvh_other *other) {
  const struct shape *shape = &scene->shape[scene->shape_of[other->primitive]];
  other->box = shape->type->bounds(scene, shape, other->primitive);
}

static void set_blocks(struct bvh *bvh, uint32_t row, const uint32_t *primitive, uint32_t count) {
  for (uint32_t first = 0; first < count; first += BVH_BLOCK, row++) {
    struct bvh_block *block = &bvh->block[row];
    for (uint32_t lane = 0; lane < BVH_BLOCK; lane++) {
      bool filled = first + lane < count;
      block->primitive[lane] = filled ? primitive[first + lane] : PRIMITIVE_NONE;
      if (filled) bvh->lane[primitive[first + lane]] = BVH_BLOCK * row + lane;
    }
    block->more = first + BVH_BLOCK < count;
    bvh_block_update(bvh->scene, block);
  }
}

static void set_others(struct bvh *bvh, uint32_t row, const uint32_t *primitive, uint32_t count) {
  for (uint32_t i = 0; i < count; i++, row++) {
    bvh->lane[primitive[i]] = ROW_NONE;
    bvh->other[row].primitive = primitive[i];
    bvh->other[row].more = i + 1 < count;
    bvh_other_update(bvh->scene, &bvh->other[row]);
  }
}

void bvh_leaf_set(struct bvh *bvh, uint32_t leaf, const uint32_t *primitive, uint32_t count) {
  if (bvh_kind_of(leaf) == BVH_TRIANGLES) set_blocks(bvh, bvh_row_of(leaf), primitive, count);
  if (bvh_kind_of(leaf) == BVH_OTHERS) set_others(bvh, bvh_row_of(leaf), primitive, count);
}
