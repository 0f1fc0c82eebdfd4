// A tree whose primitives move keeps its shape: boxes and vertices are computed again, from the
// leaves up, along the paths that lead to what moves.
#include "bvh/bounds.h"
#include "bvh/tree.h"

#include <string.h>

void bvh_allocate(struct bvh *bvh, uint32_t n_nodes, uint32_t n_blocks, uint32_t n_others,
                  struct arena *arena) {
  bvh->n_nodes = n_nodes, bvh->n_blocks = n_blocks, bvh->n_others = n_others;
  bvh->node = arena_alloc(arena, n_nodes, sizeof *bvh->node, BVH_LINE);
  bvh->block = arena_alloc(arena, n_blocks, sizeof *bvh->block, BVH_LINE);
  bvh->other = arena_alloc(arena, n_others, sizeof *bvh->other, BVH_LINE);
}

static bool blocks_move(const struct bvh *bvh, const struct bvh_block *block, const bool *moves) {
  const uint32_t *shape_of = bvh->scene->shape_of;
  for (bool more = true; more; more = block++->more)
    for (int lane = 0; lane < BVH_BLOCK; lane++) {
      uint32_t p = block->primitive[lane];
      if (p != PRIMITIVE_NONE && moves[shape_of[p]]) return true;
    }
  return false;
}

static bool others_move(const struct bvh *bvh, const struct bvh_other *other, const bool *moves) {
  for (bool more = true; more; more = other++->more)
    if (moves[bvh->scene->shape_of[other->primitive]]) return true;
  return false;
}

static bool mark_moving(struct bvh *bvh, uint32_t child, const bool *moves) {
  uint32_t row = bvh_row_of(child);
  switch (bvh_kind_of(child)) {
  case BVH_NOTHING:
    return false;
  case BVH_TRIANGLES:
    return blocks_move(bvh, &bvh->block[row], moves);
  case BVH_OTHERS:
    return others_move(bvh, &bvh->other[row], moves);
  case BVH_NODE:
    break;
  }
  unsigned char moving = 0;
  for (int slot = 0; slot < BVH_WIDTH; slot++)
    if (mark_moving(bvh, bvh->node[row].child[slot], moves)) moving |= (unsigned char)(1 << slot);
  bvh->moving[row] = moving;
  return moving != 0;
}

struct bvh *bvh_clone(const struct bvh *bvh, const struct scene *scene, const bool *moves,
                      struct arena *arena) {
  struct bvh *clone = arena_new(arena, struct bvh, 1);
  *clone = *bvh;
  clone->scene = scene;
  clone->few = NULL; // its triangles will move
  bvh_allocate(clone, bvh->n_nodes, bvh->n_blocks, bvh->n_others, arena);
  memcpy(clone->node, bvh->node, bvh->n_nodes * sizeof *bvh->node);
  memcpy(clone->block, bvh->block, bvh->n_blocks * sizeof *bvh->block);
  memcpy(clone->other, bvh->other, bvh->n_others * sizeof *bvh->other);
  clone->moving = NULL;
  if (moves) {
    clone->moving = arena_new(arena, unsigned char, bvh->n_nodes);
    mark_moving(clone, clone->root, moves);
  }
  return clone;
}

static void add_block(const struct bvh_block *block, struct bounds *all) {
  for (int lane = 0; lane < BVH_BLOCK && block->primitive[lane] != PRIMITIVE_NONE; lane++)
    for (int i = 0; i < 3; i++) {
      const float(*v)[BVH_BLOCK] = block->vertex[i];
      bounds_add_point(all, (float4){v[0][lane], v[1][lane], v[2][lane]});
    }
}

static struct bounds blocks_refit(const struct bvh *bvh, struct bvh_block *block) {
  struct bounds all = bounds_empty();
  for (bool more = true; more; more = block++->more) {
    bvh_block_update(bvh->scene, block);
    add_block(block, &all);
  }
  return all;
}

static struct bounds others_refit(const struct bvh *bvh, struct bvh_other *other) {
  struct bounds all = bounds_empty();
  for (bool more = true; more; more = other++->more) {
    bvh_other_update(bvh->scene, other);
    bounds_add(&all, bounds_of_box(&other->box));
  }
  return all;
}

static struct bounds child_refit(struct bvh *bvh, uint32_t child);

static struct bounds node_refit(struct bvh *bvh, uint32_t row) {
  struct bvh_node *node = &bvh->node[row];
  struct bounds all = bounds_empty();
  for (int slot = 0; slot < BVH_WIDTH; slot++) {
    if (!bvh->moving || bvh->moving[row] & 1 << slot)
      node_set_box(node, slot, child_refit(bvh, node->child[slot]));
    bounds_add(&all, node_box(node, slot));
  }
  return all;
}

static struct bounds child_refit(struct bvh *bvh, uint32_t child) {
  uint32_t row = bvh_row_of(child);
  switch (bvh_kind_of(child)) {
  case BVH_NODE:
    return node_refit(bvh, row);
  case BVH_TRIANGLES:
    return blocks_refit(bvh, &bvh->block[row]);
  case BVH_OTHERS:
    return others_refit(bvh, &bvh->other[row]);
  case BVH_NOTHING:
    break;
  }
  return bounds_empty();
}

void bvh_refit(struct bvh *bvh) { bvh->box = bounds_box(child_refit(bvh, bvh->root)); }
