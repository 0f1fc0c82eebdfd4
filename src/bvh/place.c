// The parts of a tree move to where they stay, one after the other in the order of the tree.
#include "bvh/build.h"

struct places {
  uint32_t n_nodes, n_blocks, n_others, depth;
  struct {
    struct part **item;
    ptrdiff_t count, capacity;
  } whole;
};

static void find_places(struct part *part, struct places *places, struct arena *scratch) {
  part->at_node = places->n_nodes;
  part->at_block = places->n_blocks;
  part->at_other = places->n_others;
  if (part->half[0]) {
    places->n_nodes++;
    for (int side = 0; side < 2; side++) find_places(part->half[side], places, scratch);
    return;
  }
  places->n_nodes += part->n_nodes;
  places->n_blocks += part->n_blocks;
  places->n_others += part->n_others;
  *arena_push(scratch, &places->whole) = part;
}

// Pre-order sums: the same for any number of threads.
static void add_statistics(const struct part *part, struct bvh_statistics *sum) {
  const struct bvh_statistics *s = &part->statistics;
  sum->leaves += s->leaves;
  sum->depth = s->depth > sum->depth ? s->depth : sum->depth;
  sum->sah_cost += s->sah_cost;
  for (int side = 0; side < 2 && part->half[0]; side++) add_statistics(part->half[side], sum);
}

// A child of a whole part, in rows of the tree.
static struct bvh_child placed(const struct part *part, struct bvh_child child) {
  if (child.kind == BVH_NODE) child.first += part->at_node;
  if (child.kind == BVH_OTHERS) child.first += part->at_other;
  if (child.kind == BVH_TRIANGLES) {
    child.first += part->at_block;
    child.count = blocks_of(child.count) & BVH_MAX_COUNT;
  }
  return child;
}

static struct bvh_child part_child(const struct part *part) {
  if (part->half[0]) return (struct bvh_child){.first = part->at_node, .kind = BVH_NODE};
  return placed(part, part->root);
}

static void place_divided(struct bvh *bvh, const struct part *part) {
  if (!part->half[0]) return;
  for (int side = 0; side < 2; side++) {
    const struct part *half = part->half[side];
    node_set(&bvh->node[part->at_node], side, part_child(half), half->box);
    place_divided(bvh, half);
  }
}

// ---- a whole part ----
static void fill_leaf(struct bvh *bvh, struct bvh_child leaf, const uint32_t *primitive,
                      uint32_t count) {
  for (uint32_t i = 0; i < count && leaf.kind == BVH_OTHERS; i++)
    bvh_other_set(bvh->scene, &bvh->other[leaf.first + i], primitive[i]);
  for (uint32_t i = 0; i < count && leaf.kind == BVH_TRIANGLES; i += LANES)
    bvh_block_set(bvh->scene, &bvh->block[leaf.first + i / LANES], primitive + i, count - i);
}

// Leaves come in the order of the primitives: `next` is the first of those that are left.
static const uint32_t *place_child(struct bvh *bvh, const struct part *part, struct bvh_child child,
                                   const uint32_t *next) {
  struct bvh_child at = placed(part, child);
  if (child.kind != BVH_NODE) {
    fill_leaf(bvh, at, next, child.count);
    return next + child.count;
  }
  struct bvh_node *node = &bvh->node[at.first];
  *node = part->node[child.first];
  for (int side = 0; side < 2; side++) {
    next = place_child(bvh, part, node->child[side], next);
    node->child[side] = placed(part, node->child[side]);
  }
  return next;
}

void part_place_all(struct bvh *bvh, struct part *root, const uint32_t *order, struct arena *arena,
                    int threads, struct arena scratch) {
  struct places places = {0};
  find_places(root, &places, &scratch);
  bvh_allocate(bvh, places.n_nodes, places.n_blocks, places.n_others, arena);
  place_divided(bvh, root);
  bvh->root = part_child(root);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (places.whole.count > 1)
  for (ptrdiff_t k = 0; k < places.whole.count; k++) {
    const struct part *part = places.whole.item[k];
    place_child(bvh, part, part->root, order + part->first);
  }
  struct bvh_statistics *s = &bvh->statistics;
  add_statistics(root, s);
  s->nodes = bvh->n_nodes;
  double bytes = (double)bvh->n_nodes * sizeof *bvh->node +
                 (double)bvh->n_blocks * sizeof *bvh->block +
                 (double)bvh->n_others * sizeof *bvh->other;
  if (bvh->scene->n_primitives == 0) return;
  s->sah_cost /= bounds_area(root->box);
  s->bytes_per_primitive = bytes / bvh->scene->n_primitives;
}
