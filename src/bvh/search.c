// One ray after the other, in double. Exactness is argued in scene/shape/clip.h: a box is skipped
// only if its clip is empty or begins beyond the best t.
#include "bvh/search.h"

struct waiting {
  uint32_t child;
  double t0; // where the clip of its box begins
};

struct stack {
  struct waiting item[BVH_MOST_WAITING];
  int n;
};

static bool search_blocks(const struct bvh *bvh, struct search *s, enum search_kind kind,
                          const struct cone *cone, const struct shear *shear, uint32_t row) {
  const struct bvh_block *block = &bvh->block[row];
  for (bool more = true; more; more = block++->more)
    for (int lane = 0; lane < BVH_BLOCK; lane++) {
      float vertex[3][3];
      for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) vertex[i][k] = block->vertex[i][k][lane];
      if (!triangle_accepts(shear, (const float(*)[3])vertex)) continue;
      double t = triangle_plane(s->ray, (const float(*)[3])vertex);
      if (search_triangle(bvh, s, kind, cone, block, lane, t)) return true;
    }
  return false;
}

static bool search_others(const struct bvh *bvh, struct search *s, enum search_kind kind,
                          const struct cone *cone, uint32_t row) {
  const struct bvh_other *other = &bvh->other[row];
  for (bool more = true; more; more = other++->more)
    if (search_other(bvh, s, kind, cone, other)) return true;
  return false;
}

// The children whose clip is not empty, the nearest on top.
static void push_children(const struct bvh_node *node, const struct cone *cone, double limit,
                          struct stack *stack) {
  int first = stack->n;
  for (int slot = 0; slot < BVH_WIDTH; slot++) {
    struct box box;
    for (int k = 0; k < 3; k++)
      box.lo[k] = node->face[k][0][slot], box.hi[k] = node->face[k][1][slot];
    double t0, t1;
    if (!cone_clip(cone, &box, &t0, &t1) || t0 > limit) continue;
    int at = stack->n++;
    for (; at > first && stack->item[at - 1].t0 < t0; at--) stack->item[at] = stack->item[at - 1];
    stack->item[at] = (struct waiting){node->child[slot], t0};
  }
}

static void walk(const struct bvh *bvh, struct search *s, enum search_kind kind) {
  struct cone cone;
  struct shear shear;
  cone_set(&cone, s->ray);
  shear_set(&shear, s->ray);
  struct stack stack;
  stack.item[0] = (struct waiting){bvh->root, 0};
  stack.n = 1;
  while (stack.n > 0) {
    struct waiting next = stack.item[--stack.n];
    if (next.t0 > s->best.t) continue;
    uint32_t row = bvh_row_of(next.child);
    bool over = false;
    switch (bvh_kind_of(next.child)) {
    case BVH_NODE:
      push_children(&bvh->node[row], &cone, s->best.t, &stack);
      break;
    case BVH_TRIANGLES:
      over = search_blocks(bvh, s, kind, &cone, &shear, row);
      break;
    case BVH_OTHERS:
      over = search_others(bvh, s, kind, &cone, row);
      break;
    case BVH_NOTHING:
      break;
    }
    if (over) return;
  }
}

void search_one(const struct bvh *bvh, const struct queries *q, int j, enum search_kind kind) {
  struct search search;
  search_begin(&search, q, j, kind);
  walk(bvh, &search, kind);
  search_end(&search, q, j, kind);
}
