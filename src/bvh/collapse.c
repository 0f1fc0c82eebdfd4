// From the binary tree to the wide one, optimally by SAH (Ylitie, Karras, Laine 2017, "Efficient
// Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.1). C(n, j) is the
// least cost of the primitives under n as at most j children of a wide node:
//   C(n, 1) = min(A(n) blocks(n), A(n) NODE_COST + D(n, 8))      a leaf, or a node of its own
//   C(n, j) = min(D(n, j), C(n, j - 1))                          j > 1
//   D(n, j) = min over 0 < k < j of C(left, k) + C(right, j - k)
// A the area, and the unit the test of a block of triangles.
#include "bvh/build.h"

#include <assert.h>

// Measured on one core: 0.3 to 1.5 differ by less than 10 %.
static const double NODE_COST = 1;

// ---- what is chosen ----
static double divided_cost(const struct binary *n, int j, int *left) {
  double least = INFINITY;
  for (int k = 1; k < j; k++) {
    double cost = n->half[0]->cost[k] + n->half[1]->cost[j - k];
    if (cost < least) least = cost, *left = k;
  }
  return least;
}

void binary_choose(struct binary *n, uint32_t leaf_size) {
  double area = bounds_area(n->box);
  double as_leaf = n->kind != BVH_NODE && (n->count <= leaf_size || !n->half[0])
                       ? area * bvh_blocks_of(n->count)
                       : INFINITY;
  n->is_leaf = true;
  n->cost[1] = as_leaf;
  if (n->half[0]) {
    int left = 1;
    double as_node = area * NODE_COST + divided_cost(n, BVH_WIDTH, &left);
    n->left[1] = (unsigned char)left;
    n->is_leaf = as_leaf <= as_node;
    n->cost[1] = n->is_leaf ? as_leaf : as_node;
  }
  for (int j = 2; j <= BVH_WIDTH; j++) {
    int left = 0;
    double cost = n->half[0] ? divided_cost(n, j, &left) : INFINITY;
    bool pays = cost < n->cost[j - 1];
    n->cost[j] = pays ? cost : n->cost[j - 1];
    n->left[j] = (unsigned char)(pays ? left : 0);
  }
}

// ---- the wide tree ----
struct children {
  const struct binary *item[BVH_WIDTH];
  int count;
};

static void add_children(const struct binary *n, int j, struct children *children) {
  while (j > 1 && n->left[j] == 0) j--;
  if (j == 1) {
    children->item[children->count++] = n;
    return;
  }
  add_children(n->half[0], n->left[j], children);
  add_children(n->half[1], j - n->left[j], children);
}

static struct children children_of(const struct binary *n) {
  struct children children = {.count = 0};
  add_children(n->half[0], n->left[1], &children);
  add_children(n->half[1], BVH_WIDTH - n->left[1], &children);
  return children;
}

struct leaf {
  uint32_t child, first, count;
};

struct collapse {
  struct bvh *bvh;
  uint32_t nodes, blocks, others; // so far
  struct leaf *leaf;
  uint32_t n_leaves;
};

static void count_rows(const struct binary *n, struct collapse *c) {
  if (n->is_leaf) {
    c->n_leaves++;
    c->blocks += n->kind == BVH_TRIANGLES ? bvh_blocks_of(n->count) : 0;
    c->others += n->kind == BVH_OTHERS ? n->count : 0;
    return;
  }
  c->nodes++;
  struct children children = children_of(n);
  for (int slot = 0; slot < children.count; slot++) count_rows(children.item[slot], c);
}

static uint32_t leaf_place(struct collapse *c, const struct binary *n) {
  uint32_t *row = n->kind == BVH_TRIANGLES ? &c->blocks : &c->others;
  uint32_t child = bvh_child(n->kind, *row);
  *row += n->kind == BVH_TRIANGLES ? bvh_blocks_of(n->count) : n->count;
  c->leaf[c->n_leaves++] = (struct leaf){child, n->first, n->count};
  c->bvh->statistics.leaves++;
  c->bvh->statistics.sah_cost += n->cost[1];
  return child;
}

// How far a child's box begins in the direction of an octant.
static double begins(const struct bvh_node *node, int slot, int octant) {
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    bool backward = octant >> k & 1;
    double lo = (double)node->face[k][0][slot], hi = (double)node->face[k][1][slot];
    sum += backward ? -(lo + hi) : lo + hi;
  }
  return sum;
}

// Far to near, of equals the later slot first; then the empty slots.
static uint32_t order_of(const struct bvh_node *node, int count, int octant) {
  int slot[BVH_WIDTH];
  double at[BVH_WIDTH];
  for (int i = 0; i < BVH_WIDTH; i++) {
    double x = i < count ? begins(node, i, octant) : -INFINITY;
    int j = i;
    for (; j > 0 && at[j - 1] <= x; j--) at[j] = at[j - 1], slot[j] = slot[j - 1];
    at[j] = x, slot[j] = i;
  }
  uint32_t order = 0;
  for (int i = 0; i < BVH_WIDTH; i++) order |= (uint32_t)slot[i] << 3 * i;
  return order;
}

static void node_fill(struct bvh_node *node, const struct children *children) {
  const struct bounds nothing = bounds_empty();
  for (int slot = 0; slot < BVH_WIDTH; slot++) {
    node->child[slot] = bvh_child(BVH_NOTHING, 0);
    node_set_box(node, slot, slot < children->count ? children->item[slot]->box : nothing);
  }
  for (int octant = 0; octant < BVH_OCTANTS; octant++)
    node->order[octant] = order_of(node, children->count, octant);
}

// Nodes and leaves of one parent lie side by side.
static void node_place(struct collapse *c, const struct binary *n, uint32_t row, uint32_t depth) {
  struct bvh_node *node = &c->bvh->node[row];
  struct children children = children_of(n);
  struct bvh_statistics *s = &c->bvh->statistics;
  s->sah_cost += bounds_area(n->box) * NODE_COST;
  s->depth = depth + 1 > s->depth ? depth + 1 : s->depth;
  node_fill(node, &children);
  for (int slot = 0; slot < children.count; slot++) {
    const struct binary *child = children.item[slot];
    node->child[slot] = child->is_leaf ? leaf_place(c, child) : bvh_child(BVH_NODE, c->nodes++);
  }
  for (int slot = 0; slot < children.count; slot++)
    if (!children.item[slot]->is_leaf)
      node_place(c, children.item[slot], bvh_row_of(node->child[slot]), depth + 1);
}

static void fill_leaves(const struct collapse *c, const uint32_t *order, int threads) {
#pragma omp parallel for schedule(dynamic, 1024) num_threads(threads) if (c->n_leaves > 4096)
  for (uint32_t k = 0; k < c->n_leaves; k++) {
    const struct leaf *leaf = &c->leaf[k];
    bvh_leaf_set(c->bvh, leaf->child, order + leaf->first, leaf->count);
  }
}

static void finish_statistics(struct bvh *bvh) {
  struct bvh_statistics *s = &bvh->statistics;
  s->nodes = bvh->n_nodes;
  if (bvh->scene->n_primitives == 0) return;
  double bytes = (double)bvh->n_nodes * sizeof *bvh->node +
                 (double)bvh->n_blocks * sizeof *bvh->block +
                 (double)bvh->n_others * sizeof *bvh->other +
                 (double)bvh->scene->n_primitives * sizeof *bvh->lane;
  double area = bounds_area(bounds_of_box(&bvh->box));
  s->sah_cost = area > 0 ? s->sah_cost / area : 0;
  s->bytes_per_primitive = bytes / bvh->scene->n_primitives;
}

void binary_collapse(const struct binary *root, const uint32_t *order, struct bvh *bvh,
                     struct arena *arena, int threads, struct arena scratch) {
  struct collapse c = {.bvh = bvh};
  count_rows(root, &c);
  assert(c.nodes < BVH_MAX_ROWS && c.blocks < BVH_MAX_ROWS && c.others < BVH_MAX_ROWS);
  assert((uint64_t)c.blocks * BVH_BLOCK < ROW_NONE); // bvh->lane
  bvh_allocate(bvh, c.nodes, c.blocks, c.others, arena);
  bvh->lane = arena_new(arena, uint32_t, bvh->scene->n_primitives);
  bvh->box = bounds_box(root->box);
  c = (struct collapse){.bvh = bvh, .leaf = arena_new(&scratch, struct leaf, c.n_leaves)};
  if (root->count == 0) {
    bvh->root = bvh_child(BVH_NOTHING, 0);
  } else if (root->is_leaf) {
    bvh->root = leaf_place(&c, root);
  } else {
    bvh->root = bvh_child(BVH_NODE, c.nodes++);
    node_place(&c, root, 0, 0);
  }
  fill_leaves(&c, order, threads);
  finish_statistics(bvh);
}
