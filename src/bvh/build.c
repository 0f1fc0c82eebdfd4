// Binned SAH (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies").
// Cost of a split, in triangle tests: NODE_COST + (area_left n_left + area_right n_right) / area,
// where NODE_COST is the work of testing two boxes. A range that may be a leaf becomes one if
// testing its n primitives is not dearer. Deterministic: one thread, sums in a fixed order, the
// first of equal splits (lowest axis and bin).
#include "bvh/tree.h"

#include "scene/shape/triangle.h"

#include <assert.h>
#include <string.h>

enum {
  N_BINS = 32,
  LEAF_SIZE = 4,
  FLAT_SIZE = 8, // so few primitives are one leaf: no tree
};
static const double NODE_COST = 1.0;

struct build {
  const struct scene *scene;
  struct bvh *bvh;
  struct arena *scratch;
  const struct box *box; // by primitive
  uint32_t *order;       // primitives; a range of it is a subtree
  uint32_t leaf_size;
  struct {
    struct bvh_node *item;
    ptrdiff_t count, capacity;
  } nodes;
};

struct range {
  uint32_t first, count, depth;
  struct box box;
};

struct split {
  double cost; // of the children, in triangle tests times area; INFINITY: there is none
  int axis, bin;
  double origin, scale; // bin of a centroid: (centroid - origin) * scale
};

static const struct box EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(struct box *a, const struct box *b) {
  for (int k = 0; k < 3; k++) {
    a->lo[k] = b->lo[k] < a->lo[k] ? b->lo[k] : a->lo[k];
    a->hi[k] = b->hi[k] > a->hi[k] ? b->hi[k] : a->hi[k];
  }
}

// Half the surface.
static double box_area(const struct box *box) {
  double side[3];
  for (int k = 0; k < 3; k++) side[k] = (double)box->hi[k] - (double)box->lo[k];
  return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

static struct box range_box(const struct build *b, uint32_t first, uint32_t count) {
  struct box box = EMPTY;
  for (uint32_t i = first; i < first + count; i++) box_add(&box, &b->box[b->order[i]]);
  return box;
}

// Twice the centre.
static double centroid(const struct build *b, uint32_t primitive, int axis) {
  return (double)b->box[primitive].lo[axis] + (double)b->box[primitive].hi[axis];
}

static int bin_of(const struct build *b, const struct split *split, uint32_t primitive) {
  int bin = (int)((centroid(b, primitive, split->axis) - split->origin) * split->scale);
  return bin < N_BINS ? bin : N_BINS - 1;
}

struct bins {
  struct box box[N_BINS];
  uint32_t count[N_BINS];
};

static void bins_fill(const struct build *b, const struct range *range, const struct split *split,
                      struct bins *bins) {
  for (int i = 0; i < N_BINS; i++) bins->box[i] = EMPTY, bins->count[i] = 0;
  for (uint32_t i = range->first; i < range->first + range->count; i++) {
    int bin = bin_of(b, split, b->order[i]);
    box_add(&bins->box[bin], &b->box[b->order[i]]);
    bins->count[bin]++;
  }
}

// The cheapest of the N_BINS - 1 planes between bins: split->bin is the first bin of the right
// side.
static void bins_best(const struct bins *bins, struct split *split) {
  double left_cost[N_BINS];
  struct box box = EMPTY;
  uint32_t count = 0;
  for (int i = 0; i < N_BINS - 1; i++) {
    if (bins->count[i]) box_add(&box, &bins->box[i]);
    count += bins->count[i];
    left_cost[i + 1] = count ? box_area(&box) * count : INFINITY;
  }
  box = EMPTY, count = 0;
  for (int i = N_BINS - 1; i > 0; i--) {
    if (bins->count[i]) box_add(&box, &bins->box[i]);
    count += bins->count[i];
    double cost = count ? left_cost[i] + box_area(&box) * count : INFINITY;
    if (cost <= split->cost) split->cost = cost, split->bin = i;
  }
}

static struct split split_axis(const struct build *b, const struct range *range, int axis) {
  double lo = INFINITY, hi = -INFINITY;
  for (uint32_t i = range->first; i < range->first + range->count; i++) {
    double c = centroid(b, b->order[i], axis);
    lo = c < lo ? c : lo;
    hi = c > hi ? c : hi;
  }
  struct split split = {.cost = INFINITY, .axis = axis, .origin = lo, .scale = N_BINS / (hi - lo)};
  if (!(hi > lo)) return split;
  struct bins bins;
  bins_fill(b, range, &split, &bins);
  bins_best(&bins, &split);
  return split;
}

static struct split split_best(const struct build *b, const struct range *range) {
  struct split best = {.cost = INFINITY};
  for (int axis = 0; axis < 3; axis++) {
    struct split split = split_axis(b, range, axis);
    if (split.cost < best.cost) best = split;
  }
  return best;
}

// Moves the left side to the front; its size.
static uint32_t partition(struct build *b, const struct range *range, const struct split *split) {
  uint32_t *order = b->order + range->first, left = 0;
  for (uint32_t i = 0; i < range->count; i++) {
    uint32_t primitive = order[i];
    if (bin_of(b, split, primitive) >= split->bin) continue;
    order[i] = order[left];
    order[left++] = primitive;
  }
  return left;
}

static bool is_triangle(const struct scene *scene, uint32_t primitive) {
  return scene->shape[scene->shape_of[primitive]].type->intersect == triangle_intersect;
}

static struct bvh_child leaf_new(struct build *b, const struct range *range) {
  struct bvh_child leaf = {range->first, range->count, BVH_TRIANGLES};
  for (uint32_t i = range->first; i < range->first + range->count; i++) {
    struct bvh_item *item = &b->bvh->item[i];
    item->primitive = b->order[i];
    const struct shape *shape = &b->scene->shape[b->scene->shape_of[item->primitive]];
    if (is_triangle(b->scene, item->primitive))
      triangle_gather(b->scene, shape, item->primitive, item->vertex);
    else
      leaf.kind = BVH_MIXED;
  }
  struct bvh_statistics *s = &b->bvh->statistics;
  s->leaves++;
  s->depth = range->depth > s->depth ? range->depth : s->depth;
  if (range->count) s->sah_cost += box_area(&range->box) * range->count;
  return leaf;
}

static void node_set(struct bvh_node *node, int side, struct bvh_child child,
                     const struct box *box) {
  node->child[side] = child;
  for (int k = 0; k < 3; k++) {
    node->face[0][k][side] = box->lo[k];
    node->face[1][k][side] = box->hi[k];
  }
}

// How many of the range go left; 0: the range is a leaf.
static uint32_t range_divide(struct build *b, const struct range *range) {
  bool may_be_leaf = range->count <= b->leaf_size;
  if (range->count == 1) return 0;
  if (range->depth >= BVH_SAH_DEPTH) return may_be_leaf ? 0 : range->count / 2;
  struct split split = split_best(b, range);
  double area = box_area(&range->box);
  if (may_be_leaf && !(NODE_COST * area + split.cost < area * range->count)) return 0;
  if (!(split.cost < INFINITY)) return range->count / 2; // one centre, or no finite area
  return partition(b, range, &split);
}

static struct bvh_child range_build(struct build *b, const struct range *range) {
  uint32_t left = range_divide(b, range);
  if (left == 0) return leaf_new(b, range);
  uint32_t number = (uint32_t)b->nodes.count;
  (void)arena_push(b->scratch, &b->nodes);
  b->bvh->statistics.sah_cost += box_area(&range->box) * NODE_COST;
  const uint32_t start[3] = {range->first, range->first + left, range->first + range->count};
  for (int side = 0; side < 2; side++) {
    struct range half = {
        .first = start[side], .count = start[side + 1] - start[side], .depth = range->depth + 1};
    half.box = range_box(b, half.first, half.count);
    struct bvh_child child = range_build(b, &half);
    node_set(&b->nodes.item[number], side, child, &half.box);
  }
  return (struct bvh_child){.first = number, .kind = BVH_NODE};
}

static void build_root(struct build *b) {
  uint32_t n = b->scene->n_primitives;
  struct range all = {.count = n, .box = range_box(b, 0, n)};
  bool flat = n == 0 || n <= (b->leaf_size ? b->leaf_size : FLAT_SIZE);
  if (b->leaf_size == 0) b->leaf_size = LEAF_SIZE;
  b->bvh->root = flat ? leaf_new(b, &all) : range_build(b, &all);
  if (n) b->bvh->statistics.sah_cost /= box_area(&all.box);
}

static void build_inputs(struct build *b) {
  uint32_t n = b->scene->n_primitives;
  struct box *box = arena_new(b->scratch, struct box, n);
  b->order = arena_new(b->scratch, uint32_t, n);
  for (uint32_t p = 0; p < n; p++) {
    const struct shape *shape = &b->scene->shape[b->scene->shape_of[p]];
    box[p] = shape->type->bounds(b->scene, shape, p);
    b->order[p] = p;
  }
  b->box = box;
}

struct bvh *bvh_build(const struct scene *scene, struct bvh_options options, struct arena *arena) {
  assert(options.leaf_size >= 0);
  struct arena reserve = arena_reserve(), scratch = reserve;
  struct bvh *bvh = arena_new(arena, struct bvh, 1);
  bvh->scene = scene;
  bvh->item = arena_new(arena, struct bvh_item, scene->n_primitives);
  struct build b = {
      .scene = scene, .bvh = bvh, .scratch = &scratch, .leaf_size = (uint32_t)options.leaf_size};
  build_inputs(&b);
  build_root(&b);
  bvh->node = arena_new(arena, struct bvh_node, b.nodes.count);
  if (b.nodes.count) memcpy(bvh->node, b.nodes.item, (size_t)b.nodes.count * sizeof *b.nodes.item);
  bvh->statistics.nodes = (uint32_t)b.nodes.count;
  if (scene->n_primitives)
    bvh->statistics.bytes_per_primitive =
        (double)sizeof(struct bvh_item) +
        (double)b.nodes.count * (double)sizeof(struct bvh_node) / scene->n_primitives;
  arena_release(reserve);
  return bvh;
}

struct bvh_statistics bvh_statistics(const struct bvh *bvh) {
  return bvh->statistics;
}
