// Sums and counters: terms to 1e9, counts to 2^40.
#include "app/stability.h"
#include "density/gather.h"
#include "density/law.h"
#include "moments/moments.h"
#include "numeric/pair.h"
#include "numeric/rng.h"
#include "numeric/sum.h"

#include <math.h>
#include <stddef.h>

// ---- sums of numbers uniform in [0, 1), and of equal ones, as the box weighs equal photons ----

static const double equal_term = 0.1;

struct sums {
  uint64_t n, exact; // exact: in units of 2^-32
  double lane[SUM_LANES], running, equal[SUM_LANES];
  float single;
};

static void sums_add(struct sums *sums, uint64_t n) {
  for (; sums->n < n; sums->n += SUM_LANES)
    for (uint64_t k = 0; k < SUM_LANES; k++) {
      uint64_t bits = stability_term(sums->n + k);
      double x = (double)(int64_t)bits * 0x1p-32;
      sums->exact += bits;
      sums->lane[k] += x;
      sums->equal[k] += equal_term;
      sums->running += x;
      sums->single += (float)x;
    }
}

// Levels rise and are multiples of the lanes; the sums of one are continued to the next.
static const struct sums *sums_to(double n) {
  static struct sums sums;
  if ((double)sums.n > n) sums = (struct sums){0};
  sums_add(&sums, (uint64_t)n);
  return &sums;
}

static double sum_error(const struct sums *sums, double sum) {
  double exact = (double)sums->exact * 0x1p-32;
  return fabs(sum - exact) / exact;
}

static double photons_of_a_disc(double unused, double n) {
  (void)unused;
  const struct sums *sums = sums_to(n);
  return sum_error(sums, sum_lanes(sums->lane));
}

static double equal_photons(double unused, double n) {
  (void)unused;
  return fabs(sum_lanes(sums_to(n)->equal) / (equal_term * n) - 1);
}

static double iterations_of_a_run(double unused, double n) {
  (void)unused;
  const struct sums *sums = sums_to(n);
  return sum_error(sums, sums->running);
}

static double sum_in_float(double unused, double n) {
  (void)unused;
  const struct sums *sums = sums_to(n);
  return sum_error(sums, sums->single);
}

// Roundings of a growing sum, at most half an ulp each, as if independent: their standard deviation
// relative to the sum is at most sqrt(n) 2^-53 / 3; this is three of them.
static double sum_bound(double unused, double n) {
  (void)unused;
  return sqrt(n) * 0x1p-53;
}

static double lanes_bound(double unused, double n) {
  return sum_bound(unused, n / SUM_LANES) + 4 * 0x1p-53;
}

// All roundings to the same side, in lanes of n / 8.
static double equal_bound(double unused, double n) {
  (void)unused;
  return (n / SUM_LANES + 4) * 0x1p-53;
}

// ---- the same by the estimate itself: photons within one disc ----

static void scatter_one(const struct bsdf *bsdf, struct vec wo, struct vec wi,
                        enum transport transport, double f[3]) {
  (void)bsdf, (void)wo, (void)wi, (void)transport;
  f[0] = 1;
}
static const struct bsdf_type scatters_one = {.value = scatter_one};

static struct photons photons_in_disc(int64_t n, struct arena *arena) {
  struct photons photons = {.count = n,
                            .n_channels = 1,
                            .position = arena_new(arena, struct vec, n),
                            .wi = arena_new(arena, struct vec, n),
                            .flux = {arena_new(arena, double, n)},
                            .vertex = arena_new(arena, uint16_t, n),
                            .kind = arena_new(arena, uint8_t, n)};
  for (int64_t j = 0; j < n; j++) {
    photons.position[j].x = (double)j / (double)n;
    photons.wi[j].z = 1;
    photons.flux[0][j] = (double)(int64_t)stability_term((uint64_t)j) / 3;
  }
  return photons;
}

static double estimate_of_a_disc(double unused, double n) {
  (void)unused;
  const struct vec z = {0, 0, 1};
  struct arena arena = arena_reserve(), scratch = arena;
  struct photons photons = photons_in_disc((int64_t)n, &scratch);
  struct eye_point point = {
      .wo = z, .weight = {1}, .bsdf = {.type = &scatters_one, .n = z, .ng = z}};
  struct disc disc = {kernel_find("box"), 2, 1};
  struct grid grid = {0};
  struct gather gather = {0};
  double out = 0;
  struct pair exact = {0, 0};
  grid_build(&grid, &photons, disc.r, &scratch);
  gather_point(&gather, &grid, &point, 1, &disc, 1, NULL, &out, 1, &scratch);
  for (int64_t j = 0; j < photons.count; j++)
    exact = pair_add(exact, (struct pair){photons.flux[0][j], 0});
  arena_release(arena);
  return fabs(out - exact.hi) / exact.hi;
}

// ---- counts of local statistics: passes that find ten photons each ----

static double photons_counted(double alpha, double passes) {
  const struct law *law = law_find("hachisuka");
  double count = 0, ratio;
  for (double pass = 0; pass < passes; pass++) count = law->count(alpha, count, 10, &ratio);
  double exact = 10 + 10 * alpha * passes;
  return fabs(count - exact) / exact;
}

static double photons_counted_in_float(double alpha, double passes) {
  float count = 10, more = 10 * (float)alpha;
  for (double pass = 0; pass < passes; pass++) count += more;
  double exact = 10 + 10 * alpha * passes;
  return fabs((double)count - exact) / exact;
}

// All roundings to the same side.
static double photons_counted_bound(double alpha, double passes) {
  (void)alpha;
  return (passes + 2) * 0x1p-53;
}

// ---- counters ----

// As blocks of runs are merged, and one run more.
static double runs_merged(double unused, double level) {
  (void)unused;
  struct moments all = moments_of(2.385);
  for (double n = 1; n < level; n *= 2) all = moments_merge(all, all);
  return fabs(moments_merge(all, moments_of(2.385)).n - (level + 1)) + fabs(all.mean - 2.385);
}

static double photons_divided_by(double unused, double level) {
  (void)unused;
  double scale = disc_of(NULL, 1, 0.5, 2, (uint64_t)level + 1).scale;
  return fabs(scale * (level + 1) / 4 - 1);
}

// The share of numbers that are those of a counter cut to 24 or 32 bits, or of the one before.
static double share_repeated(bool path_is_stressed, double level) {
  enum { N = 64 };
  const uint64_t counter = (uint64_t)level + 5;
  const uint64_t other[] = {counter % (1 << 24), counter & UINT32_MAX, counter - 1};
  const struct rng_key key = rng_key(1, 1, RNG_TEST);
  int equal = 0;
  for (uint64_t j = 0; j < N; j++)
    for (int k = 0; k < 3; k++) {
      if (other[k] == counter) continue;
      double a[2], b[2];
      uint64_t path[2] = {path_is_stressed ? counter : j, path_is_stressed ? other[k] : j};
      rng_fill(key, path_is_stressed ? j : counter, &path[0], 1, 0, &a[0], &a[1]);
      rng_fill(key, path_is_stressed ? j : other[k], &path[1], 1, 0, &b[0], &b[1]);
      equal += a[0] == b[0];
    }
  return equal / (3.0 * N);
}

static double iterations_told_apart(double unused, double level) {
  (void)unused;
  return share_repeated(false, level);
}

static double paths_told_apart(double unused, double level) {
  (void)unused;
  return share_repeated(true, level);
}

static double count_in_float(double unused, double level) {
  (void)unused;
  float count = (float)level, next = count + 1;
  return fabs((double)next - (double)count - 1);
}

static double count_in_32_bits(double unused, double level) {
  (void)unused;
  return fabs((double)((uint32_t)(uint64_t)level + UINT32_C(1)) - (level + 1)) / (level + 1);
}

static double nothing(double unused, double level) {
  (void)unused, (void)level;
  return 0;
}

static double one_ulp(double unused, double level) {
  (void)unused, (void)level;
  return 0x1p-52;
}

// clang-format off
const struct stress stress_sums[] = {
  {"sums", "photons of a disc", "n", 1e3, 1e9, 10, 0, photons_of_a_disc, lanes_bound, NULL},
  {"sums", "estimate of a disc", "n", 1e3, 1e6, 10, 0, estimate_of_a_disc, lanes_bound, NULL},
  {"sums", "equal photons of a disc", "n", 1e3, 1e9, 10, 0, equal_photons, equal_bound, NULL},
  {"sums", "iterations of a run", "n", 1e3, 1e9, 10, 0, iterations_of_a_run, sum_bound, NULL},
  {"sums", "in float", "n", 1e3, 1e9, 10, 0, sum_in_float, NULL, NULL},
  {"sums", "photons counted in n passes", "n", 1e3, 1e7, 10, 2.0 / 3,
   photons_counted, photons_counted_bound, NULL},
  {"sums", "photons counted in float", "n", 1e3, 1e7, 10, 2.0 / 3,
   photons_counted_in_float, NULL, NULL},
  {"counters", "runs merged", "count", 0x1p20, 0x1p40, 4, 0, runs_merged, nothing, NULL},
  {"counters", "photons divided by", "count", 0x1p20, 0x1p40, 4, 0,
   photons_divided_by, one_ulp, NULL},
  {"counters", "iterations told apart", "count", 0x1p20, 0x1p40, 4, 0,
   iterations_told_apart, nothing, NULL},
  {"counters", "paths told apart", "count", 0x1p20, 0x1p40, 4, 0, paths_told_apart, nothing, NULL},
  {"counters", "in float", "count", 0x1p20, 0x1p40, 4, 0, count_in_float, NULL, NULL},
  {"counters", "in 32 bits", "count", 0x1p20, 0x1p40, 4, 0, count_in_32_bits, NULL, NULL},
  {0},
};
// clang-format on
