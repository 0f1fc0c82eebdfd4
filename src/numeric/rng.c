// Philox4x32-10: ten rounds of two 32 x 32 -> 64 bit products and four exclusive ors a block.
#include "numeric/rng.h"
#include "numeric/rng_level.h"

#include <assert.h>

void rng_philox(struct rng_key key, const uint32_t counter[4], uint32_t out[4]) {
  uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
  uint32_t k0 = key.word[0], k1 = key.word[1];
  for (int round = 0; round < RNG_ROUNDS; round++) {
    uint64_t p0 = (uint64_t)RNG_MULTIPLIER0 * c0, p1 = (uint64_t)RNG_MULTIPLIER1 * c2;
    c0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
    c1 = (uint32_t)p1;
    c2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
    c3 = (uint32_t)p0;
    k0 += RNG_WEYL0;
    k1 += RNG_WEYL1;
  }
  out[0] = c0;
  out[1] = c1;
  out[2] = c2;
  out[3] = c3;
}

// u0, u1 of one path: the top 53 bits of words (0, 1) and (2, 3), the second of each on top.
static void fill_one(struct rng_key key, uint64_t iteration, uint64_t path, uint32_t pair,
                     double *u0, double *u1) {
  uint32_t out[4];
  const uint32_t counter[4] = {pair, (uint32_t)path,
                               (uint32_t)(path >> 32) | (uint32_t)(iteration & 0xffff) << 16,
                               (uint32_t)(iteration >> 16)};
  rng_philox(key, counter, out);
  *u0 = (double)(((uint64_t)out[1] << 32 | out[0]) >> 11) * 0x1p-53;
  *u1 = (double)(((uint64_t)out[3] << 32 | out[2]) >> 11) * 0x1p-53;
}

void rng_fill(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
              double *u0, double *u1) {
  uint64_t all = iteration;
  for (int j = 0; j < n; j++) all |= path[j];
  assert(all >> 48 == 0);
  int done = SIMD_TABLE(rng_level)->fill(key, iteration, path, n, pair, u0, u1);
  for (int j = done; j < n; j++) fill_one(key, iteration, path[j], pair, &u0[j], &u1[j]);
}

// The finaliser of splitmix64 (Steele, Lea, Flood 2014; constants of Stafford's mix 13): a
// bijection.
static uint64_t mix(uint64_t x) {
  x += 0x9E3779B97F4A7C15;
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9;
  x = (x ^ x >> 27) * 0x94D049BB133111EB;
  return x ^ x >> 31;
}

struct rng_key rng_key(uint64_t seed, uint64_t run, enum rng_purpose purpose) {
  uint64_t hash = mix(mix(mix(seed) ^ run) ^ (uint64_t)purpose);
  return (struct rng_key){{(uint32_t)hash, (uint32_t)(hash >> 32)}};
}

uint64_t rng_hash_name(const char *name) {
  uint64_t hash = 0xcbf29ce484222325;
  for (; *name; name++) hash = (hash ^ (unsigned char)*name) * 0x100000001b3;
  return hash;
}
