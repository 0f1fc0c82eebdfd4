#include "density/knn.h"

#include <assert.h>
#include <math.h>

enum { LEAF = 8 }; // items that are not parted further

static double coordinate(struct vec p, uint32_t axis) {
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

// ---- building ----

static bool is_below(const struct knn_item *a, const struct knn_item *b, uint32_t axis) {
  double x = coordinate(a->p, axis), y = coordinate(b->p, axis);
  return x != y ? x < y : a->photon < b->photon;
}

static void swap(struct knn_item *a, struct knn_item *b) {
  struct knn_item kept = *a;
  *a = *b;
  *b = kept;
}

// The axis along which the items extend most.
static uint32_t widest(const struct knn_item *item, int64_t n) {
  uint32_t axis = 0;
  double most = -1;
  for (uint32_t a = 0; a < 3; a++) {
    double lo = INFINITY, hi = -INFINITY;
    for (int64_t j = 0; j < n; j++) {
      double x = coordinate(item[j].p, a);
      lo = x < lo ? x : lo;
      hi = x > hi ? x : hi;
    }
    if (hi - lo > most) most = hi - lo, axis = a;
  }
  return axis;
}

// Puts the median of three at `lo`, to part the others around.
static void choose_pivot(struct knn_item *item, int64_t lo, int64_t hi, uint32_t axis) {
  int64_t middle = lo + (hi - lo) / 2, last = hi - 1;
  if (is_below(&item[middle], &item[lo], axis)) swap(&item[middle], &item[lo]);
  if (is_below(&item[last], &item[lo], axis)) swap(&item[last], &item[lo]);
  if (is_below(&item[last], &item[middle], axis)) swap(&item[last], &item[middle]);
  swap(&item[lo], &item[middle]);
}

// Brings the item of rank `at` to its place (Hoare's selection).
static void select_rank(struct knn_item *item, int64_t n, int64_t at, uint32_t axis) {
  for (int64_t lo = 0, hi = n; hi - lo > 1;) {
    choose_pivot(item, lo, hi, axis);
    int64_t below = lo; // items lo + 1..below are below the pivot
    for (int64_t j = lo + 1; j < hi; j++)
      if (is_below(&item[j], &item[lo], axis)) swap(&item[j], &item[++below]);
    swap(&item[lo], &item[below]);
    if (below == at) return;
    if (at < below)
      hi = below;
    else
      lo = below + 1;
  }
}

static void part(struct knn_item *item, int64_t n) {
  while (n > LEAF) {
    int64_t middle = n / 2;
    uint32_t axis = widest(item, n);
    select_rank(item, n, middle, axis);
    item[middle].axis = axis;
    part(item, middle);
    item += middle + 1;
    n -= middle + 1;
  }
}

void knn_build(struct knn *knn, const struct vec *position, int64_t count, struct arena *arena) {
  assert(count < UINT32_MAX);
  if (count > knn->capacity) {
    knn->capacity = 2 * count;
    knn->item = arena_new(arena, struct knn_item, knn->capacity);
  }
  knn->count = count;
  for (int64_t j = 0; j < count; j++) knn->item[j] = (struct knn_item){position[j], (uint32_t)j, 0};
  part(knn->item, count);
}

// ---- the k nearest ----

// A heap of those found, the farthest on top.
struct nearest {
  struct vec p;
  int k, found;
  const struct knn_filter *filter;
  uint32_t *photon;
  double *distance2;
};

static bool is_farther(double d2, uint32_t photon, double than2, uint32_t than) {
  return d2 != than2 ? d2 > than2 : photon > than;
}

static void put(struct nearest *nearest, int at, double d2, uint32_t photon) {
  nearest->distance2[at] = d2;
  nearest->photon[at] = photon;
}

// From the bottom to where its parent is farther.
static void rise(struct nearest *nearest, double d2, uint32_t photon) {
  int at = nearest->found++;
  for (int up; at > 0; at = up) {
    up = (at - 1) / 2;
    if (!is_farther(d2, photon, nearest->distance2[up], nearest->photon[up])) break;
    put(nearest, at, nearest->distance2[up], nearest->photon[up]);
  }
  put(nearest, at, d2, photon);
}

// From the top of a heap of n to where its children are nearer.
static void sink(struct nearest *nearest, int n, double d2, uint32_t photon) {
  const double *distance2 = nearest->distance2;
  const uint32_t *number = nearest->photon;
  int at = 0;
  for (int down; (down = 2 * at + 1) < n; at = down) {
    if (down + 1 < n &&
        is_farther(distance2[down + 1], number[down + 1], distance2[down], number[down]))
      down++;
    if (!is_farther(distance2[down], number[down], d2, photon)) break;
    put(nearest, at, distance2[down], number[down]);
  }
  put(nearest, at, d2, photon);
}

static void consider(struct nearest *nearest, const struct knn_item *item) {
  struct vec d = vec_sub(item->p, nearest->p);
  double d2 = vec_dot(d, d);
  const struct knn_filter *filter = nearest->filter;
  bool full = nearest->found == nearest->k;
  if (full && !is_farther(nearest->distance2[0], nearest->photon[0], d2, item->photon)) return;
  if (filter && !filter->accept(filter->data, item->photon)) return;
  if (full)
    sink(nearest, nearest->found, d2, item->photon);
  else
    rise(nearest, d2, item->photon);
}

// Whether what lies beyond a plane at distance x can be nearer than what was found. Not strictly:
// one as far may have a smaller number. (Rounding is monotonic: |x| <= |d| gives x x <= d.d as both
// are rounded.)
static bool reaches(const struct nearest *nearest, double x) {
  return nearest->found < nearest->k || x * x <= nearest->distance2[0];
}

static void search(struct nearest *nearest, const struct knn_item *item, int64_t n) {
  if (n <= LEAF) {
    for (int64_t j = 0; j < n; j++) consider(nearest, &item[j]);
    return;
  }
  int64_t middle = n / 2;
  uint32_t axis = item[middle].axis;
  double x = coordinate(nearest->p, axis) - coordinate(item[middle].p, axis);
  const struct knn_item *above = item + middle + 1;
  if (x < 0) {
    search(nearest, item, middle);
    consider(nearest, &item[middle]);
    if (reaches(nearest, x)) search(nearest, above, n - middle - 1);
  } else {
    search(nearest, above, n - middle - 1);
    consider(nearest, &item[middle]);
    if (reaches(nearest, x)) search(nearest, item, middle);
  }
}

int knn_nearest(const struct knn *knn, struct vec p, int k, const struct knn_filter *filter,
                uint32_t *photon, double *distance2) {
  struct nearest nearest = {
      .p = p, .k = k, .filter = filter, .photon = photon, .distance2 = distance2};
  if (k < 1) return 0;
  search(&nearest, knn->item, knn->count);
  for (int n = nearest.found - 1; n > 0; n--) { // the farthest to the end, again and again
    double d2 = distance2[n];
    uint32_t last = photon[n];
    put(&nearest, n, distance2[0], photon[0]);
    sink(&nearest, n, d2, last);
  }
  return nearest.found;
}

// ---- all within a radius ----

struct within {
  struct vec p;
  double r2;
  int found;
  uint32_t *photon;
  double *distance2;
};

static void take(struct within *within, const struct knn_item *item) {
  struct vec d = vec_sub(item->p, within->p);
  double d2 = vec_dot(d, d);
  if (!(d2 < within->r2)) return;
  within->photon[within->found] = item->photon;
  within->distance2[within->found++] = d2;
}

static void collect(struct within *within, const struct knn_item *item, int64_t n) {
  if (n <= LEAF) {
    for (int64_t j = 0; j < n; j++) take(within, &item[j]);
    return;
  }
  int64_t middle = n / 2;
  uint32_t axis = item[middle].axis;
  double x = coordinate(within->p, axis) - coordinate(item[middle].p, axis);
  bool near = x * x < within->r2;
  if (x < 0 || near) collect(within, item, middle);
  take(within, &item[middle]);
  if (!(x < 0) || near) collect(within, item + middle + 1, n - middle - 1);
}

int knn_within(const struct knn *knn, struct vec p, double r, uint32_t *photon, double *distance2) {
  struct within within = {.p = p, .r2 = r * r, .photon = photon, .distance2 = distance2};
  collect(&within, knn->item, knn->count);
  return within.found;
}
