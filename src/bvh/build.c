// The binary tree over a scene's primitives, by binned SAH (split.c) on all threads, down to leaves
// that are not worth dividing: what becomes of its nodes is chosen in collapse.c.
// Large ranges are divided by all threads in chunks that are merged in order; what is left of them
// one thread divides alone. Both sizes are constants, so the tree does not depend on the number of
// threads.
#include "bvh/build.h"

#include "bvh/few.h"

#include "base/threads.h"
#include "scene/shape/triangle.h"
#include "scene/skip.h"

#include <assert.h>
#include <omp.h>

enum { LEAF_SIZE = 4 };

// Primitives. Their refs stay in the second-level cache.
enum { PART_SIZE = 1 << 14 };

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

static enum bvh_kind kind_of(const struct bvh_ref *ref, uint32_t count) {
  uint32_t triangles = 0;
  for (uint32_t i = 0; i < count; i++) triangles += ref_is_triangle(&ref[i]);
  return triangles == count ? BVH_TRIANGLES : triangles == 0 ? BVH_OTHERS : BVH_NODE;
}

// A leaf, as two leaves would cost more even if their node had room for both.
static bool stays_whole(const struct build *b, const struct range *range, enum bvh_kind kind,
                        const struct split *split) {
  double cost = bounds_area(range->extent.box) * bvh_blocks_of(range->count);
  return kind != BVH_NODE && range->count <= b->leaf_size && split->cost >= cost;
}

// The size of the first half; 0: it stays whole.
static uint32_t divide(const struct build *b, const struct range *range, enum bvh_kind kind,
                       struct extent extent[2]) {
  struct bvh_ref *ref = range_refs(b, range);
  uint32_t count = range->count, left = count / 2; // all centres are one, or deep enough
  if (b->flat) {
    left = partition_triangles(ref, count);
  } else if (range->depth < BVH_SAH_DEPTH) {
    struct bins bins;
    struct binning binning = split_binning(&range->extent.centers, count);
    split_fill(&binning, ref, count, &bins);
    struct split split = split_best(&binning, &bins);
    if (stays_whole(b, range, kind, &split)) return 0;
    if (split.cost < INFINITY) return partition(ref, count, &binning, &split, extent);
  }
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

static struct binary *binary_new(const struct build *b, const struct range *range) {
  struct binary *n = arena_new(own_arena(b), struct binary, 1);
  n->box = range->extent.box, n->first = range->first, n->count = range->count;
  return n;
}

static struct binary *range_build(const struct build *b, const struct range *range) {
  struct binary *n = binary_new(b, range);
  struct extent extent[2];
  struct range half[2];
  n->kind = kind_of(range_refs(b, range), range->count);
  bool whole = range->count <= 1 || (b->flat && n->kind != BVH_NODE);
  uint32_t left = whole ? 0 : divide(b, range, n->kind, extent);
  if (left) {
    halves_of(range, left, range->array, extent, half);
    for (int side = 0; side < 2; side++) n->half[side] = range_build(b, &half[side]);
  }
  binary_choose(n, b->leaf_size);
  return n;
}

static struct binary *whole_build(const struct build *b, const struct range *range) {
  struct binary *n = range_build(b, range);
  const struct bvh_ref *ref = range_refs(b, range);
  for (uint32_t i = 0; i < range->count; i++) b->order[range->first + i] = ref_primitive(&ref[i]);
  return n;
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

static struct binary *large_build(const struct build *b, struct range range) {
  if (!b->large || range.count <= b->part_size) return whole_build(b, &range);
  struct binary *n = binary_new(b, &range);
  struct range half[2];
  large_divide(b, &range, half);
#pragma omp task
  n->half[0] = large_build(b, half[0]);
  n->half[1] = large_build(b, half[1]);
#pragma omp taskwait
  bool same = n->half[0]->kind == n->half[1]->kind;
  n->kind = same ? n->half[0]->kind : BVH_NODE;
  binary_choose(n, b->leaf_size);
  return n;
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

static struct binary *all_build(const struct build *b, struct range all) {
  if (!b->large) return large_build(b, all);
  struct binary *root = NULL;
#pragma omp parallel num_threads(b->n_threads)
#pragma omp single
  root = large_build(b, all);
  return root;
}

static uint32_t leaf_size_of(const struct scene *scene, const struct bvh_options *options) {
  if (options->leaf_size) return (uint32_t)options->leaf_size;
  bool few = scene->n_primitives <= SKIP_FEW_PRIMITIVES;
  return few && !options->tree ? SKIP_FEW_PRIMITIVES : LEAF_SIZE;
}

static struct build build_new(const struct scene *scene, struct bvh_options options) {
  uint32_t n = scene->n_primitives, leaf_size = leaf_size_of(scene, &options),
           part_size = options.part_size ? (uint32_t)options.part_size : PART_SIZE;
  return (struct build){.scene = scene,
                        .leaf_size = leaf_size,
                        .part_size = part_size,
                        .flat = n <= leaf_size && !options.tree,
                        .large = n > part_size && n > leaf_size,
                        .n_threads = options.threads ? options.threads : threads_available()};
}

// The binary tree lives in b->own, and the refs are gone when this returns.
static struct binary *build_binary(struct build *b) {
  struct arena reserve = arena_reserve(), scratch = reserve;
  for (int k = 0; k < 1 + b->large; k++)
    b->ref[k] = arena_new(&scratch, struct bvh_ref, b->scene->n_primitives);
  struct range all = all_refs(b, &scratch);
  struct binary *root = all_build(b, all);
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
  const struct binary *root = build_binary(&b);
  struct bvh *bvh = arena_new(arena, struct bvh, 1);
  bvh->scene = scene;
  binary_collapse(root, b.order, bvh, arena, b.n_threads, scratch);
  if (!options.tree && !options.leaf_size) bvh->few = few_new(scene, arena);
  for (int k = 0; k < n_own; k++) arena_release(reserved[k]);
  arena_release(reserve);
  return bvh;
}

struct bvh_statistics bvh_statistics(const struct bvh *bvh) {
  return bvh->statistics;
}
