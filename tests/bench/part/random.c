#include "tests/bench/bench.h"

#include "numeric/rng.h"

enum { N = 4096, ROUNDS = 256 };

static struct random {
  uint64_t path[N];
  double u[2][N];
} state;

static void fill(void *data, int repetition) {
  struct random *random = data;
  (void)repetition;
  for (uint32_t pair = 0; pair < ROUNDS; pair++)
    rng_fill(rng_key(1, 1, RNG_TEST), 1, random->path, N, pair, random->u[0], random->u[1]);
}

static uint64_t hash(const void *data) {
  const struct random *random = data;
  return bench_hash(random->u, sizeof random->u);
}

// One at a time takes the scalar way.
static bool equals_scalar(const struct random *random) {
  for (int j = 0; j < N; j++) {
    double u0, u1;
    rng_fill(rng_key(1, 1, RNG_TEST), 1, &random->path[j], 1, ROUNDS - 1, &u0, &u1);
    if (u0 != random->u[0][j] || u1 != random->u[1][j]) return false;
  }
  return true;
}

static void rows(struct bench *bench) {
  for (int j = 0; j < N; j++) state.path[j] = (uint64_t)j;
  fill(&state, 0);
  bench_check(equals_scalar(&state), "a batch and single paths differ", "random");
  bench_add(bench, "random",
            (struct row){.name = "fill",
                         .kind = RATE,
                         .unit = "Mnumbers/s",
                         .work = 2e-6 * N * ROUNDS,
                         .body = fill,
                         .data = &state,
                         .hash = hash});
}

const struct part_type part_random = {
    "random", "random numbers, in pairs for batches of 4096 paths", 9, rows};
