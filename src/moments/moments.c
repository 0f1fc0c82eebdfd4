#include "moments/moments.h"

#include <assert.h>
#include <string.h>

// a before b: the result depends on the order in its last bits.
struct moments moments_merge(struct moments a, struct moments b) {
  if (a.n == 0) return b;
  if (b.n == 0) return a;
  double n = a.n + b.n, delta = b.mean - a.mean, step = delta / n;
  double ab = a.n * b.n, between = delta * step * ab; // delta^2 a b / n
  return (struct moments){
      .n = n,
      .mean = a.mean + step * b.n,
      .m2 = a.m2 + b.m2 + between,
      .m3 = a.m3 + b.m3 + between * step * (a.n - b.n) + 3 * step * (a.n * b.m2 - b.n * a.m2),
      .m4 = a.m4 + b.m4 + between * step * step * (a.n * a.n - ab + b.n * b.n) +
            6 * step * step * (a.n * a.n * b.m2 + b.n * b.n * a.m2) +
            4 * step * (a.n * b.m3 - b.n * a.m3),
  };
}

static void merge_rows(const struct moments *a, const struct moments *b, struct moments *out,
                       long width) {
  for (long j = 0; j < width; j++) out[j] = moments_merge(a[j], b[j]);
}

struct moments_tree moments_tree_new(long width, struct arena *arena) {
  return (struct moments_tree){.width = width,
                               .level = arena_new(arena, struct moments *, MOMENTS_LEVELS)};
}

static struct moments *level_row(struct moments_tree *tree, int level, struct arena *arena) {
  assert(level < MOMENTS_LEVELS);
  if (level == tree->levels)
    tree->level[tree->levels++] = arena_new(arena, struct moments, tree->width);
  return tree->level[level];
}

// As a binary counter is incremented: the carry is the subtree that grows. It lives in `leaf`,
// which is used up.
void moments_tree_push(struct moments_tree *tree, struct moments *leaf, struct arena *arena) {
  int level = 0;
  for (; tree->count >> level & 1; level++) merge_rows(tree->level[level], leaf, leaf, tree->width);
  memcpy(level_row(tree, level, arena), leaf, (size_t)tree->width * sizeof *leaf);
  tree->count++;
}

void moments_tree_root(const struct moments_tree *tree, struct moments *out) {
  memset(out, 0, (size_t)tree->width * sizeof *out);
  for (int level = 0; level < tree->levels; level++)
    if (tree->count >> level & 1) merge_rows(tree->level[level], out, out, tree->width);
}
