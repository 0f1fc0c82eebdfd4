// rng_fill for the instruction sets of x86-64. All levels give the same bits; the highest one the
// machine has is used, or the one named by the environment variable PHOTONLAB_SIMD.
#ifndef NUMERIC_RNG_LEVEL_H
#define NUMERIC_RNG_LEVEL_H

#include "numeric/rng.h"

struct rng_level {
  const char *name;
  // rng_fill for the first paths, up to a multiple of the level's block; returns how many.
  int (*fill)(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
              double *u0, double *u1);
};

// Those this machine has, lowest first; returns how many.
enum { RNG_MOST_LEVELS = 4 };
int rng_levels(struct rng_level level[RNG_MOST_LEVELS]);

#endif
