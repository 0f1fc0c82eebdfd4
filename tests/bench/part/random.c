#include "tests/bench/bench.h"

#include "base/simd.h"
#include "numeric/rng.h"

enum { N = 4096, PAIRS = 256 };

static struct random {
  uint64_t path[N];
  enum simd level;
  double u[2][N];
} state[SIMD_LEVELS];

static void fill(void *data, int repetition) {
  struct random *random = data;
  struct rng_key key = rng_key(1, 1, RNG_TEST);
  (void)repetition;
  enum simd chosen = simd_chosen();
  simd_choose(random->level);
  for (uint32_t pair = 0; pair < PAIRS; pair++)
    rng_fill(key, 1, random->path, N, pair, random->u[0], random->u[1]);
  simd_choose(chosen);
}

static uint64_t hash(const void *data) {
  const struct random *random = data;
  return bench_hash(random->u, sizeof random->u);
}

static void add(struct bench *bench, struct random *random, const char *name, const char *base) {
  bench_add(bench, "random",
            (struct row){.name = name,
                         .kind = RATE,
                         .unit = "Mnumbers/s",
                         .work = 2e-6 * N * PAIRS,
                         .body = fill,
                         .data = random,
                         .hash = hash,
                         .base = base});
}

// One path at a time: no block of any level is full.
static bool equals_single(const struct random *random) {
  for (int j = 0; j < N; j++) {
    double u0, u1;
    rng_fill(rng_key(1, 1, RNG_TEST), 1, &random->path[j], 1, PAIRS - 1, &u0, &u1);
    if (u0 != random->u[0][j] || u1 != random->u[1][j]) return false;
  }
  return true;
}

static void rows(struct bench *bench) {
  for (int level = 0; level <= (int)simd_best(); level++) {
    struct random *random = &state[level];
    for (int j = 0; j < N; j++) random->path[j] = (uint64_t)j;
    random->level = (enum simd)level;
    fill(random, 0);
    bench_check(equals_single(random), "a batch and single paths differ", simd_names[level]);
    add(bench, random, simd_names[level], level ? simd_names[0] : NULL);
  }
}

const struct part_type part_random = {"random", "numbers for batches of 4096 paths, by each level",
                                      9, rows};
