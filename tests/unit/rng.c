// Random numbers: Random123 as the oracle, then what a Monte Carlo estimate depends on.
#include "numeric/rng.h"
#include "numeric/rng_level.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <Random123/philox.h>
#pragma GCC diagnostic pop

static const uint64_t last48 = ((uint64_t)1 << 48) - 1;

static struct rng_key key_of_test(const char *name, uint64_t run) {
  return rng_key(rng_hash_name(name), run, RNG_TEST);
}

static void philox_gives_the_known_answers_of_random123(void **state) {
  (void)state;
  // Random123's kat_vectors: philox4x32 10.
  static const struct {
    uint32_t counter[4];
    struct rng_key key;
    uint32_t out[4];
  } known[] = {
      {{0, 0, 0, 0}, {{0, 0}}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
      {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
       {{0xffffffff, 0xffffffff}},
       {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
      {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
       {{0xa4093822, 0x299f31d0}},
       {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
  };
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
    uint32_t out[4];
    rng_philox(known[k].key, known[k].counter, out);
    assert_memory_equal(out, known[k].out, sizeof out);
  }
}

static void philox_equals_random123_on_a_million_words(void **state) {
  (void)state;
  uint32_t word[6] = {1, 2, 3, 4, 5, 6}; // a walk: each answer is the next question
  for (int k = 0; k < 250000; k++) {
    struct rng_key key = {{word[4], word[5]}};
    philox4x32_ctr_t counter = {{word[0], word[1], word[2], word[3]}};
    philox4x32_key_t oracle_key = {{key.word[0], key.word[1]}};
    philox4x32_ctr_t want = philox4x32(counter, oracle_key);
    uint32_t out[4];
    rng_philox(key, word, out);
    assert_memory_equal(out, want.v, sizeof out);
    word[4] = word[0] ^ word[5];
    word[5] = word[1] + 0x9E3779B9;
    memcpy(word, out, sizeof out);
  }
}

// The layout of the counter, straight from rng.h.
static void expected_pair(struct rng_key key, uint64_t iteration, uint64_t path, uint32_t pair,
                          double u[2]) {
  const uint32_t counter[4] = {
      pair,
      (uint32_t)path,
      (uint32_t)(path >> 32) | (uint32_t)((iteration & 0xffff) << 16),
      (uint32_t)(iteration >> 16),
  };
  uint32_t out[4];
  rng_philox(key, counter, out);
  u[0] = ldexp((double)(((uint64_t)out[1] << 32 | out[0]) >> 11), -53);
  u[1] = ldexp((double)(((uint64_t)out[3] << 32 | out[2]) >> 11), -53);
}

static void every_level_equals_philox_for_every_length_and_counter(void **state) {
  (void)state;
  enum { MOST = 37 };
  const uint64_t iterations[] = {0, 1, 0xffff, 0x10000, 0x123456789abc, last48};
  const uint32_t pairs[] = {0, 77, UINT32_MAX};
  struct rng_key key = key_of_test(__func__, 1);
  uint64_t path[MOST];
  for (int j = 0; j < MOST; j++) path[j] = j % 3 ? (0xfedcba987654 >> j) + (uint64_t)j : last48 - j;
  for (int level = 0; level <= (int)simd_best(); level++) {
    simd_choose((enum simd)level);
    for (int n = 0; n <= MOST; n++)
      for (int i = 0; i < 6; i++)
        for (int p = 0; p < 3; p++) {
          double u0[MOST + 1], u1[MOST + 1], want[2];
          for (int j = 0; j <= MOST; j++) u0[j] = u1[j] = 2.385;
          int done = SIMD_TABLE(rng_level)->fill(key, iterations[i], path, n, pairs[p], u0, u1);
          assert_in_range(done, n < 16 || level == SIMD_SCALAR ? 0 : 16, n);
          for (int j = 0; j < done; j++) {
            expected_pair(key, iterations[i], path[j], pairs[p], want);
            assert_true(u0[j] == want[0] && u1[j] == want[1]);
          }
          assert_true(u0[done] == 2.385 && u1[done] == 2.385); // nothing behind the end
        }
  }
  print_message("highest level: %s\n", simd_names[simd_best()]);
}

// The level's blocks and the rest, whatever n.
static void fill_equals_philox_for_every_length(void **state) {
  (void)state;
  enum { MOST = 70 };
  struct rng_key key = key_of_test(__func__, 1);
  uint64_t path[MOST];
  for (int j = 0; j < MOST; j++) path[j] = 977 * (uint64_t)j;
  for (int n = 0; n < MOST; n++) {
    double u0[MOST], u1[MOST], want[2];
    u0[n] = u1[n] = 2.385;
    rng_fill(key, 12, path, n, 3, u0, u1);
    for (int j = 0; j < n; j++) {
      expected_pair(key, 12, path[j], 3, want);
      assert_true(u0[j] == want[0] && u1[j] == want[1]);
    }
    assert_true(u0[n] == 2.385 && u1[n] == 2.385);
  }
}

enum { N_PATHS = 4096, N_ITERATIONS = 256, N_SAMPLES = N_PATHS * N_ITERATIONS };
static double sample[2][N_SAMPLES];

static void draw_samples(struct rng_key key, uint32_t pair, int row) {
  static uint64_t path[N_PATHS];
  static double other[N_PATHS];
  for (int j = 0; j < N_PATHS; j++) path[j] = (uint64_t)j;
  for (int i = 0; i < N_ITERATIONS; i++)
    rng_fill(key, (uint64_t)i + 1, path, N_PATHS, pair, sample[row] + i * N_PATHS, other);
}

static void numbers_lie_in_the_half_open_interval_on_a_grid_of_53_bits(void **state) {
  (void)state;
  draw_samples(key_of_test(__func__, 1), 0, 0);
  int odd = 0;
  for (int j = 0; j < N_SAMPLES; j++) {
    double scaled = ldexp(sample[0][j], 53);
    assert_true(sample[0][j] >= 0 && sample[0][j] < 1);
    assert_true(scaled == floor(scaled));
    odd += fmod(scaled, 2) == 1;
  }
  // The last bit is a fair coin: binomial, sd 512, level 1e-6 (4.9 sd).
  assert_true(abs(odd - N_SAMPLES / 2) < 4.9 * 512);
}

// 2^20 samples in 1024 cells: sd of chi-squared sqrt(2 * 1023) = 45.2; level 1e-6 each (4.9 sd).
// Finds cells that are unequal by 0.5 % rms.
static void numbers_are_uniform_in_the_interval_and_in_the_square(void **state) {
  (void)state;
  static const char *const names[] = {"interval", "lagged by path", "neighbouring dimensions"};
  draw_samples(key_of_test(__func__, 1), 0, 0);
  draw_samples(key_of_test(__func__, 1), 1, 1);
  for (int test = 0; test < 3; test++) {
    int count[1024] = {0};
    double chi2 = 0, expected = N_SAMPLES / 1024.0;
    for (int j = 0; j < N_SAMPLES; j++) {
      double u = sample[0][j], v = test == 1 ? sample[0][(j + 1) % N_SAMPLES] : sample[1][j];
      count[test == 0 ? (int)(1024 * u) : (int)(32 * u) * 32 + (int)(32 * v)]++;
    }
    for (int c = 0; c < 1024; c++) chi2 += (count[c] - expected) * (count[c] - expected) / expected;
    if (fabs(chi2 - 1023) > 4.9 * sqrt(2 * 1023)) fail_msg("%s: chi-squared %g", names[test], chi2);
  }
}

// Of n independent pairs of uniforms, sqrt(n) times the correlation is standard normal.
static double correlation_z(const double *u, const double *v, int n) {
  double sum = 0;
  for (int j = 0; j < n; j++) sum += (u[j] - 0.5) * (v[j] - 0.5);
  return sum * 12 / sqrt(n);
}

static void streams_differ_and_are_uncorrelated(void **state) {
  (void)state;
  static const struct {
    uint64_t seed, run;
    enum rng_purpose purpose;
    uint32_t pair;
  } other[] = {
      {0, 2, RNG_TEST, 0},    {0, 1, RNG_EYE, 0},       {1, 1, RNG_TEST, 0},
      {1, 0, RNG_TEST, 0},    {0, 1, RNG_TEST, 1},      {0, (uint64_t)1 << 32, RNG_TEST, 0},
      {0, 1, RNG_PHOTONS, 0}, {0, 1, RNG_REFERENCE, 0},
  };
  uint64_t seed = rng_hash_name(__func__);
  draw_samples(rng_key(seed, 1, RNG_TEST), 0, 0);
  for (size_t k = 0; k < sizeof other / sizeof other[0]; k++) {
    struct rng_key key = rng_key(seed + other[k].seed, other[k].run, other[k].purpose);
    draw_samples(key, other[k].pair, 1);
    double z = correlation_z(sample[0], sample[1], N_SAMPLES); // level 1e-6
    if (fabs(z) > 4.9) fail_msg("stream %zu: correlation %g sd", k, z);
  }
  // Neighbouring iterations and paths of one stream.
  assert_true(fabs(correlation_z(sample[0], sample[0] + N_PATHS, N_SAMPLES - N_PATHS)) < 4.9);
  assert_true(fabs(correlation_z(sample[0], sample[0] + 1, N_SAMPLES - 1)) < 4.9);
}

static int compare_keys(const void *a, const void *b) {
  return memcmp(a, b, sizeof(struct rng_key));
}

// A 64-bit hash of 60000 keys collides with probability 1e-10; 32 bits would, 0.42 times on
// average, and a sum of seed and run surely.
static void keys_of_seeds_runs_and_purposes_are_distinct(void **state) {
  (void)state;
  enum { SEEDS = 100, RUNS = 150, PURPOSES = 4 };
  static struct rng_key key[SEEDS * RUNS * PURPOSES];
  int n = 0;
  for (uint64_t seed = 0; seed < SEEDS; seed++)
    for (uint64_t run = 0; run < RUNS; run++)
      for (int purpose = RNG_PHOTONS; purpose <= RNG_TEST; purpose++)
        key[n++] = rng_key(seed, run, (enum rng_purpose)purpose);
  assert_int_equal(n, SEEDS * RUNS * PURPOSES);
  qsort(key, (size_t)n, sizeof key[0], compare_keys);
  for (int k = 1; k < n; k++) assert_true(compare_keys(&key[k - 1], &key[k]) != 0);
}

// The mean of N iterations over K runs: its variance between runs must be 1/(12 n) with n the
// numbers in one mean. A seed shared between runs gives 0, between iterations 256 times too much,
// between pairs of neighbouring paths twice; the mean alone would show none of them.
static void the_variance_between_runs_is_that_of_independent_numbers(void **state) {
  (void)state;
  enum { RUNS = 200, ITERATIONS = 256, PATHS = 64 };
  uint64_t path[PATHS];
  double mean[RUNS] = {0}, u0[PATHS], u1[PATHS], total = 0, m2 = 0;
  for (int j = 0; j < PATHS; j++) path[j] = (uint64_t)j;
  for (int k = 0; k < RUNS; k++) {
    struct rng_key key = key_of_test(__func__, (uint64_t)k + 1);
    for (uint64_t i = 1; i <= ITERATIONS; i++) {
      rng_fill(key, i, path, PATHS, 3, u0, u1);
      for (int j = 0; j < PATHS; j++) mean[k] += (u0[j] + u1[j]) / (2 * PATHS * ITERATIONS);
    }
    total += mean[k] / RUNS;
  }
  for (int k = 0; k < RUNS; k++) m2 += (mean[k] - total) * (mean[k] - total);
  // (K-1) ratio is chi-squared with K-1 degrees: sd of the ratio sqrt(2/199) = 0.1; level 1e-6.
  double ratio = m2 / (RUNS - 1) * 12 * (2 * PATHS * ITERATIONS);
  if (fabs(ratio - 1) > 4.9 * sqrt(2.0 / (RUNS - 1))) fail_msg("variance ratio %g", ratio);
  assert_true(fabs(total - 0.5) < 4.9 / sqrt(12.0 * RUNS * 2 * PATHS * ITERATIONS));
}

static void names_are_hashed_by_fnv1a(void **state) {
  (void)state;
  // Test vectors of the authors (Fowler, Noll, Vo).
  assert_true(rng_hash_name("") == 0xcbf29ce484222325);
  assert_true(rng_hash_name("a") == 0xaf63dc4c8601ec8c);
  assert_true(rng_hash_name("foobar") == 0x85944171f73967e8);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(philox_gives_the_known_answers_of_random123),
      cmocka_unit_test(philox_equals_random123_on_a_million_words),
      cmocka_unit_test(every_level_equals_philox_for_every_length_and_counter),
      cmocka_unit_test(fill_equals_philox_for_every_length),
      cmocka_unit_test(numbers_lie_in_the_half_open_interval_on_a_grid_of_53_bits),
      cmocka_unit_test(numbers_are_uniform_in_the_interval_and_in_the_square),
      cmocka_unit_test(streams_differ_and_are_uncorrelated),
      cmocka_unit_test(keys_of_seeds_runs_and_purposes_are_distinct),
      cmocka_unit_test(the_variance_between_runs_is_that_of_independent_numbers),
      cmocka_unit_test(names_are_hashed_by_fnv1a),
  };
  return cmocka_run_group_tests_name("rng", tests, NULL, NULL);
}
