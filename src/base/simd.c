#include "base/simd.h"

#include "base/problem.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

const char *const simd_names[SIMD_LEVELS] = {"scalar", "avx2", "avx512"};

static enum simd chosen;
static pthread_once_t once = PTHREAD_ONCE_INIT;

// What the Makefile lets the compiler use for each.
enum simd simd_best(void) {
#ifdef __x86_64__
  if (!__builtin_cpu_supports("avx2")) return SIMD_SCALAR;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    return SIMD_AVX512;
  return SIMD_AVX2;
#else
  return SIMD_SCALAR;
#endif
}

static void choose_by_name(void) {
  const char *name = getenv("PHOTONLAB_SIMD");
  chosen = simd_best();
  if (!name || !*name) return;
  for (int level = 0; level <= (int)simd_best(); level++)
    if (strcmp(simd_names[level], name) == 0) {
      chosen = (enum simd)level;
      return;
    }
  die("PHOTONLAB_SIMD=%s: the levels of this machine go from scalar to %s", name,
      simd_names[simd_best()]);
}

enum simd simd_chosen(void) {
  pthread_once(&once, choose_by_name);
  return chosen;
}

void simd_choose(enum simd level) {
  assert(level <= simd_best());
  pthread_once(&once, choose_by_name);
  chosen = level;
}
