#include "base/level.h"

#include "base/problem.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

const char *const level_names[LEVELS] = {"scalar", "avx2", "avx512"};

static enum level chosen;
static pthread_once_t once = PTHREAD_ONCE_INIT;

// What the Makefile lets the compiler use for each.
enum level level_best(void) {
#ifdef __x86_64__
  if (!__builtin_cpu_supports("avx2")) return LEVEL_SCALAR;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    return LEVEL_AVX512;
  return LEVEL_AVX2;
#else
  return LEVEL_SCALAR;
#endif
}

static void choose_by_name(void) {
  const char *name = getenv("PHOTONLAB_SIMD");
  chosen = level_best();
  if (!name || !*name) return;
  for (int level = 0; level <= (int)level_best(); level++)
    if (strcmp(level_names[level], name) == 0) {
      chosen = (enum level)level;
      return;
    }
  die("PHOTONLAB_SIMD=%s: the levels of this machine go from scalar to %s", name,
      level_names[level_best()]);
}

enum level level_chosen(void) {
  pthread_once(&once, choose_by_name);
  return chosen;
}

void level_choose(enum level level) {
  assert(level <= level_best());
  pthread_once(&once, choose_by_name);
  chosen = level;
}
