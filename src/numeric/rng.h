// Random numbers are a function of (seed, run, purpose, iteration, path, dimension): Philox4x32-10
// (Salmon et al. 2011). Key = 64-bit hash of (seed, run, purpose); counter = iteration (48 bits),
// path (48 bits), dimension pair (32 bits). One block of four words gives one pair of numbers.
#ifndef NUMERIC_RNG_H
#define NUMERIC_RNG_H

#include <stdint.h>

enum rng_purpose {
  RNG_PHOTONS = 1,
  RNG_EYE,
  RNG_REFERENCE,
  RNG_TEST,
  RNG_TIME,
  RNG_RADII,
  RNG_RESAMPLE,
  RNG_CROSSINGS
};

struct rng_key {
  uint32_t word[2];
};

struct rng_key rng_key(uint64_t seed, uint64_t run, enum rng_purpose purpose);

// u0[j], u1[j] in [0, 1), multiples of 2^-53, for path[j], j < n.
void rng_fill(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
              double *u0, double *u1);

// The bare generator: the four words of one counter.
void rng_philox(struct rng_key key, const uint32_t counter[4], uint32_t out[4]);

// FNV-1a, 64 bits: seeds from names.
uint64_t rng_hash_name(const char *name);

#endif
