// The bodies of rng_fill.
#ifndef NUMERIC_RNG_LEVEL_H
#define NUMERIC_RNG_LEVEL_H

#include "base/simd.h"
#include "numeric/rng.h"

enum { RNG_ROUNDS = 10 };
#define RNG_MULTIPLIER0 UINT32_C(0xD2511F53)
#define RNG_MULTIPLIER1 UINT32_C(0xCD9E8D57)
#define RNG_WEYL0 UINT32_C(0x9E3779B9) // golden ratio
#define RNG_WEYL1 UINT32_C(0xBB67AE85) // sqrt(3) - 1

struct rng_level {
  // rng_fill for the first paths, up to a multiple of the level's block; returns how many.
  int (*fill)(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
              double *u0, double *u1);
};
SIMD_TABLES(rng_level);

#endif
