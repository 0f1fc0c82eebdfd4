// More of the vector vocabulary (base/lanes.h): some lanes of all (lanes_some), whole numbers, and
// sums. Sums of numeric/sum.h are SUM_PARTS vectors, part p with the lanes from p * LANES on.
#ifndef NUMERIC_LANES_H
#define NUMERIC_LANES_H

#include "base/lanes.h"
#include "numeric/sum.h"

#include <stdbool.h>

#if defined __AVX512F__
typedef __mmask8 lanes_some;
typedef uint32_t lanes_numbers __attribute__((vector_size(4 * LANES)));

static inline lanes lanes_truncate(lanes a) {
  return _mm512_roundscale_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
static inline lanes lanes_floor(lanes a) {
  return _mm512_roundscale_pd(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
static inline lanes lanes_min(lanes a, lanes b) { return _mm512_min_pd(a, b); }
static inline lanes lanes_max(lanes a, lanes b) { return _mm512_max_pd(a, b); }
static inline lanes_numbers lanes_to_numbers(lanes a) {
  return (lanes_numbers)_mm512_cvttpd_epi32(a);
}
static inline lanes lanes_power_of_two(lanes k) {
  __m512i low = _mm512_castpd_si512(k + (0x1p52 + 1023));
  return _mm512_castsi512_pd(_mm512_slli_epi64(low, 52));
}

static inline lanes_some lanes_less(lanes a, lanes b) {
  return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
}
static inline lanes_some lanes_at_most(lanes a, lanes b) {
  return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
}
static inline lanes_some lanes_and(lanes_some a, lanes_some b) { return a & b; }
static inline lanes_some lanes_or(lanes_some a, lanes_some b) { return a | b; }
static inline lanes_some lanes_alike(lanes_some a, lanes_some b) { return (lanes_some) ~(a ^ b); }
static inline lanes_some lanes_without_bit(const uint64_t *x, int bit) {
  return _mm512_testn_epi64_mask(_mm512_loadu_si512(x), _mm512_set1_epi64((int64_t)1 << bit));
}
static inline lanes lanes_choose(lanes_some some, lanes a, lanes b) {
  return _mm512_mask_mov_pd(b, some, a);
}
static inline lanes_some lanes_first(int n) { // n >= 0
  return (lanes_some)(n < LANES ? (1 << n) - 1 : 0xff);
}
static inline int lanes_count(lanes_some some) { return __builtin_popcount(some); }

static inline lanes lanes_where(lanes_some some, lanes a) { return _mm512_maskz_mov_pd(some, a); }
static inline lanes lanes_load_where(lanes_some some, const double *x) {
  return _mm512_maskz_loadu_pd(some, x);
}
static inline void lanes_store_where(lanes_some some, double *x, lanes a) {
  _mm512_mask_storeu_pd(x, some, a);
}
static inline void lanes_load_triples(const double *x, lanes a[3]) {
  static const int64_t two[3][8] = {
      {0, 3, 6, 9, 12, 15, 0, 0}, {1, 4, 7, 10, 13, 0, 0, 0}, {2, 5, 8, 11, 14, 0, 0, 0}};
  static const int64_t three[3][8] = {
      {0, 1, 2, 3, 4, 5, 10, 13}, {0, 1, 2, 3, 4, 8, 11, 14}, {0, 1, 2, 3, 4, 9, 12, 15}};
  __m512d first = lanes_load(x), second = lanes_load(x + 8), third = lanes_load(x + 16);
  for (int c = 0; c < 3; c++) {
    __m512d begin = _mm512_permutex2var_pd(first, _mm512_loadu_si512(two[c]), second);
    a[c] = _mm512_permutex2var_pd(begin, _mm512_loadu_si512(three[c]), third);
  }
}
static inline void lanes_pack(lanes_some some, double *x, lanes a) {
  _mm512_storeu_pd(x, _mm512_maskz_compress_pd(some, a));
}
static inline void lanes_pack_numbers(lanes_some some, uint32_t *to, uint32_t from) {
  __m256i number =
      _mm256_add_epi32(_mm256_set1_epi32((int32_t)from), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  _mm256_storeu_si256((__m256i *)to, _mm256_maskz_compress_epi32(some, number));
}

#elif defined __AVX2__
typedef __m256d lanes_some;
typedef uint32_t lanes_numbers __attribute__((vector_size(4 * LANES)));

static inline lanes lanes_truncate(lanes a) {
  return _mm256_round_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
static inline lanes lanes_floor(lanes a) {
  return _mm256_round_pd(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
static inline lanes lanes_min(lanes a, lanes b) { return _mm256_min_pd(a, b); }
static inline lanes lanes_max(lanes a, lanes b) { return _mm256_max_pd(a, b); }
static inline lanes_numbers lanes_to_numbers(lanes a) {
  return (lanes_numbers)_mm256_cvttpd_epi32(a);
}
static inline lanes lanes_power_of_two(lanes k) {
  __m256i low = _mm256_castpd_si256(k + (0x1p52 + 1023));
  return _mm256_castsi256_pd(_mm256_slli_epi64(low, 52));
}

static inline lanes_some lanes_less(lanes a, lanes b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
static inline lanes_some lanes_at_most(lanes a, lanes b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
static inline lanes_some lanes_and(lanes_some a, lanes_some b) { return _mm256_and_pd(a, b); }
static inline lanes_some lanes_or(lanes_some a, lanes_some b) { return _mm256_or_pd(a, b); }
static inline lanes_some lanes_alike(lanes_some a, lanes_some b) {
  return _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_castpd_si256(a), _mm256_castpd_si256(b)));
}
static inline lanes_some lanes_without_bit(const uint64_t *x, int bit) {
  __m256i b = _mm256_set1_epi64x((int64_t)1 << bit), a = _mm256_loadu_si256((const __m256i *)x);
  return _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(a, b), _mm256_setzero_si256()));
}
static inline lanes lanes_choose(lanes_some some, lanes a, lanes b) {
  return _mm256_blendv_pd(b, a, some);
}
static inline lanes_some lanes_first(int n) {
  return lanes_less(_mm256_setr_pd(0, 1, 2, 3), lanes_set(n));
}
static inline unsigned lanes_bits(lanes_some some) { return (unsigned)_mm256_movemask_pd(some); }
static inline int lanes_count(lanes_some some) { return __builtin_popcount(lanes_bits(some)); }

static inline lanes lanes_where(lanes_some some, lanes a) { return _mm256_and_pd(some, a); }
static inline lanes lanes_load_where(lanes_some some, const double *x) {
  return _mm256_maskload_pd(x, _mm256_castpd_si256(some));
}
static inline void lanes_store_where(lanes_some some, double *x, lanes a) {
  _mm256_maskstore_pd(x, _mm256_castpd_si256(some), a);
}

static inline void lanes_load_triples(const double *x, lanes a[3]) {
  __m256d first = lanes_load(x), second = lanes_load(x + 4), third = lanes_load(x + 8);
  __m256d xy = _mm256_blend_pd(first, second, 0xc);        // x0 y0 x2 y2
  __m256d zx = _mm256_permute2f128_pd(first, third, 0x21); // z0 x1 z2 x3
  __m256d yz = _mm256_blend_pd(second, third, 0xc);        // y1 z1 y3 z3
  a[0] = _mm256_shuffle_pd(xy, zx, 0xa);
  a[1] = _mm256_shuffle_pd(xy, yz, 0x5);
  a[2] = _mm256_shuffle_pd(zx, yz, 0xa);
}

// Which halves of doubles go to the front, by the some's bits.
#define HALVES(k) 2 * (k), 2 * (k) + 1
static const int32_t lanes_order[16][8] = {
    {0},
    {HALVES(0)},
    {HALVES(1)},
    {HALVES(0), HALVES(1)},
    {HALVES(2)},
    {HALVES(0), HALVES(2)},
    {HALVES(1), HALVES(2)},
    {HALVES(0), HALVES(1), HALVES(2)},
    {HALVES(3)},
    {HALVES(0), HALVES(3)},
    {HALVES(1), HALVES(3)},
    {HALVES(0), HALVES(1), HALVES(3)},
    {HALVES(2), HALVES(3)},
    {HALVES(0), HALVES(2), HALVES(3)},
    {HALVES(1), HALVES(2), HALVES(3)},
    {HALVES(0), HALVES(1), HALVES(2), HALVES(3)},
};
#undef HALVES

static inline __m256i lanes_packed(lanes_some some, __m256i a) {
  const __m256i *order = (const __m256i *)lanes_order[lanes_bits(some)];
  return _mm256_permutevar8x32_epi32(a, _mm256_loadu_si256(order));
}
static inline void lanes_pack(lanes_some some, double *x, lanes a) {
  _mm256_storeu_pd(x, _mm256_castsi256_pd(lanes_packed(some, _mm256_castpd_si256(a))));
}
static inline void lanes_pack_numbers(lanes_some some, uint32_t *to, uint32_t from) {
  __m256i number = _mm256_add_epi64(_mm256_set1_epi64x(from), _mm256_setr_epi64x(0, 1, 2, 3));
  __m256 packed = _mm256_castsi256_ps(lanes_packed(some, number));
  __m128 low = _mm_shuffle_ps(_mm256_castps256_ps128(packed), _mm256_extractf128_ps(packed, 1),
                              _MM_SHUFFLE(2, 0, 2, 0));
  _mm_storeu_ps((float *)to, low);
}

#else
typedef bool lanes_some;
typedef uint32_t lanes_numbers;

static inline lanes lanes_truncate(lanes a) { return lanes_set((double)(int)a[0]); } // |a| < 2^31
static inline lanes lanes_floor(lanes a) {                                           // |a| < 2^63
  int64_t truncated = (int64_t)a[0];
  return lanes_set((double)(truncated - (a[0] < (double)truncated)));
}
// b where either is NaN.
static inline lanes lanes_min(lanes a, lanes b) { return lanes_set(a[0] < b[0] ? a[0] : b[0]); }
static inline lanes lanes_max(lanes a, lanes b) { return lanes_set(a[0] > b[0] ? a[0] : b[0]); }
static inline lanes_numbers lanes_to_numbers(lanes a) { return (uint32_t)a[0]; } // 0 <= a < 2^31
// 2^k of whole numbers -1022 <= k <= 1023.
static inline lanes lanes_power_of_two(lanes k) {
  int64_t bits = ((int64_t)k[0] + 1023) << 52;
  return lanes_load((const double *)&bits);
}

static inline lanes_some lanes_less(lanes a, lanes b) { return a[0] < b[0]; }
static inline lanes_some lanes_at_most(lanes a, lanes b) { return a[0] <= b[0]; }
static inline lanes_some lanes_and(lanes_some a, lanes_some b) { return a & b; }
static inline lanes_some lanes_or(lanes_some a, lanes_some b) { return a | b; }
// Where both are, or neither.
static inline lanes_some lanes_alike(lanes_some a, lanes_some b) { return a == b; }
static inline lanes_some lanes_without_bit(const uint64_t *x, int bit) { return !(*x >> bit & 1); }
static inline lanes lanes_choose(lanes_some some, lanes a, lanes b) { return some ? a : b; }
static inline lanes_some lanes_first(int n) { return n > 0; } // of the lanes
static inline int lanes_count(lanes_some some) { return some; }

// 0 in other lanes: there nothing is loaded, or stored.
static inline lanes lanes_where(lanes_some some, lanes a) { return some ? a : lanes_set(0); }
static inline lanes lanes_load_where(lanes_some some, const double *x) {
  return lanes_set(some ? *x : 0);
}
static inline void lanes_store_where(lanes_some some, double *x, lanes a) {
  if (some) *x = a[0];
}
// x[0], x[3], ...; x[1], x[4], ...; x[2], x[5], ...
static inline void lanes_load_triples(const double *x, lanes a[3]) {
  for (int c = 0; c < 3; c++) a[c] = lanes_set(x[c]);
}
// These lanes to x[0], x[1], ...; what is behind them, up to LANES, is lost.
static inline void lanes_pack(lanes_some some, double *x, lanes a) {
  (void)some;
  *x = a[0];
}
// The same of from, from + 1, ...
static inline void lanes_pack_numbers(lanes_some some, uint32_t *to, uint32_t from) {
  (void)some;
  *to = from;
}
#endif

enum { SUM_PARTS = SUM_LANES / LANES };

static inline double lanes_total(const lanes part[SUM_PARTS]) {
  double lane[SUM_LANES];
  for (int p = 0; p < SUM_PARTS; p++) lanes_store(lane + p * LANES, part[p]);
  return sum_lanes(lane);
}

#endif
