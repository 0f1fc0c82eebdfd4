// The vector vocabulary of search.lanes.c: eight children of a node in AVX2 or AVX-512, and WIDE
// doubles, one of each of as many rays. No bit depends on the level.
#ifndef BVH_WIDE_H
#define BVH_WIDE_H

#ifdef __AVX2__
#include <immintrin.h>
#include <stdint.h>

#ifdef __AVX512F__
// Where near <= far, near and child go to the end of what waits, in `order`: far to near. How many.
static inline uint32_t push(__m256i order, __m256 near, __m256 far, __m256i child, float *to_near,
                            uint32_t *to_child) {
  near = _mm256_permutexvar_ps(order, near);
  far = _mm256_permutexvar_ps(order, far);
  child = _mm256_permutexvar_epi32(order, child);
  __mmask8 hit = _mm256_cmp_ps_mask(near, far, _CMP_LE_OQ);
  _mm256_storeu_ps(to_near, _mm256_maskz_compress_ps(hit, near));
  _mm256_storeu_si256((__m256i *)to_child, _mm256_maskz_compress_epi32(hit, child));
  return (uint32_t)__builtin_popcount(hit);
}

enum { WIDE = 8 };
typedef double wide __attribute__((vector_size(8 * WIDE)));
typedef __m256 narrow; // floats
typedef __m512i places;

static inline narrow gather(const void *from, places at) {
  return _mm512_i64gather_ps(at, from, sizeof(float));
}
static inline wide gather_double(const void *from, places at) {
  return (wide)_mm512_i64gather_pd(at, from, sizeof(double));
}
static inline wide widen(narrow x) { return (wide)_mm512_cvtps_pd(x); }
static inline places plus(places at, int64_t n) {
  return _mm512_add_epi64(at, _mm512_set1_epi64(n));
}
static inline wide least(wide a, wide b) { return (wide)_mm512_min_pd((__m512d)a, (__m512d)b); }
static inline wide greatest(wide a, wide b) { return (wide)_mm512_max_pd((__m512d)a, (__m512d)b); }
static inline unsigned less(wide a, wide b) {
  return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
}
static inline unsigned same(narrow a, narrow b) { return _mm256_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
#else
// [mask]: the lanes that are set, one a byte.
#define LANE(mask, lane)                                                                           \
  ((uint64_t)((mask) >> (lane)&1 ? (lane) : 0)                                                     \
   << 8 * __builtin_popcount((mask) & ((1 << (lane)) - 1)))
#define LANES_1(mask)                                                                              \
  LANE(mask, 0) | LANE(mask, 1) | LANE(mask, 2) | LANE(mask, 3) | LANE(mask, 4) | LANE(mask, 5) |  \
      LANE(mask, 6) | LANE(mask, 7)
#define LANES_4(mask) LANES_1(mask), LANES_1(mask + 1), LANES_1(mask + 2), LANES_1(mask + 3)
#define LANES_16(mask) LANES_4(mask), LANES_4(mask + 4), LANES_4(mask + 8), LANES_4(mask + 12)
#define LANES_64(mask) LANES_16(mask), LANES_16(mask + 16), LANES_16(mask + 32), LANES_16(mask + 48)
static const uint64_t lanes_of[256] = {LANES_64(0), LANES_64(64), LANES_64(128), LANES_64(192)};

static inline uint32_t push(__m256i order, __m256 near, __m256 far, __m256i child, float *to_near,
                            uint32_t *to_child) {
  near = _mm256_permutevar8x32_ps(near, order);
  far = _mm256_permutevar8x32_ps(far, order);
  child = _mm256_permutevar8x32_epi32(child, order);
  int hit = _mm256_movemask_ps(_mm256_cmp_ps(near, far, _CMP_LE_OQ));
  __m256i lane = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)lanes_of[hit]));
  _mm256_storeu_ps(to_near, _mm256_permutevar8x32_ps(near, lane));
  _mm256_storeu_si256((__m256i *)to_child, _mm256_permutevar8x32_epi32(child, lane));
  return (uint32_t)__builtin_popcount((unsigned)hit);
}

enum { WIDE = 4 };
typedef double wide __attribute__((vector_size(8 * WIDE)));
typedef __m128 narrow; // floats
typedef __m256i places;

static inline narrow gather(const void *from, places at) {
  return _mm256_i64gather_ps(from, at, sizeof(float));
}
static inline wide gather_double(const void *from, places at) {
  return (wide)_mm256_i64gather_pd(from, at, sizeof(double));
}
static inline wide widen(narrow x) { return (wide)_mm256_cvtps_pd(x); }
static inline places plus(places at, int64_t n) {
  return _mm256_add_epi64(at, _mm256_set1_epi64x(n));
}
static inline wide least(wide a, wide b) { return (wide)_mm256_min_pd((__m256d)a, (__m256d)b); }
static inline wide greatest(wide a, wide b) { return (wide)_mm256_max_pd((__m256d)a, (__m256d)b); }
static inline unsigned less(wide a, wide b) {
  return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
}
static inline unsigned same(narrow a, narrow b) {
  return (unsigned)_mm_movemask_ps(_mm_cmpeq_ps(a, b));
}
#endif
#endif

#endif
