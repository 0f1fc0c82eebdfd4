// Philox4x32-10: ten rounds of two 32 x 32 -> 64 bit products and four exclusive ors a block.
#include "numeric/rng.h"

#include <assert.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

enum { ROUNDS = 10 };
static const uint32_t multiplier0 = 0xD2511F53, multiplier1 = 0xCD9E8D57;
static const uint32_t weyl0 = 0x9E3779B9, weyl1 = 0xBB67AE85; // golden ratio, sqrt(3) - 1

void rng_philox(struct rng_key key, const uint32_t counter[4], uint32_t out[4]) {
  uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
  uint32_t k0 = key.word[0], k1 = key.word[1];
  for (int round = 0; round < ROUNDS; round++) {
    uint64_t p0 = (uint64_t)multiplier0 * c0, p1 = (uint64_t)multiplier1 * c2;
    c0 = (uint32_t)(p1 >> 32) ^ c1 ^ k0;
    c1 = (uint32_t)p1;
    c2 = (uint32_t)(p0 >> 32) ^ c3 ^ k1;
    c3 = (uint32_t)p0;
    k0 += weyl0;
    k1 += weyl1;
  }
  out[0] = c0;
  out[1] = c1;
  out[2] = c2;
  out[3] = c3;
}

// The top 53 of 64 bits.
static double unit_interval(uint32_t low, uint32_t high) {
  uint64_t bits = ((uint64_t)high << 32 | low) >> 11;
  return (double)bits * 0x1p-53;
}

static void fill_one(struct rng_key key, uint64_t iteration, uint64_t path, uint32_t pair,
                     double *u0, double *u1) {
  uint32_t out[4];
  const uint32_t counter[4] = {pair, (uint32_t)path,
                               (uint32_t)(path >> 32) | (uint32_t)(iteration & 0xffff) << 16,
                               (uint32_t)(iteration >> 16)};
  rng_philox(key, counter, out);
  *u0 = unit_interval(out[0], out[1]);
  *u1 = unit_interval(out[2], out[3]);
}

void rng_fill(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
              double *u0, double *u1) {
  assert(iteration >> 48 == 0);
  for (int j = 0; j < n; j++) {
    assert(path[j] >> 48 == 0);
    fill_one(key, iteration, path[j], pair, &u0[j], &u1[j]);
  }
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
