// Many rays in flight. A step of one ray depends on the step before it, through the latency of the
// memory it reads; so POOL rays take their steps in turn: all that have come to a node, then all
// that have come to triangles, and so on. What a ray needs next is prefetched while the others take
// their steps, and the loops over a queue hardly ever branch on what they find.
//
// Boxes are tested in float, conservatively: what is culled here is culled by cone_clip in double
// too, or cannot be hit. With exact o, d of an axis along which the ray goes forward (backward is
// its mirror image) cone_clip computes near = (lo - o) n and far = (hi - o) f, n and f > 0. Here
// near' = (lo - o') n' with o' >= o, and n' below n by 2^-22: what three roundings to float (o is
// in its own slack, the difference and n' here) add is less. So if the exact product is positive it
// is below `near`, else it is not positive, and rounding the product is monotone: near' > far' or
// near' > limit, rounded just so, means near > far, or near > the best t. In the same way far' is
// above `far` if far' is positive; if not, then far <= 0 and nothing is hit (clip_accept wants t >
// 0). NaNs (0 * INFINITY) lose against what is there.
// An axis that cone_clip calls parallel: where the ray is inside everything (t <= t1) it is no
// further from o than `reach`, and boxes beyond are culled by a scale of INFINITY.
// Rays and scenes so large or small that float could overflow are left to search_one.
#include "bvh/search.h"
#include "bvh/wide.h"

#include <string.h>

#ifdef __AVX2__

// Measured on one core: 32 to 96 rays in flight differ by less than the noise of 10 %.
enum { POOL = 48, AHEAD = 8, MOST_WAITING = 256 };
enum { QUEUE_HITS = BVH_NOTHING + 1, QUEUE_ODD, QUEUES };
enum { BLOCK_FLOATS = sizeof(struct bvh_block) / sizeof(float) };

struct slot {
  float near_o[4], near_scale[4], far_o[4], far_scale[4];
  double shear_o[3], along_x, along_y; // in the shear's order of axes
  uint32_t axis[3];                    // of the shear: bytes from a corner's first coordinate
  float limit;                         // best t
  uint32_t n;                          // waiting
  uint32_t row;                        // where it is
  uint32_t enter[3], leave[3];         // bytes from a node to the faces of an axis
  uint32_t octant;
  struct search search;
  int j;
  uint32_t accepted; // triangles of the block
  int64_t left;      // floats from the first block to the triangle that is left; or -1
  bool odd;          // a hit of this ray is looked at by search_triangle
  _Alignas(BVH_LINE) double o[4];
  double d[4], near[4], far[4];                // of clip.h; d[3]: t_max
  float waiting_near[MOST_WAITING];            // where their clips begin
  _Alignas(32) uint32_t waiting[MOST_WAITING]; // children, after the end: BVH_NOTHING
};

// pairs_t counts in doubles from o, slot_begin loads a ray's d and t_max together.
_Static_assert(offsetof(struct slot, d) == offsetof(struct slot, o) + 4 * sizeof(double), "d");
_Static_assert(offsetof(struct slot, near) == offsetof(struct slot, o) + 8 * sizeof(double),
               "near");
_Static_assert(offsetof(struct slot, far) == offsetof(struct slot, o) + 12 * sizeof(double), "far");
_Static_assert(offsetof(struct ray, t_max) == offsetof(struct ray, d) + 3 * sizeof(double),
               "t_max");

struct pool {
  _Alignas(BVH_LINE) struct slot slot[POOL];
  struct slot *queue[QUEUES][2][POOL]; // one is read while the other one fills
  struct slot **first[QUEUES], **end[QUEUES];
  const char *base[QUEUES]; // of the rows of a kind
  uint32_t stride[QUEUES];
};

// ---- where a ray goes ----
static inline void send(struct pool *pool, struct slot *slot, uint32_t queue) {
  *pool->end[queue]++ = slot;
}

static inline void go_to(struct pool *pool, struct slot *slot, uint32_t child) {
  uint32_t kind = bvh_kind_of(child);
  slot->row = bvh_row_of(child);
  const char *at = pool->base[kind] + (size_t)slot->row * pool->stride[kind];
  __builtin_prefetch(at);
  __builtin_prefetch(at + BVH_LINE);
  __builtin_prefetch(at + 2 * BVH_LINE);
  __builtin_prefetch(at + 3 * BVH_LINE);
  send(pool, slot, kind);
}

// From a row of a leaf to its next row, if there is one, or to what waits.
static inline void go_on_in_leaf(struct pool *pool, struct slot *slot, enum bvh_kind kind,
                                 uint32_t more) {
  uint32_t waiting = slot->waiting[slot->n - 1];
  slot->n -= !more;
  go_to(pool, slot, more ? bvh_child(kind, slot->row + 1) : waiting);
}

// The same unless `stay`: then it stays in its row, and in `queue`. No branch: nothing predicts it.
static inline void go_on_or_stay(struct pool *pool, struct slot *slot, uint32_t more, bool stay,
                                 uint32_t queue) {
  uint32_t row = slot->row, waiting = slot->waiting[slot->n - 1];
  uint32_t next = more ? bvh_child(BVH_TRIANGLES, row + 1) : waiting;
  uint32_t kind = bvh_kind_of(next), next_row = bvh_row_of(next);
  slot->n -= !stay & !more;
  slot->row = stay ? row : next_row;
  const char *at = pool->base[kind] + (size_t)next_row * pool->stride[kind];
  __builtin_prefetch(at);
  __builtin_prefetch(at + BVH_LINE);
  __builtin_prefetch(at + 2 * BVH_LINE);
  __builtin_prefetch(at + 3 * BVH_LINE);
  send(pool, slot, stay ? queue : kind);
}

// ---- a ray begins ----
static inline __m128 floats(__m256d x) { return _mm256_cvtpd_ps(x); }

// Axes along which the cone reaches both faces and leaves neither.
static __attribute__((noinline)) bool slot_begin_parallel(struct slot *slot,
                                                          const struct bvh *bvh) {
  struct cone cone;
  double t0, t1;
  cone_set(&cone, slot->search.ray);
  if (!cone_clip(&cone, &bvh->box, &t0, &t1)) return false;
  for (int k = 0; k < 3; k++) {
    if (!cone.parallel[k]) continue;
    double reach = t1 / cone.near_scale[k] * (1 + 0x1p-20);
    double slack = reach + cone_abs(cone.o[k]) * 0x1p-22 + 0x1p-126;
    slot->near_o[k] = (float)(cone.o[k] + slack), slot->far_o[k] = (float)(cone.o[k] - slack);
    slot->near_scale[k] = slot->far_scale[k] = INFINITY;
    slot->enter[k] = 64 * (uint32_t)k, slot->leave[k] = slot->enter[k] + 32;
  }
  slot->odd = true;
  return true;
}

// shear_set
static inline void slot_begin_shear(struct slot *slot, const struct ray *ray,
                                    const double size[3]) {
  static const int z_of[4] = {1, 0, 2, 2}, x_of[3] = {1, 2, 0}, y_of[3] = {2, 0, 1};
  double largest = size[0] > size[1] ? size[0] : size[1];
  int z = z_of[(size[0] > size[1]) | (size[2] > largest) << 1], x = x_of[z], y = y_of[z];
  const double *o = &ray->o.x, *d = &ray->d.x;
  __m128d along = _mm_div_pd(_mm_set_pd(d[y], d[x]), _mm_set1_pd(d[z]));
  slot->shear_o[0] = o[x], slot->shear_o[1] = o[y], slot->shear_o[2] = o[z];
  _mm_storeu_pd(&slot->along_x, along);
  const uint32_t bytes = BVH_BLOCK * sizeof(float);
  slot->axis[0] = bytes * (uint32_t)x;
  slot->axis[1] = bytes * (uint32_t)y;
  slot->axis[2] = bytes * (uint32_t)z;
}

// Where the triangle is that the ray leaves. A patch is odd.
static inline void slot_begin_left(struct slot *slot, const struct bvh *bvh) {
  uint32_t leaving = slot->search.ray->leaving;
  slot->left = -1;
  slot->odd = false;
  if (leaving == PRIMITIVE_NONE) return;
  uint32_t lane = bvh->lane[leaving];
  slot->odd = lane == ROW_NONE;
  if (slot->odd) return;
  slot->left = (int64_t)BLOCK_FLOATS * (lane / BVH_BLOCK) + lane % BVH_BLOCK;
  for (int i = 0; i < 3; i++)
    __builtin_prefetch((const char *)(bvh->block + lane / BVH_BLOCK) + i * BVH_LINE);
}

enum begun { BEGUN, MISSES, ODD };

static inline enum begun slot_begin(struct slot *slot, const struct bvh *bvh) {
  const struct ray *ray = slot->search.ray;
  const __m256d sign = _mm256_set1_pd(-0.0);
  __m256d o = _mm256_blend_pd(_mm256_loadu_pd(&ray->o.x), _mm256_set1_pd(1), 8);
  __m256d d = _mm256_loadu_pd(&ray->d.x); // and t_max
  __m256d distance = _mm256_andnot_pd(sign, o);
  __m256d size = _mm256_andnot_pd(sign, _mm256_blend_pd(d, _mm256_setzero_pd(), 8));
  __m256d largest = _mm256_max_pd(size, _mm256_permute4x64_pd(size, 0x4e));
  largest = _mm256_max_pd(largest, _mm256_permute_pd(largest, 5));
  __m256d outside = _mm256_cmp_pd(distance, _mm256_set1_pd(SEARCH_LARGEST), _CMP_NLE_UQ);
  outside = _mm256_or_pd(outside, _mm256_cmp_pd(size, _mm256_set1_pd(SEARCH_LARGEST), _CMP_NLE_UQ));
  outside =
      _mm256_or_pd(outside, _mm256_cmp_pd(largest, _mm256_set1_pd(SEARCH_SMALLEST), _CMP_NGE_UQ));
  if (_mm256_movemask_pd(outside)) return ODD;
  __m256d w = _mm256_mul_pd(_mm256_set1_pd(CLIP_APERTURE), largest), one = _mm256_set1_pd(1);
  __m256d near = _mm256_div_pd(one, _mm256_add_pd(size, w));
  __m256d far = _mm256_div_pd(one, _mm256_sub_pd(size, w));
  int parallel = _mm256_movemask_pd(_mm256_cmp_pd(size, w, _CMP_LE_OQ)) & 7;
  __m256d backward = _mm256_cmp_pd(d, _mm256_setzero_pd(), _CMP_LT_OQ);
  __m256d along = _mm256_and_pd(sign, backward);
  __m256d slack =
      _mm256_add_pd(_mm256_mul_pd(distance, _mm256_set1_pd(0x1p-23)), _mm256_set1_pd(0x1p-126));
  slack = _mm256_or_pd(slack, along);
  near = _mm256_or_pd(near, along);
  far = _mm256_or_pd(far, along);
  _mm256_store_pd(slot->o, o);
  _mm256_store_pd(slot->d, d);
  _mm256_store_pd(slot->near, near);
  _mm256_store_pd(slot->far, far);
  _mm_store_ps(slot->near_o, floats(_mm256_add_pd(o, slack)));
  _mm_store_ps(slot->far_o, floats(_mm256_sub_pd(o, slack)));
  _mm_store_ps(slot->near_scale, floats(_mm256_mul_pd(near, _mm256_set1_pd(1 - 0x1p-22))));
  _mm_store_ps(slot->far_scale, floats(_mm256_mul_pd(far, _mm256_set1_pd(1 + 0x1p-22))));
  const uint32_t octant = (uint32_t)_mm256_movemask_pd(backward) & 7;
  for (uint32_t k = 0; k < 3; k++) {
    slot->enter[k] = 64 * k + 32 * (octant >> k & 1);
    slot->leave[k] = slot->enter[k] ^ 32;
  }
  slot->octant = octant;
  slot->limit = (float)slot->search.best.t;
  slot->waiting[0] = bvh_child(BVH_NOTHING, 0);
  slot->waiting_near[0] = -INFINITY;
  slot->n = 1;
  double of_axis[4];
  _mm256_storeu_pd(of_axis, size);
  slot_begin_shear(slot, ray, of_axis);
  slot_begin_left(slot, bvh);
  return !parallel || slot_begin_parallel(slot, bvh) ? BEGUN : MISSES;
}

// The next rays until one is under way; false: there are no more.
static inline bool begin_next(struct pool *pool, struct slot *slot, const struct bvh *bvh,
                              const struct queries *q, enum search_kind kind, int *next) {
  while (*next < q->n) {
    int j = (*next)++;
    search_begin(&slot->search, q, j, kind);
    slot->j = j;
    uint32_t later = q->ray[j + AHEAD < q->n ? j + AHEAD : j].leaving;
    if (later != PRIMITIVE_NONE) __builtin_prefetch(&bvh->lane[later]);
    enum begun begun = slot_begin(slot, bvh);
    if (begun == BEGUN) {
      go_to(pool, slot, bvh->root);
      return true;
    }
    if (begun == MISSES)
      search_end(&slot->search, q, j, kind);
    else
      search_one(bvh, q, j, kind);
  }
  return false;
}

// ---- steps ----
static inline __m256 faces(const char *node, uint32_t bytes) {
  return _mm256_load_ps((const float *)(node + bytes));
}

static inline void visit_node(struct pool *pool, struct slot *slot, const struct bvh *bvh) {
  const struct bvh_node *node = &bvh->node[slot->row];
  const char *at = (const char *)node;
  __m256 near = _mm256_setzero_ps(), far = _mm256_set1_ps(slot->limit);
#pragma GCC unroll 3
  for (int k = 0; k < 3; k++) {
    __m256 first = _mm256_sub_ps(faces(at, slot->enter[k]), _mm256_set1_ps(slot->near_o[k]));
    __m256 last = _mm256_sub_ps(faces(at, slot->leave[k]), _mm256_set1_ps(slot->far_o[k]));
    near = _mm256_max_ps(_mm256_mul_ps(first, _mm256_set1_ps(slot->near_scale[k])), near);
    far = _mm256_min_ps(_mm256_mul_ps(last, _mm256_set1_ps(slot->far_scale[k])), far);
  }
  const __m256i shifts = _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21);
  __m256i order = _mm256_srlv_epi32(_mm256_set1_epi32((int)node->order[slot->octant]), shifts);
  __m256i child = _mm256_load_si256((const __m256i *)node->child);
  uint32_t n = slot->n;
  n += push(order, near, far, child, slot->waiting_near + n, slot->waiting + n) - 1;
  slot->n = n;
  go_to(pool, slot, slot->waiting[n]);
}

typedef double quad __attribute__((vector_size(32)));

static inline quad corner(const struct bvh_block *block, int i, uint32_t bytes) {
  const char *at = (const char *)block->vertex[i] + bytes;
  return (quad)_mm256_cvtps_pd(_mm_load_ps((const float *)at));
}

// triangle_accepts
static inline int block_accepts(const struct slot *slot, const struct bvh_block *block) {
  quad x[3], y[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    quad z = corner(block, i, slot->axis[2]) - slot->shear_o[2];
    x[i] = (corner(block, i, slot->axis[0]) - slot->shear_o[0]) - slot->along_x * z;
    y[i] = (corner(block, i, slot->axis[1]) - slot->shear_o[1]) - slot->along_y * z;
  }
  quad e0 = x[1] * y[2] - y[1] * x[2];
  quad e1 = x[2] * y[0] - y[2] * x[0];
  quad e2 = x[0] * y[1] - y[0] * x[1];
  // Of vertices that are numbers all three are, of NaN vertices none.
  __m256d low = _mm256_min_pd((__m256d)e0, _mm256_min_pd((__m256d)e1, (__m256d)e2));
  __m256d high = _mm256_max_pd((__m256d)e0, _mm256_max_pd((__m256d)e1, (__m256d)e2));
  __m256d accepted = (__m256d)(((quad)low >= 0) | ((quad)high <= 0));
  return _mm256_movemask_pd(accepted);
}

static inline void visit_block(struct pool *pool, struct slot *slot, const struct bvh *bvh) {
  const struct bvh_block *block = &bvh->block[slot->row];
  __m128i left = _mm_cmpeq_epi32(_mm_load_si128((const __m128i *)block->primitive),
                                 _mm_set1_epi32((int)slot->search.ray->leaving));
  slot->accepted =
      (uint32_t)(block_accepts(slot, block) & ~_mm_movemask_ps(_mm_castsi128_ps(left)));
  uint32_t queue = slot->odd ? QUEUE_ODD : QUEUE_HITS;
  go_on_or_stay(pool, slot, block->more, slot->accepted != 0, queue);
}

// What waits and begins beyond the best t is dropped.
static inline void tighten(struct slot *slot) {
  const __m256i in_order = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  __m256 limit = _mm256_set1_ps(slot->limit = (float)slot->search.best.t);
  uint32_t n = slot->n, kept = 1;
  for (uint32_t first = 1; first < n; first += 8) {
    __m256 near = _mm256_loadu_ps(slot->waiting_near + first);
    __m256i child = _mm256_loadu_si256((const __m256i *)(slot->waiting + first));
    __m256i left = _mm256_cmpgt_epi32(_mm256_set1_epi32((int)(n - first)), in_order);
    __m256 bound = _mm256_blendv_ps(_mm256_set1_ps(NAN), limit, _mm256_castsi256_ps(left));
    kept += push(in_order, near, bound, child, slot->waiting_near + kept, slot->waiting + kept);
  }
  slot->n = kept;
}

static inline void finish(struct pool *pool, struct slot *slot) { send(pool, slot, BVH_NOTHING); }

// WIDE rays and one triangle of each, which its edge functions accept.
struct pairs {
  struct slot *slot[WIDE];
  double t[WIDE];
  unsigned hit; // bit of each that clip_accept accepts and that is not left behind
};

static inline void pairs_corners(const struct bvh *bvh, places at, narrow corner[3][3]) {
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++)
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++)
      corner[i][k] = gather(bvh->block, plus(at, BVH_BLOCK * (3 * i + k)));
}

// triangle_cross
static inline void pairs_cross(const narrow corner[3][3], wide n[3]) {
  wide a[3], b[3];
#pragma GCC unroll 3
  for (int k = 0; k < 3; k++) {
    a[k] = widen(corner[0][k]) - widen(corner[2][k]);
    b[k] = widen(corner[1][k]) - widen(corner[2][k]);
  }
  n[0] = a[1] * b[2] - a[2] * b[1];
  n[1] = a[2] * b[0] - a[0] * b[2];
  n[2] = a[0] * b[1] - a[1] * b[0];
}

static inline wide pairs_dot(const wide a[3], const wide b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// triangle_plane and clip_accept. The face by which an axis is entered is that of the corner whose
// (corner - o) * near_scale is the least, as that product is monotone: no choice by direction.
static inline wide pairs_t(const narrow corner[3][3], const struct pool *pool, places slot,
                           unsigned *hit) {
  const places ray = plus(slot, offsetof(struct slot, o) / sizeof(double));
  wide n[3], from[3], d[3], near = {0}, far = near + INFINITY;
  pairs_cross(corner, n);
#pragma GCC unroll 3
  for (int k = 0; k < 3; k++) {
    wide o = gather_double(pool, plus(ray, k)), enter = gather_double(pool, plus(ray, 8 + k)),
         leave = gather_double(pool, plus(ray, 12 + k));
    d[k] = gather_double(pool, plus(ray, 4 + k));
    from[k] = widen(corner[0][k]) - o;
    wide b = widen(corner[1][k]) - o, c = widen(corner[2][k]) - o;
    near = greatest(least(least(from[k] * enter, b * enter), c * enter), near);
    far = least(greatest(greatest(from[k] * leave, b * leave), c * leave), far);
  }
  wide t = pairs_dot(n, from) / pairs_dot(n, d), zero = {0};
  *hit = less(zero, t) & less(t, zero + INFINITY) & ~less(far, near);
  t = least(far, greatest(near, t));
  *hit &= less(zero, t) & less(t, gather_double(pool, plus(ray, 7)));
  return t;
}

// !triangle_is_left_behind
static inline unsigned pairs_not_behind(const struct bvh *bvh, const narrow corner[3][3],
                                        const struct pool *pool, places slot, places at) {
  const places d_at = plus(slot, offsetof(struct slot, d) / sizeof(double));
  narrow left[3][3];
  wide n[3], d[3], zero = {0};
  pairs_corners(bvh, at, left);
  pairs_cross((const narrow(*)[3])left, n);
  for (int k = 0; k < 3; k++) d[k] = gather_double(pool, plus(d_at, k));
  wide side = pairs_dot(n, d);
  unsigned forward = less(zero, side), ahead = ~(forward | less(side, zero));
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    wide v[3];
    unsigned shared = 0;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) v[k] = widen(corner[i][k]) - widen(left[0][k]);
    wide height = pairs_dot(n, v);
#pragma GCC unroll 3
    for (int j = 0; j < 3; j++)
      shared |= same(corner[i][0], left[j][0]) & same(corner[i][1], left[j][1]) &
                same(corner[i][2], left[j][2]);
    unsigned up = less(zero, height), down = less(height, zero);
    ahead |= ((forward & up) | (~forward & down)) & ~shared;
  }
  return ahead;
}

static inline void pairs_test(struct pairs *pairs, const struct bvh *bvh, const struct pool *pool) {
  int64_t slot_at[WIDE], at[WIDE], left_at[WIDE];
  unsigned none = 0;
  for (int w = 0; w < WIDE; w++) {
    const struct slot *slot = pairs->slot[w];
    slot_at[w] = ((const char *)slot - (const char *)pool) / (ptrdiff_t)sizeof(double);
    at[w] = (int64_t)BLOCK_FLOATS * slot->row + __builtin_ctz(slot->accepted);
    left_at[w] = slot->left < 0 ? 0 : slot->left;
    none |= (unsigned)(slot->left < 0) << w;
  }
  places in_pool, in_blocks, left;
  __builtin_memcpy(&in_pool, slot_at, sizeof in_pool);
  __builtin_memcpy(&in_blocks, at, sizeof in_blocks);
  __builtin_memcpy(&left, left_at, sizeof left);
  narrow corner[3][3];
  pairs_corners(bvh, in_blocks, corner);
  wide t = pairs_t((const narrow(*)[3])corner, pool, in_pool, &pairs->hit);
  __builtin_memcpy(pairs->t, &t, sizeof t);
  if (none != (1u << WIDE) - 1)
    pairs->hit &= none | pairs_not_behind(bvh, (const narrow(*)[3])corner, pool, in_pool, left);
}

static inline void keep_hit(struct pool *pool, struct slot *slot, const struct bvh *bvh,
                            enum search_kind kind, bool hit, double t) {
  const struct bvh_block *block = &bvh->block[slot->row];
  struct search *search = &slot->search;
  uint32_t primitive = block->primitive[__builtin_ctz(slot->accepted)];
  hit &= hit_is_before(t, primitive, &search->best);
  slot->accepted &= slot->accepted - 1;
  if (kind == SEARCH_CLOSEST) {
    search->best.t = hit ? t : search->best.t;
    search->best.primitive = hit ? primitive : search->best.primitive;
    search->found |= hit;
    tighten(slot);
    go_on_or_stay(pool, slot, block->more, slot->accepted != 0, QUEUE_HITS);
    return;
  }
  bool over = hit && search_keep(bvh, search, kind, t, primitive);
  if (kind == SEARCH_BLOCKER && hit && !over) tighten(slot);
  go_on_or_stay(pool, slot, block->more, over | (slot->accepted != 0),
                over ? BVH_NOTHING : QUEUE_HITS);
}

static inline void visit_hits(struct pool *pool, struct slot *const *slot, int n,
                              const struct bvh *bvh, enum search_kind kind) {
  for (int first = 0; first < n; first += WIDE) {
    struct pairs pairs;
    int count = n - first < WIDE ? n - first : WIDE;
    for (int w = 0; w < WIDE; w++) pairs.slot[w] = slot[first + (w < count ? w : 0)];
    pairs_test(&pairs, bvh, pool);
    for (int w = 0; w < count; w++)
      keep_hit(pool, pairs.slot[w], bvh, kind, pairs.hit >> w & 1, pairs.t[w]);
  }
}

// Of an axis that is parallel cone_clip works in another way: one triangle after the other.
static __attribute__((noinline)) void visit_odd(struct pool *pool, struct slot *slot,
                                                const struct bvh *bvh, enum search_kind kind) {
  const struct bvh_block *block = &bvh->block[slot->row];
  const struct ray *ray = slot->search.ray;
  struct cone cone;
  cone_set(&cone, ray);
  for (int lane = 0; lane < BVH_BLOCK; lane++) {
    float vertex[3][3];
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) vertex[i][k] = block->vertex[i][k][lane];
    double t = triangle_plane(ray, (const float(*)[3])vertex);
    if (slot->accepted >> lane & 1 &&
        search_triangle(bvh, &slot->search, kind, &cone, block, lane, t)) {
      finish(pool, slot);
      return;
    }
  }
  if (kind != SEARCH_ANY) tighten(slot);
  go_on_in_leaf(pool, slot, BVH_TRIANGLES, block->more);
}

static inline void visit_other(struct pool *pool, struct slot *slot, const struct bvh *bvh,
                               enum search_kind kind) {
  const struct bvh_other *other = &bvh->other[slot->row];
  struct cone cone;
  cone_set(&cone, slot->search.ray);
  if (search_other(bvh, &slot->search, kind, &cone, other)) {
    finish(pool, slot);
    return;
  }
  if (kind != SEARCH_ANY) tighten(slot);
  go_on_in_leaf(pool, slot, BVH_OTHERS, other->more);
}

// ---- the pool ----
// What is in a queue, which is empty then.
static inline struct slot **take(struct pool *pool, uint32_t queue, int *n) {
  struct slot **first = pool->first[queue], **other = pool->queue[queue][0];
  *n = (int)(pool->end[queue] - first);
  if (first == other) other = pool->queue[queue][1];
  pool->first[queue] = pool->end[queue] = other;
  return first;
}

static inline __attribute__((always_inline)) void
run(const struct bvh *bvh, const struct queries *q, enum search_kind kind) {
  struct pool pool;
  for (int k = 0; k < QUEUES; k++)
    pool.first[k] = pool.end[k] = pool.queue[k][0], pool.base[k] = (const char *)&pool,
    pool.stride[k] = 0;
  pool.base[BVH_NODE] = (const char *)bvh->node, pool.stride[BVH_NODE] = sizeof *bvh->node;
  pool.base[BVH_TRIANGLES] = (const char *)bvh->block;
  pool.stride[BVH_TRIANGLES] = sizeof *bvh->block;
  pool.base[BVH_OTHERS] = (const char *)bvh->other, pool.stride[BVH_OTHERS] = sizeof *bvh->other;
  int next = 0, in_flight = 0;
  for (int k = 0; k < POOL; k++) in_flight += begin_next(&pool, &pool.slot[k], bvh, q, kind, &next);
  while (in_flight > 0) {
    int n;
    struct slot **now = take(&pool, BVH_NODE, &n);
    for (int i = 0; i < n; i++) visit_node(&pool, now[i], bvh);
    now = take(&pool, BVH_TRIANGLES, &n);
    for (int i = 0; i < n; i++) visit_block(&pool, now[i], bvh);
    now = take(&pool, QUEUE_HITS, &n);
    visit_hits(&pool, now, n, bvh, kind);
    now = take(&pool, QUEUE_ODD, &n);
    for (int i = 0; i < n; i++) visit_odd(&pool, now[i], bvh, kind);
    now = take(&pool, BVH_OTHERS, &n);
    for (int i = 0; i < n; i++) visit_other(&pool, now[i], bvh, kind);
    now = take(&pool, BVH_NOTHING, &n);
    for (int i = 0; i < n; i++) {
      search_end(&now[i]->search, q, now[i]->j, kind);
      in_flight -= !begin_next(&pool, now[i], bvh, q, kind, &next);
    }
  }
}

static bool fits(const struct bvh *bvh) {
  if ((BVH_WIDTH - 1) * (int)bvh->statistics.depth + 2 + BVH_WIDTH > MOST_WAITING) return false;
  for (int k = 0; k < 3; k++)
    if (!((double)bvh->box.lo[k] >= -SEARCH_LARGEST && (double)bvh->box.hi[k] <= SEARCH_LARGEST))
      return false;
  return true;
}
#define RUN(bvh, queries, kind)                                                                    \
  if (fits(bvh)) {                                                                                 \
    run(bvh, queries, kind);                                                                       \
    return;                                                                                        \
  }
#else
#define RUN(bvh, queries, kind)
#endif

static void closest(const struct bvh *bvh, const struct queries *q) {
  RUN(bvh, q, SEARCH_CLOSEST)
  for (int j = 0; j < q->n; j++) search_one(bvh, q, j, SEARCH_CLOSEST);
}

static void any(const struct bvh *bvh, const struct queries *q) {
  RUN(bvh, q, SEARCH_ANY)
  for (int j = 0; j < q->n; j++) search_one(bvh, q, j, SEARCH_ANY);
}

static void blocker(const struct bvh *bvh, const struct queries *q) {
  RUN(bvh, q, SEARCH_BLOCKER)
  for (int j = 0; j < q->n; j++) search_one(bvh, q, j, SEARCH_BLOCKER);
}

const struct search_level SIMD_NAME(search_level) = {{closest, any, blocker}};
