// The vector vocabulary of NAME.lanes.c: as many doubles at a time as the level's registers hold.
// What the compiler lets be written as arithmetic (+ - * /) is; here is the rest. Every lane is the
// scalar operation, so no bit depends on the level. Comparisons are numeric/lanes.h's: gcc 12 folds
// masks of vectors of one lane wrongly.
#ifndef BASE_LANES_H
#define BASE_LANES_H

#include "base/exact.h"

#include <stdint.h>

#if defined __AVX512F__ || defined __AVX2__
#include <immintrin.h>
#endif

#ifdef __AVX512F__
enum { LANES = 8 };
#elif defined __AVX2__
enum { LANES = 4 };
#else
enum { LANES = 1 };
#endif

typedef double lanes __attribute__((vector_size(8 * LANES)));

static inline lanes lanes_set(double x) { return x - (lanes){0}; }

static inline lanes lanes_load(const double *x) {
  lanes a;
  __builtin_memcpy(&a, x, sizeof a);
  return a;
}

static inline void lanes_store(double *x, lanes a) { __builtin_memcpy(x, &a, sizeof a); }

static inline lanes lanes_sqrt(lanes a) {
#ifdef __AVX512F__
  return (lanes)_mm512_sqrt_pd((__m512d)a);
#elif defined __AVX2__
  return (lanes)_mm256_sqrt_pd((__m256d)a);
#else
  for (int j = 0; j < LANES; j++) a[j] = sqrt(a[j]);
  return a;
#endif
}

#endif
