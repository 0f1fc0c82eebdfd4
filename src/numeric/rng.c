// Philox4x32-10: ten rounds of two 32 x 32 -> 64 bit products and four exclusive ors a block.
#include "numeric/rng.h"

#include <assert.h>
#include <string.h>

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

// The same for BLOCK paths at once. A lane holds a 32-bit word in its low half; what is in the
// high half is never used.
typedef uint64_t lanes __attribute__((vector_size(16)));
typedef double lanes_double __attribute__((vector_size(16)));
enum { WIDTH = 2, VECTORS = 4, BLOCK = WIDTH * VECTORS };

static inline lanes lanes_all(uint64_t x) { return (lanes){x, x}; }

// The 64-bit product of the low halves.
static inline lanes lanes_multiply(lanes a, lanes b) {
#ifdef __SSE2__ // gcc does not see that the masks below are what pmuludq does
  return (lanes)_mm_mul_epu32((__m128i)a, (__m128i)b);
#else
  return (a & lanes_all(UINT32_MAX)) * (b & lanes_all(UINT32_MAX));
#endif
}

// The top 53 bits of high:low times 2^-53. SSE2 cannot convert 64-bit integers, so each half is
// placed under the exponent where it has its weight: 2^84 + 2^32 a, 2^52 + b. Every step is exact.
static inline lanes_double lanes_unit_interval(lanes low, lanes high) {
  lanes bits = (high << 32 | (low & lanes_all(UINT32_MAX))) >> 11;
  lanes_double a = (lanes_double)(bits >> 32 | lanes_all(0x4530000000000000));
  lanes_double b = (lanes_double)((bits & lanes_all(UINT32_MAX)) | lanes_all(0x4330000000000000));
  const double both = 0x1p84 + 0x1p52, unit = 0x1p-53;
  return ((a - (lanes_double){both, both}) + b) * (lanes_double){unit, unit};
}

static void fill_block(struct rng_key key, uint64_t iteration, const uint64_t *path, uint32_t pair,
                       double *u0, double *u1) {
  lanes c0[VECTORS], c1[VECTORS], c2[VECTORS], c3[VECTORS];
  for (int v = 0; v < VECTORS; v++) {
    memcpy(&c1[v], path + v * WIDTH, sizeof c1[v]);
    c0[v] = lanes_all(pair);
    c2[v] = c1[v] >> 32 | lanes_all((iteration & 0xffff) << 16);
    c3[v] = lanes_all(iteration >> 16);
  }
  uint32_t k0 = key.word[0], k1 = key.word[1];
  for (int round = 0; round < ROUNDS; round++) {
    for (int v = 0; v < VECTORS; v++) {
      lanes p0 = lanes_multiply(c0[v], lanes_all(multiplier0));
      lanes p1 = lanes_multiply(c2[v], lanes_all(multiplier1));
      c0[v] = p1 >> 32 ^ c1[v] ^ lanes_all(k0);
      c1[v] = p1;
      c2[v] = p0 >> 32 ^ c3[v] ^ lanes_all(k1);
      c3[v] = p0;
    }
    k0 += weyl0;
    k1 += weyl1;
  }
  for (int v = 0; v < VECTORS; v++) {
    lanes_double x = lanes_unit_interval(c0[v], c1[v]), y = lanes_unit_interval(c2[v], c3[v]);
    memcpy(u0 + v * WIDTH, &x, sizeof x);
    memcpy(u1 + v * WIDTH, &y, sizeof y);
  }
}

void rng_fill(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
              double *u0, double *u1) {
  uint64_t all = iteration;
  for (int j = 0; j < n; j++) all |= path[j];
  assert(all >> 48 == 0);
  int j = 0;
  for (; j + BLOCK <= n; j += BLOCK) fill_block(key, iteration, path + j, pair, u0 + j, u1 + j);
  for (; j < n; j++) fill_one(key, iteration, path[j], pair, &u0[j], &u1[j]);
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
