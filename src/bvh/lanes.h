// The vector vocabulary of the tree: two triangles or two boxes at a time, which every x86-64 and
// AArch64 has. Every lane is the scalar operation, so no bit depends on it.
#ifndef BVH_LANES_H
#define BVH_LANES_H

#include <stdint.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

enum { LANES = 2 };

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t lanes_mask __attribute__((vector_size(8 * LANES)));
typedef float lanes_float __attribute__((vector_size(4 * LANES)));

static inline lanes lanes_from(lanes_float x) { return __builtin_convertvector(x, lanes); }
static inline lanes lanes_set(double x) { return (lanes){x, x}; }

// Bit j: lane j is set.
static inline unsigned lanes_bits(lanes_mask mask) {
#ifdef __SSE2__
  return (unsigned)_mm_movemask_pd((__m128d)mask);
#else
  return (unsigned)((mask[0] & 1) | (mask[1] & 2));
#endif
}

// a > b ? a : b and a < b ? a : b in each lane: b where either is NaN.
static inline lanes lanes_max(lanes a, lanes b) {
#ifdef __SSE2__
  return _mm_max_pd(a, b);
#else
  return (lanes){a[0] > b[0] ? a[0] : b[0], a[1] > b[1] ? a[1] : b[1]};
#endif
}

static inline lanes lanes_min(lanes a, lanes b) {
#ifdef __SSE2__
  return _mm_min_pd(a, b);
#else
  return (lanes){a[0] < b[0] ? a[0] : b[0], a[1] < b[1] ? a[1] : b[1]};
#endif
}

#endif
