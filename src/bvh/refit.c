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

static bool leaf_moves(const struct bvh *bvh, struct bvh_child leaf, const bool *moves) {
  const uint32_t *shape_of = bvh->scene->shape_of;
  for (uint32_t i = 0; i < leaf.count && leaf.kind == BVH_OTHERS; i++)
    if (moves[shape_of[bvh->other[leaf.first + i].primitive]]) return true;
  for (uint32_t i = 0; i < leaf.count && leaf.kind == BVH_TRIANGLES; i++)
    for (int lane = 0; lane < LANES; lane++) {
      uint32_t p = bvh->block[leaf.first + i].primitive[lane];
      if (p != PRIMITIVE_NONE && moves[shape_of[p]]) return true;
    }
  return false;
}

static bool mark_moving(struct bvh *bvh, struct bvh_child child, const bool *moves) {
  if (child.kind != BVH_NODE) return leaf_moves(bvh, child, moves);
  unsigned char moving = 0;
  for (int side = 0; side < 2; side++)
    if (mark_moving(bvh, bvh->node[child.first].child[side], moves))
      moving |= (unsigned char)(1 << side);
  bvh->moving[child.first] = moving;
  return moving != 0;
}

struct bvh *bvh_clone(const struct bvh *bvh, const struct scene *scene, const bool *moves,
                      struct arena *arena) {
  struct bvh *clone = arena_new(arena, struct bvh, 1);
  *clone = *bvh;
  clone->scene = scene;
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

static struct bounds block_bounds(const struct bvh_block *block) {
  struct bounds box = bounds_empty();
  for (int lane = 0; lane < LANES; lane++)
    for (int i = 0; i < 3 && block->primitive[lane] != PRIMITIVE_NONE; i++) {
      const lanes_float *v = block->vertex[i];
      bounds_add_point(&box, (float4){v[0][lane], v[1][lane], v[2][lane]});
    }
  return box;
}

static struct bounds leaf_refit(struct bvh *bvh, struct bvh_child leaf) {
  struct bounds all = bounds_empty();
  for (uint32_t i = leaf.first; i < leaf.first + leaf.count; i++)
    if (leaf.kind == BVH_TRIANGLES) {
      uint32_t primitive[LANES], n = 0;
      while (n < LANES && bvh->block[i].primitive[n] != PRIMITIVE_NONE)
        primitive[n] = bvh->block[i].primitive[n], n++;
      bvh_block_set(bvh->scene, &bvh->block[i], primitive, n);
      bounds_add(&all, block_bounds(&bvh->block[i]));
    } else {
      bvh_other_set(bvh->scene, &bvh->other[i], bvh->other[i].primitive);
      const struct box *box = &bvh->other[i].box;
      bounds_add(&all, (struct bounds){bounds_load(box->lo), bounds_load(box->hi)});
    }
  return all;
}

static struct bounds child_refit(struct bvh *bvh, struct bvh_child child) {
  if (child.kind != BVH_NODE) return leaf_refit(bvh, child);
  struct bvh_node *node = &bvh->node[child.first];
  struct bounds all = bounds_empty();
  for (int side = 0; side < 2; side++) {
    if (!bvh->moving || bvh->moving[child.first] & 1 << side)
      node_set(node, side, node->child[side], child_refit(bvh, node->child[side]));
    bounds_add(&all, node_bounds(node, side));
  }
  return all;
}

void bvh_refit(struct bvh *bvh) { child_refit(bvh, bvh->root); }
