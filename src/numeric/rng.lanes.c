// The body of rng_fill: Philox on BLOCK paths at once. A lane holds a 32-bit word in its low half;
// what is in the high half is never used.
#include "base/lanes.h"
#include "numeric/rng_level.h"

#if defined __AVX512F__ || defined __AVX2__
typedef uint64_t words __attribute__((vector_size(8 * LANES)));

// The level's instruction, 64-bit products of the lanes' low halves: gcc does not see that masked
// products are just this.
static inline words multiply(words a, words b) {
#ifdef __AVX512F__
  return (words)_mm512_mul_epu32((__m512i)a, (__m512i)b);
#else
  return (words)_mm256_mul_epu32((__m256i)a, (__m256i)b);
#endif
}

enum { VECTORS = 2, BLOCK = LANES * VECTORS }; // two in flight hide some of the latency

static int fill(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
                double *u0, double *u1) {
  const words zero = {0}, low = zero + UINT32_MAX;
  const words m0 = zero + RNG_MULTIPLIER0, m1 = zero + RNG_MULTIPLIER1;
  int done = 0;
  for (; done + BLOCK <= n; done += BLOCK) {
    words c[VECTORS][4];
    for (int v = 0; v < VECTORS; v++) {
      __builtin_memcpy(&c[v][1], path + done + v * LANES, sizeof c[v][1]);
      c[v][0] = zero + pair;
      c[v][2] = c[v][1] >> 32 | (zero + ((iteration & 0xffff) << 16));
      c[v][3] = zero + (iteration >> 16);
    }
    uint32_t k0 = key.word[0], k1 = key.word[1];
    for (int round = 0; round < RNG_ROUNDS; round++, k0 += RNG_WEYL0, k1 += RNG_WEYL1)
      for (int v = 0; v < VECTORS; v++) {
        words p0 = multiply(c[v][0], m0), p1 = multiply(c[v][2], m1);
        c[v][0] = p1 >> 32 ^ c[v][1] ^ (zero + k0);
        c[v][1] = p1;
        c[v][2] = p0 >> 32 ^ c[v][3] ^ (zero + k1);
        c[v][3] = p0;
      }
    // The top 53 bits times 2^-53. There is no conversion from 64-bit integers before AVX-512, so
    // each half is placed under the exponent where it has its weight: 2^84 + 2^32 a and 2^52 + b.
    // Every step is exact.
    for (int v = 0; v < VECTORS; v++)
      for (int u = 0; u < 2; u++) {
        words bits = (c[v][2 * u + 1] << 32 | (c[v][2 * u] & low)) >> 11;
        lanes a = (lanes)(bits >> 32 | (zero + 0x4530000000000000));
        lanes b = (lanes)((bits & low) | (zero + 0x4330000000000000));
        lanes x = ((a - (0x1p84 + 0x1p52)) + b) * 0x1p-53;
        lanes_store((u == 0 ? u0 : u1) + done + v * LANES, x);
      }
  }
  return done;
}
#else
static int fill(struct rng_key key, uint64_t iteration, const uint64_t *path, int n, uint32_t pair,
                double *u0, double *u1) {
  (void)key, (void)iteration, (void)path, (void)n, (void)pair, (void)u0, (void)u1;
  return 0;
}
#endif

const struct rng_level SIMD_NAME(rng_level) = {fill};
