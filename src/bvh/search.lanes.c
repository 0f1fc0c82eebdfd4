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

#ifdef __AVX2__
#include <immintrin.h>

// Measured on one core: 16 to 64 rays in flight.
enum { POOL = 48, MOST_WAITING = 256 };
enum { QUEUE_HITS = BVH_NOTHING + 1, QUEUES };

static const double LARGEST = 0x1p60, SMALLEST = 0x1p-60;

struct slot {
  float near_o[4], near_scale[4], far_o[4], far_scale[4];
  double o[3], along_x, along_y; // of the shear, in its order of axes
  uint32_t axis[3];              // of the shear: bytes from a corner's first coordinate
  float limit;                   // best t
  int n;                         // waiting
  uint32_t row;                  // where it is
  uint32_t enter[3];             // bytes from a node to the faces by which an axis is entered
  uint32_t octant;
  double cone_o[4], cone_near[4], cone_far[4]; // of clip.h
  bool parallel;                               // any axis
  struct search search;
  int j;
  int accepted;                                // triangles of the block
  float waiting_near[MOST_WAITING];            // where their clips begin
  _Alignas(32) uint32_t waiting[MOST_WAITING]; // children, after the end: BVH_NOTHING
};

struct pool {
  _Alignas(BVH_LINE) struct slot slot[POOL];
  struct slot *queue[QUEUES][POOL];
  int count[QUEUES];
  const char *base[BVH_NOTHING + 1]; // of the rows of a kind
  uint32_t stride[BVH_NOTHING + 1];
};

// ---- the level's own ----
#ifdef __AVX512F__
// Where a <= b, the values of `near` and `child` from far to near move to the end of the waiting.
static inline int push(__m256i order, __m256 near, __m256 far, __m256i child, float *to_near,
                       uint32_t *to_child) {
  near = _mm256_permutexvar_ps(order, near);
  far = _mm256_permutexvar_ps(order, far);
  child = _mm256_permutexvar_epi32(order, child);
  __mmask8 hit = _mm256_cmp_ps_mask(near, far, _CMP_LE_OQ);
  _mm256_storeu_ps(to_near, _mm256_maskz_compress_ps(hit, near));
  _mm256_storeu_si256((__m256i *)to_child, _mm256_maskz_compress_epi32(hit, child));
  return __builtin_popcount(hit);
}
#else
// [mask]: the lanes that are set, one a byte.
static uint64_t lanes_of[256];

__attribute__((constructor)) static void lanes_of_set(void) {
  for (int mask = 0; mask < 256; mask++)
    for (int lane = 0, n = 0; lane < 8; lane++)
      if (mask >> lane & 1) lanes_of[mask] |= (uint64_t)lane << 8 * n++;
}

static inline int push(__m256i order, __m256 near, __m256 far, __m256i child, float *to_near,
                       uint32_t *to_child) {
  near = _mm256_permutevar8x32_ps(near, order);
  far = _mm256_permutevar8x32_ps(far, order);
  child = _mm256_permutevar8x32_epi32(child, order);
  int hit = _mm256_movemask_ps(_mm256_cmp_ps(near, far, _CMP_LE_OQ));
  __m256i lane = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)lanes_of[hit]));
  _mm256_storeu_ps(to_near, _mm256_permutevar8x32_ps(near, lane));
  _mm256_storeu_si256((__m256i *)to_child, _mm256_permutevar8x32_epi32(child, lane));
  return __builtin_popcount((unsigned)hit);
}
#endif

// ---- where a ray goes ----
static inline void send(struct pool *pool, struct slot *slot, int queue) {
  pool->queue[queue][pool->count[queue]++] = slot;
}

static inline void go_to(struct pool *pool, struct slot *slot, uint32_t child) {
  enum bvh_kind kind = bvh_kind_of(child);
  slot->row = bvh_row_of(child);
  const char *at = pool->base[kind] + (size_t)slot->row * pool->stride[kind];
  __builtin_prefetch(at);
  __builtin_prefetch(at + BVH_LINE);
  __builtin_prefetch(at + 2 * BVH_LINE);
  __builtin_prefetch(at + 3 * BVH_LINE);
  send(pool, slot, (int)kind);
}

static inline void go_on(struct pool *pool, struct slot *slot) {
  go_to(pool, slot, slot->waiting[--slot->n]);
}

// From a row of a leaf to its next row, if there is one.
static inline void go_on_in_leaf(struct pool *pool, struct slot *slot, enum bvh_kind kind,
                                 uint32_t more) {
  uint32_t waiting = slot->waiting[slot->n - 1];
  slot->n -= !more;
  go_to(pool, slot, more ? bvh_child(kind, slot->row + 1) : waiting);
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
    slot->enter[k] = 64 * (uint32_t)k;
  }
  return true;
}

static inline void slot_begin_shear(struct slot *slot, const struct ray *ray) {
  struct shear shear;
  shear_set(&shear, ray);
  slot->o[0] = shear.o[shear.x], slot->o[1] = shear.o[shear.y], slot->o[2] = shear.o[shear.z];
  slot->along_x = shear.along_x, slot->along_y = shear.along_y;
  const uint32_t bytes = BVH_BLOCK * sizeof(float);
  slot->axis[0] = bytes * (uint32_t)shear.x;
  slot->axis[1] = bytes * (uint32_t)shear.y;
  slot->axis[2] = bytes * (uint32_t)shear.z;
}

enum begun { BEGUN, MISSES, ODD };

static inline enum begun slot_begin(struct slot *slot, const struct bvh *bvh) {
  const struct ray *ray = slot->search.ray;
  const __m256d sign = _mm256_set1_pd(-0.0);
  __m256d o = _mm256_set_pd(1, ray->o.z, ray->o.y, ray->o.x);
  __m256d d = _mm256_set_pd(0, ray->d.z, ray->d.y, ray->d.x);
  __m256d size = _mm256_andnot_pd(sign, d), distance = _mm256_andnot_pd(sign, o);
  __m256d largest = _mm256_max_pd(size, _mm256_permute4x64_pd(size, 0x39));
  largest = _mm256_max_pd(largest, _mm256_permute4x64_pd(largest, 0x4e));
  __m256d too_far = _mm256_cmp_pd(distance, _mm256_set1_pd(LARGEST), _CMP_NLE_UQ);
  double longest = _mm256_cvtsd_f64(largest);
  if (_mm256_movemask_pd(too_far) || !(longest >= SMALLEST && longest <= LARGEST)) return ODD;
  __m256d w = _mm256_mul_pd(_mm256_set1_pd(CLIP_APERTURE), largest), one = _mm256_set1_pd(1);
  __m256d near = _mm256_div_pd(one, _mm256_add_pd(size, w));
  __m256d far = _mm256_div_pd(one, _mm256_sub_pd(size, w));
  int parallel = _mm256_movemask_pd(_mm256_cmp_pd(size, w, _CMP_LE_OQ)) & 7;
  int backward = _mm256_movemask_pd(_mm256_cmp_pd(d, _mm256_setzero_pd(), _CMP_LT_OQ));
  __m256d along = _mm256_and_pd(sign, d);
  __m256d slack =
      _mm256_add_pd(_mm256_mul_pd(distance, _mm256_set1_pd(0x1p-23)), _mm256_set1_pd(0x1p-126));
  _mm256_storeu_pd(slot->cone_o, o);
  _mm256_storeu_pd(slot->cone_near, _mm256_or_pd(near, along));
  _mm256_storeu_pd(slot->cone_far, _mm256_or_pd(far, along));
  slot->parallel = parallel;
  slack = _mm256_or_pd(slack, along);
  near = _mm256_or_pd(_mm256_mul_pd(near, _mm256_set1_pd(1 - 0x1p-22)), along);
  far = _mm256_or_pd(_mm256_mul_pd(far, _mm256_set1_pd(1 + 0x1p-22)), along);
  _mm_store_ps(slot->near_o, floats(_mm256_add_pd(o, slack)));
  _mm_store_ps(slot->far_o, floats(_mm256_sub_pd(o, slack)));
  _mm_store_ps(slot->near_scale, floats(near));
  _mm_store_ps(slot->far_scale, floats(far));
  for (int k = 0; k < 3; k++) slot->enter[k] = (uint32_t)(64 * k + 32 * (backward >> k & 1));
  slot->octant = (uint32_t)backward;
  slot->limit = (float)slot->search.best.t;
  slot->waiting[0] = bvh_child(BVH_NOTHING, 0);
  slot->waiting_near[0] = -INFINITY;
  slot->n = 1;
  slot_begin_shear(slot, ray);
  return !parallel || slot_begin_parallel(slot, bvh) ? BEGUN : MISSES;
}

// The next rays until one is under way; false: there are no more.
static inline bool begin_next(struct pool *pool, struct slot *slot, const struct bvh *bvh,
                              const struct queries *q, enum search_kind kind, int *next) {
  while (*next < q->n) {
    int j = (*next)++;
    search_begin(&slot->search, q, j, kind);
    slot->j = j;
    if (slot->search.ray->leaving != PRIMITIVE_NONE)
      __builtin_prefetch(&bvh->lane[slot->search.ray->leaving]);
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
    uint32_t enter = slot->enter[k], leave = enter ^ 32;
    __m256 first = _mm256_sub_ps(faces(at, enter), _mm256_set1_ps(slot->near_o[k]));
    __m256 last = _mm256_sub_ps(faces(at, leave), _mm256_set1_ps(slot->far_o[k]));
    near = _mm256_max_ps(_mm256_mul_ps(first, _mm256_set1_ps(slot->near_scale[k])), near);
    far = _mm256_min_ps(_mm256_mul_ps(last, _mm256_set1_ps(slot->far_scale[k])), far);
  }
  const __m256i shifts = _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21);
  __m256i order = _mm256_srlv_epi32(_mm256_set1_epi32((int)node->order[slot->octant]), shifts);
  __m256i child = _mm256_load_si256((const __m256i *)node->child);
  int n = slot->n;
  slot->n += push(order, near, far, child, slot->waiting_near + n, slot->waiting + n);
  go_on(pool, slot);
}

typedef double lanes __attribute__((vector_size(32)));

static inline lanes corner(const struct bvh_block *block, int i, uint32_t bytes) {
  const char *at = (const char *)block->vertex[i] + bytes;
  return (lanes)_mm256_cvtps_pd(_mm_load_ps((const float *)at));
}

// triangle_accepts
static inline int block_accepts(const struct slot *slot, const struct bvh_block *block) {
  lanes x[3], y[3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    lanes z = corner(block, i, slot->axis[2]) - slot->o[2];
    x[i] = (corner(block, i, slot->axis[0]) - slot->o[0]) - slot->along_x * z;
    y[i] = (corner(block, i, slot->axis[1]) - slot->o[1]) - slot->along_y * z;
  }
  lanes e0 = x[1] * y[2] - y[1] * x[2];
  lanes e1 = x[2] * y[0] - y[2] * x[0];
  lanes e2 = x[0] * y[1] - y[0] * x[1];
  __m256d accepted =
      (__m256d)(((e0 >= 0) & (e1 >= 0) & (e2 >= 0)) | ((e0 <= 0) & (e1 <= 0) & (e2 <= 0)));
  return _mm256_movemask_pd(accepted);
}

static inline void visit_block(struct pool *pool, struct slot *slot, const struct bvh *bvh) {
  const struct bvh_block *block = &bvh->block[slot->row];
  slot->accepted = block_accepts(slot, block);
  if (slot->accepted)
    send(pool, slot, QUEUE_HITS);
  else
    go_on_in_leaf(pool, slot, BVH_TRIANGLES, block->more);
}

// triangle_plane
static inline lanes block_plane(const struct ray *ray, const struct bvh_block *block) {
  lanes p[3][3];
#pragma GCC unroll 3
  for (uint32_t i = 0; i < 3; i++)
#pragma GCC unroll 3
    for (uint32_t k = 0; k < 3; k++) p[i][k] = corner(block, (int)i, 16 * k);
  lanes ax = p[0][0] - p[2][0], ay = p[0][1] - p[2][1], az = p[0][2] - p[2][2];
  lanes bx = p[1][0] - p[2][0], by = p[1][1] - p[2][1], bz = p[1][2] - p[2][2];
  lanes nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
  lanes x = p[0][0] - ray->o.x, y = p[0][1] - ray->o.y, z = p[0][2] - ray->o.z;
  return (nx * x + ny * y + nz * z) / (nx * ray->d.x + ny * ray->d.y + nz * ray->d.z);
}

// What waits and begins beyond the best t is dropped.
static inline void tighten(struct slot *slot) {
  float limit = (float)slot->search.best.t;
  if (!(limit < slot->limit)) return;
  slot->limit = limit;
  const __m256i in_order = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  int n = slot->n, kept = 1;
  for (int first = 1; first < n; first += 8) {
    __m256 near = _mm256_loadu_ps(slot->waiting_near + first);
    __m256i child = _mm256_loadu_si256((const __m256i *)(slot->waiting + first));
    __m256i left = _mm256_cmpgt_epi32(_mm256_set1_epi32(n - first), in_order);
    __m256 bound =
        _mm256_blendv_ps(_mm256_set1_ps(NAN), _mm256_set1_ps(limit), _mm256_castsi256_ps(left));
    kept += push(in_order, near, bound, child, slot->waiting_near + kept, slot->waiting + kept);
  }
  slot->n = kept;
}

static inline void end(struct pool *pool, struct slot *slot) { send(pool, slot, BVH_NOTHING); }

// clip_accept for four triangles.
static inline lanes block_clip(const struct slot *slot, const struct bvh_block *block, lanes *t) {
  lanes near = {0}, far = near + INFINITY;
#pragma GCC unroll 3
  for (int k = 0; k < 3; k++) {
    __m128 a = _mm_load_ps(block->vertex[0][k]), b = _mm_load_ps(block->vertex[1][k]),
           c = _mm_load_ps(block->vertex[2][k]);
    __m128 lo = _mm_min_ps(c, _mm_min_ps(a, b)), hi = _mm_max_ps(c, _mm_max_ps(a, b));
    bool backward = slot->octant >> k & 1;
    lanes first = (lanes)_mm256_cvtps_pd(backward ? hi : lo) - slot->cone_o[k];
    lanes last = (lanes)_mm256_cvtps_pd(backward ? lo : hi) - slot->cone_o[k];
    near = (lanes)_mm256_max_pd((__m256d)(first * slot->cone_near[k]), (__m256d)near);
    far = (lanes)_mm256_min_pd((__m256d)(last * slot->cone_far[k]), (__m256d)far);
  }
  // *t < near ? near : *t, and then *t > far ? far : *t
  *t = (lanes)_mm256_max_pd((__m256d)near, (__m256d)*t);
  *t = (lanes)_mm256_min_pd((__m256d)far, (__m256d)*t);
  return (lanes)((near <= far) & (*t > 0) & (*t < slot->search.ray->t_max));
}

// The triangle that a ray leaves.
struct left {
  float vertex[3][3];
  struct vec normal, p;
  double side;
};

static inline bool left_set(struct left *left, const struct bvh *bvh, const struct ray *ray) {
  uint32_t lane = bvh->lane[ray->leaving];
  if (lane == ROW_NONE) return false;
  const struct bvh_block *block = &bvh->block[lane / BVH_BLOCK];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) left->vertex[i][k] = block->vertex[i][k][lane % BVH_BLOCK];
  left->normal = triangle_cross((const float(*)[3])left->vertex);
  left->p = triangle_vertex(left->vertex[0]);
  left->side = vec_dot(left->normal, ray->d);
  return true;
}

// Which of four triangles have vertex i on the side the ray goes to.
static inline int vertices_ahead(const struct left *left, const struct bvh_block *block, int i) {
  lanes x = corner(block, i, 0) - left->p.x, y = corner(block, i, 16) - left->p.y,
        z = corner(block, i, 32) - left->p.z;
  lanes height = left->normal.x * x + left->normal.y * y + left->normal.z * z;
  return _mm256_movemask_pd((__m256d)(left->side > 0 ? height > 0 : height < 0));
}

static inline bool is_shared(const struct left *left, const struct bvh_block *block, int i,
                             int lane) {
  const float(*v)[BVH_BLOCK] = block->vertex[i];
  for (int j = 0; j < 3; j++)
    if (v[0][lane] == left->vertex[j][0] && v[1][lane] == left->vertex[j][1] &&
        v[2][lane] == left->vertex[j][2])
      return true;
  return false;
}

// triangle_is_left_behind of the triangles `bits` of a block; which of them are not.
static inline int not_left_behind(const struct slot *slot, const struct bvh *bvh,
                                  const struct bvh_block *block, int bits) {
  const struct ray *ray = slot->search.ray;
  struct left left;
  if (ray->leaving == PRIMITIVE_NONE) return bits;
  if (!left_set(&left, bvh, ray)) {
    for (int lane = 0; lane < BVH_BLOCK; lane++) {
      float vertex[3][3];
      for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) vertex[i][k] = block->vertex[i][k][lane];
      if (bits >> lane & 1 && triangle_is_left_behind(bvh->scene, ray, (const float(*)[3])vertex))
        bits &= ~(1 << lane);
    }
    return bits;
  }
  if (left.side == 0) return bits;
  int ahead[3];
  for (int i = 0; i < 3; i++) ahead[i] = vertices_ahead(&left, block, i);
  int kept = 0;
  for (int lane = 0; lane < BVH_BLOCK; lane++)
    for (int i = 0; i < 3 && bits >> lane & 1; i++)
      if (ahead[i] >> lane & 1 && !is_shared(&left, block, i, lane)) {
        kept |= 1 << lane;
        break;
      }
  return kept;
}

static inline int not_leaving(const struct bvh_block *block, const struct ray *ray) {
  __m128i same = _mm_cmpeq_epi32(_mm_load_si128((const __m128i *)block->primitive),
                                 _mm_set1_epi32((int)ray->leaving));
  return ~_mm_movemask_ps(_mm_castsi128_ps(same));
}

// Of an axis that is parallel cone_clip works in another way: one triangle after the other.
static bool visit_hits_parallel(struct slot *slot, const struct bvh *bvh,
                                const struct bvh_block *block, enum search_kind kind, int bits,
                                lanes t) {
  struct cone cone;
  cone_set(&cone, slot->search.ray);
  for (int lane = 0; lane < BVH_BLOCK; lane++)
    if (bits >> lane & 1 && search_triangle(bvh, &slot->search, kind, &cone, block, lane, t[lane]))
      return true;
  return false;
}

static inline bool keep_hits(struct slot *slot, const struct bvh *bvh,
                             const struct bvh_block *block, enum search_kind kind) {
  struct search *search = &slot->search;
  const struct ray *ray = search->ray;
  lanes t = block_plane(ray, block);
  lanes ahead = (lanes)((t > 0) & (t < INFINITY));
  int bits = slot->accepted & not_leaving(block, ray) & _mm256_movemask_pd((__m256d)ahead);
  if (slot->parallel) return visit_hits_parallel(slot, bvh, block, kind, bits, t);
  bits &= _mm256_movemask_pd((__m256d)block_clip(slot, block, &t));
  bits &= _mm256_movemask_pd((__m256d)(t <= search->best.t));
  bits = not_left_behind(slot, bvh, block, bits);
  for (int lane = 0; bits; lane++, bits >>= 1)
    if (bits & 1 && hit_is_before(t[lane], block->primitive[lane], &search->best) &&
        search_keep(bvh, search, kind, t[lane], block->primitive[lane]))
      return true;
  return false;
}

static inline void visit_hits(struct pool *pool, struct slot *slot, const struct bvh *bvh,
                              enum search_kind kind) {
  const struct bvh_block *block = &bvh->block[slot->row];
  if (keep_hits(slot, bvh, block, kind)) {
    end(pool, slot);
    return;
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
    end(pool, slot);
    return;
  }
  if (kind != SEARCH_ANY) tighten(slot);
  go_on_in_leaf(pool, slot, BVH_OTHERS, other->more);
}

// ---- the pool ----
static inline int take(struct pool *pool, int queue, struct slot *slot[POOL]) {
  int n = pool->count[queue];
  for (int i = 0; i < n; i++) slot[i] = pool->queue[queue][i];
  pool->count[queue] = 0;
  return n;
}

static inline __attribute__((always_inline)) void
run(const struct bvh *bvh, const struct queries *q, enum search_kind kind) {
  struct pool pool;
  struct slot *now[POOL];
  for (int k = 0; k < QUEUES; k++) pool.count[k] = 0;
  pool.base[BVH_NODE] = (const char *)bvh->node, pool.stride[BVH_NODE] = sizeof *bvh->node;
  pool.base[BVH_TRIANGLES] = (const char *)bvh->block;
  pool.stride[BVH_TRIANGLES] = sizeof *bvh->block;
  pool.base[BVH_OTHERS] = (const char *)bvh->other, pool.stride[BVH_OTHERS] = sizeof *bvh->other;
  pool.base[BVH_NOTHING] = (const char *)&pool, pool.stride[BVH_NOTHING] = 0;
  int next = 0, in_flight = 0;
  for (int k = 0; k < POOL; k++) in_flight += begin_next(&pool, &pool.slot[k], bvh, q, kind, &next);
  while (in_flight > 0) {
    int n = take(&pool, BVH_NODE, now);
    for (int i = 0; i < n; i++) visit_node(&pool, now[i], bvh);
    n = take(&pool, BVH_TRIANGLES, now);
    for (int i = 0; i < n; i++) visit_block(&pool, now[i], bvh);
    n = take(&pool, QUEUE_HITS, now);
    for (int i = 0; i < n; i++) visit_hits(&pool, now[i], bvh, kind);
    n = take(&pool, BVH_OTHERS, now);
    for (int i = 0; i < n; i++) visit_other(&pool, now[i], bvh, kind);
    n = take(&pool, BVH_NOTHING, now);
    for (int i = 0; i < n; i++) {
      search_end(&now[i]->search, q, now[i]->j, kind);
      in_flight -= !begin_next(&pool, now[i], bvh, q, kind, &next);
    }
  }
}

static bool fits(const struct bvh *bvh) {
  if ((BVH_WIDTH - 1) * (int)bvh->statistics.depth + 2 + BVH_WIDTH > MOST_WAITING) return false;
  for (int k = 0; k < 3; k++)
    if (!((double)bvh->box.lo[k] >= -LARGEST && (double)bvh->box.hi[k] <= LARGEST)) return false;
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

const struct search_level LEVEL_NAME(search_level) = {{closest, any, blocker}};
