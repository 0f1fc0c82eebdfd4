// The tree over a scene's primitives, by binned SAH (split.c) on all threads.
// A node, two boxes, costs NODE_COST, so a split costs NODE_COST + (area_left blocks_left +
// area_right blocks_right) / area. A range that may be a leaf becomes one if that is not dearer.
// Large ranges are divided by all threads in chunks that are merged in order; what is left of them
// are parts that one thread builds alone. Both sizes are constants, so the tree does not depend on
// the number of threads.
#include "bvh/build.h"

#include "base/threads.h"
#include "scene/shape/triangle.h"
#include "scene/skip.h"

#include <assert.h>
#include <omp.h>

// Measured on one core, rays per second: leaves of 2 to 8 and NODE_COST 0.5 to 1 differ by less
// than 10 %.
enum { LEAF_SIZE = 4 };
static const double NODE_COST = 0.5;

// Primitives. A part's refs stay in the second-level cache.
enum { PART_SIZE = 1 << 14, NODES_AT_ONCE = 256 };

struct build {
  const struct scene *scene;
  uint32_t leaf_size, part_size;
  int n_threads;
  bool flat, large;       // no tree; in several parts
  struct bvh_ref *ref[2]; // the second only if large
  uint32_t *order;        // primitives, filled part by part
  struct arena *own;      // [n_threads]
};

// Of the calling thread.
static struct arena *own_arena(const struct build *b) {
  return &b->own[b->large ? omp_get_thread_num() : 0];
}

static struct bvh_ref *range_refs(const struct build *b, const struct range *range) {
  return b->ref[range->array] + range->first;
}

static struct extent extent_of(const struct bvh_ref *ref, uint32_t count) {
  struct extent extent = extent_empty();
  for (uint32_t i = 0; i < count; i++) extent_add_ref(&extent, &ref[i]);
  return extent;
}

static bool splits_pay(const struct range *range, const struct split *split) {
  double area = bounds_area(range->extent.box);
  return NODE_COST * area + split->cost < area * blocks_of(range->count);
}

// ---- a range on one thread ----
// Moves the left side to the front; its size, and what each side covers.
static uint32_t partition(struct bvh_ref *ref, uint32_t count, const struct binning *binning,
                          const struct split *split, struct extent extent[2]) {
  uint32_t left = 0;
  extent[0] = extent[1] = extent_empty();
  for (uint32_t i = 0; i < count; i++) {
    struct bvh_ref moved = ref[i];
    bool is_left = split_is_left(binning, split, &moved);
    extent_add_ref(&extent[is_left ? 0 : 1], &moved);
    if (!is_left) continue;
    ref[i] = ref[left];
    ref[left++] = moved;
  }
  return left;
}

// Moves the triangles to the front; their number.
static uint32_t partition_triangles(struct bvh_ref *ref, uint32_t count) {
  uint32_t left = 0;
  for (uint32_t i = 0; i < count; i++) {
    struct bvh_ref moved = ref[i];
    if (!ref_is_triangle(&moved)) continue;
    ref[i] = ref[left];
    ref[left++] = moved;
  }
  return left;
}

// The size of the first half, or 0: a leaf, which has one kind of primitive.
static uint32_t divide(const struct build *b, const struct range *range, struct extent extent[2]) {
  struct bvh_ref *ref = range_refs(b, range);
  uint32_t count = range->count, left;
  if (count <= 1) return 0;
  struct split split = {.cost = INFINITY};
  struct binning binning = {0};
  if (!b->flat && range->depth < BVH_SAH_DEPTH) {
    struct bins bins;
    binning = split_binning(&range->extent.centers, count);
    split_fill(&binning, ref, count, &bins);
    split = split_best(&binning, &bins);
  }
  bool may_be_leaf = b->flat || count <= b->leaf_size;
  if (may_be_leaf && (b->flat || !splits_pay(range, &split)))
    left = partition_triangles(ref, count) % count;
  else if (split.cost < INFINITY)
    return partition(ref, count, &binning, &split, extent);
  else
    left = count / 2; // all centres are one, or deep enough
  extent[0] = extent_of(ref, left);
  extent[1] = extent_of(ref + left, count - left);
  return left;
}

static void halves_of(const struct range *range, uint32_t left, int array,
                      const struct extent extent[2], struct range half[2]) {
  uint32_t depth = range->depth + 1, middle = range->first + left;
  half[0] = (struct range){range->first, left, depth, array, extent[0]};
  half[1] = (struct range){middle, range->count - left, depth, array, extent[1]};
}

static struct bvh_child child_new(uint32_t first, uint32_t count, enum bvh_kind kind) {
  assert(count <= BVH_MAX_COUNT);
  return (struct bvh_child){first, count & BVH_MAX_COUNT, kind};
}

static struct bvh_child leaf_new(const struct build *b, struct part *part,
                                 const struct range *range) {
  struct bvh_statistics *s = &part->statistics;
  uint32_t count = range->count;
  s->leaves++;
  s->depth = range->depth > s->depth ? range->depth : s->depth;
  if (count) s->sah_cost += bounds_area(range->extent.box) * blocks_of(count);
  if (count && !ref_is_triangle(range_refs(b, range))) {
    part->n_others += count;
    return child_new(part->n_others - count, count, BVH_OTHERS);
  }
  part->n_blocks += blocks_of(count);
  return child_new(part->n_blocks - blocks_of(count), count, BVH_TRIANGLES);
}

// One more node, where the others are: nothing else is taken from the arena meanwhile.
static uint32_t node_new(struct part *part, struct arena *arena) {
  if (part->n_nodes % NODES_AT_ONCE == 0)
    part->node = arena_grow(arena, part->node, part->n_nodes, part->n_nodes + NODES_AT_ONCE,
                            sizeof *part->node, alignof(struct bvh_node));
  return part->n_nodes++;
}

static struct bvh_child range_build(const struct build *b, struct part *part, struct arena *arena,
                                    const struct range *range) {
  struct extent extent[2];
  struct range half[2];
  uint32_t left = divide(b, range, extent);
  if (left == 0) return leaf_new(b, part, range);
  halves_of(range, left, range->array, extent, half);
  uint32_t number = node_new(part, arena);
  part->statistics.sah_cost += bounds_area(range->extent.box) * NODE_COST;
  for (int side = 0; side < 2; side++) {
    struct bvh_child child = range_build(b, part, arena, &half[side]);
    node_set(&part->node[number], side, child, half[side].extent.box);
  }
  return child_new(number, 0, BVH_NODE);
}

static void part_build_whole(const struct build *b, struct part *part, const struct range *range) {
  part->first = range->first;
  part->root = range_build(b, part, own_arena(b), range);
  const struct bvh_ref *ref = range_refs(b, range);
  for (uint32_t i = 0; i < range->count; i++) b->order[range->first + i] = ref_primitive(&ref[i]);
}

// ---- a large range on all threads ----
struct chunk {
  uint32_t first, count; // of the range
  uint32_t to[2];        // where its left and right go, from the start of the range
  struct bins bins;
  struct extent extent[2]; // of its left and right
};

static uint32_t chunks_of(const struct build *b, uint32_t count) {
  return count / b->part_size + (count % b->part_size != 0);
}

static struct chunk *chunks_new(const struct build *b, uint32_t count, struct arena *arena) {
  uint32_t n = chunks_of(b, count);
  struct chunk *chunk = arena_new(arena, struct chunk, n);
  for (uint32_t c = 0; c < n; c++) {
    chunk[c].first = c * b->part_size;
    chunk[c].count = c + 1 < n ? b->part_size : count - chunk[c].first;
  }
  return chunk;
}

static struct split large_split(const struct build *b, const struct range *range,
                                const struct binning *binning, struct chunk *chunk) {
  const struct bvh_ref *ref = range_refs(b, range);
  uint32_t n = chunks_of(b, range->count);
#pragma omp taskloop grainsize(1)
  for (uint64_t c = 0; c < n; c++)
    split_fill(binning, ref + chunk[c].first, chunk[c].count, &chunk[c].bins);
  struct bins all = chunk[0].bins;
  for (uint32_t c = 1; c < n; c++) split_merge(binning, &all, &chunk[c].bins);
  return split_best(binning, &all);
}

// Where each chunk's two sides go; the size of the left one. Without a split the first half.
static uint32_t large_offsets(const struct range *range, const struct split *split,
                              struct chunk *chunk, uint32_t n) {
  uint32_t left = 0, half = range->count / 2;
  for (uint32_t c = 0; c < n; c++) {
    uint32_t before_half = half > chunk[c].first ? half - chunk[c].first : 0;
    chunk[c].to[0] = left;
    chunk[c].to[1] = chunk[c].first - left;
    if (split->cost < INFINITY)
      left += split_count_left(&chunk[c].bins, split);
    else
      left += before_half < chunk[c].count ? before_half : chunk[c].count;
  }
  for (uint32_t c = 0; c < n; c++) chunk[c].to[1] += left;
  return left;
}

static void chunk_partition(const struct binning *binning, const struct split *split, uint32_t left,
                            struct chunk *chunk, const struct bvh_ref *from, struct bvh_ref *to) {
  bool by_bin = split->cost < INFINITY;
  chunk->extent[0] = chunk->extent[1] = extent_empty();
  for (uint32_t i = chunk->first; i < chunk->first + chunk->count; i++) {
    bool is_left = by_bin ? split_is_left(binning, split, &from[i]) : i < left;
    int side = is_left ? 0 : 1;
    extent_add_ref(&chunk->extent[side], &from[i]);
    to[chunk->to[side]++] = from[i];
  }
}

static void large_divide(const struct build *b, const struct range *range, struct range half[2]) {
  uint32_t n = chunks_of(b, range->count);
  struct chunk *chunk = chunks_new(b, range->count, own_arena(b));
  struct binning binning = split_binning(&range->extent.centers, range->count);
  struct split split = {.cost = INFINITY};
  if (range->depth < BVH_SAH_DEPTH) split = large_split(b, range, &binning, chunk);
  uint32_t left = large_offsets(range, &split, chunk, n);
  const struct bvh_ref *from = range_refs(b, range);
  struct bvh_ref *to = b->ref[1 - range->array] + range->first;
#pragma omp taskloop grainsize(1)
  for (uint64_t c = 0; c < n; c++) chunk_partition(&binning, &split, left, &chunk[c], from, to);
  struct extent extent[2] = {extent_empty(), extent_empty()};
  for (uint32_t c = 0; c < n; c++)
    for (int side = 0; side < 2; side++) extent_add(&extent[side], &chunk[c].extent[side]);
  halves_of(range, left, 1 - range->array, extent, half);
}

static struct part *part_build(const struct build *b, struct range range) {
  struct part *part = arena_new(own_arena(b), struct part, 1);
  part->box = range.extent.box;
  if (!b->large || range.count <= b->part_size || range.count <= b->leaf_size) {
    part_build_whole(b, part, &range);
    return part;
  }
  struct range half[2];
  large_divide(b, &range, half);
  part->statistics.sah_cost = bounds_area(part->box) * NODE_COST;
#pragma omp task
  part->half[0] = part_build(b, half[0]);
  part->half[1] = part_build(b, half[1]);
#pragma omp taskwait
  return part;
}

// ---- the whole ----
static struct bvh_ref ref_of(const struct scene *scene, uint32_t primitive) {
  const struct shape *shape = &scene->shape[scene->shape_of[primitive]];
  struct box box = shape->type->bounds(scene, shape, primitive);
  return ref_new(&box, primitive, shape->type->intersect == triangle_intersect);
}

static struct range all_refs(const struct build *b, struct arena *scratch) {
  uint32_t n = b->scene->n_primitives, n_chunks = chunks_of(b, n);
  struct extent *extent = arena_new(scratch, struct extent, n_chunks);
#pragma omp parallel for schedule(dynamic, 1) num_threads(b->n_threads) if (b->large)
  for (uint32_t c = 0; c < n_chunks; c++) {
    uint32_t first = c * b->part_size, count = c + 1 < n_chunks ? b->part_size : n - first;
    for (uint32_t p = first; p < first + count; p++) b->ref[0][p] = ref_of(b->scene, p);
    extent[c] = extent_of(&b->ref[0][first], count);
  }
  struct range all = {.count = n, .extent = extent_empty()};
  for (uint32_t c = 0; c < n_chunks; c++) extent_add(&all.extent, &extent[c]);
  return all;
}

static struct part *all_parts(const struct build *b, struct range all) {
  if (!b->large) return part_build(b, all);
  struct part *root = NULL;
#pragma omp parallel num_threads(b->n_threads)
#pragma omp single
  root = part_build(b, all);
  return root;
}

static struct build build_new(const struct scene *scene, struct bvh_options options) {
  uint32_t n = scene->n_primitives, leaf_size = (uint32_t)options.leaf_size,
           part_size = options.part_size ? (uint32_t)options.part_size : PART_SIZE;
  int threads = options.threads ? options.threads : threads_available();
  return (struct build){.scene = scene,
                        .leaf_size = leaf_size ? leaf_size : LEAF_SIZE,
                        .part_size = part_size,
                        .flat = n <= (leaf_size      ? leaf_size
                                      : options.tree ? 0
                                                     : SKIP_FEW_PRIMITIVES),
                        .large = n > part_size && n > leaf_size,
                        .n_threads = threads};
}

// The parts live in b->own, and the refs are gone when this returns.
static struct part *build_parts(struct build *b) {
  struct arena reserve = arena_reserve(), scratch = reserve;
  for (int k = 0; k < 1 + b->large; k++)
    b->ref[k] = arena_new(&scratch, struct bvh_ref, b->scene->n_primitives);
  struct range all = all_refs(b, &scratch);
  struct part *root = all_parts(b, all);
  arena_release(reserve);
  return root;
}

struct bvh *bvh_build(const struct scene *scene, struct bvh_options options, struct arena *arena) {
  assert(options.leaf_size >= 0 && options.part_size >= 0 && options.threads >= 0);
  struct arena reserve = arena_reserve(), scratch = reserve;
  struct build b = build_new(scene, options);
  int n_own = b.large ? b.n_threads : 1;
  b.order = arena_new(&scratch, uint32_t, scene->n_primitives);
  b.own = arena_new(&scratch, struct arena, n_own);
  struct arena *reserved = arena_new(&scratch, struct arena, n_own);
  for (int k = 0; k < n_own; k++) b.own[k] = reserved[k] = arena_reserve();
  struct part *root = build_parts(&b);
  struct bvh *bvh = arena_new(arena, struct bvh, 1);
  bvh->scene = scene;
  part_place_all(bvh, root, b.order, arena, b.n_threads, scratch);
  for (int k = 0; k < n_own; k++) arena_release(reserved[k]);
  arena_release(reserve);
  return bvh;
}

struct bvh_statistics bvh_statistics(const struct bvh *bvh) {
  return bvh->statistics;
}
