// For tests: scenes from text, random numbers named by their test, chi-squared limits.
#ifndef TESTS_UNIT_SCENE_TEXT_H
#define TESTS_UNIT_SCENE_TEXT_H

#include "numeric/rng.h"
#include "scene/reader.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <string.h>

// Reserved once in a program; a scene lives until the next is read.
struct test_memory {
  struct arena keep, lists, scratch;
};

static inline struct test_memory *test_memory(void) {
  static struct test_memory memory;
  if (!memory.keep.next)
    memory = (struct test_memory){arena_reserve(), arena_reserve(), arena_reserve()};
  return &memory;
}

static inline bool scene_of_bytes(const char *bytes, ptrdiff_t length, struct scene *scene,
                                  struct problem *problem) {
  struct test_memory memory = *test_memory();
  *problem = (struct problem){{0}};
  struct text text = {arena_string(&memory.lists, bytes, length), length};
  return scene_read_text("t.pbrt", "", text, &memory.keep, memory.lists, memory.scratch, scene,
                         problem);
}

// The scene of a text that must be right.
static inline struct scene scene_of(const char *text) {
  struct scene scene;
  struct problem problem;
  if (!scene_of_bytes(text, (ptrdiff_t)strlen(text), &scene, &problem))
    fail_msg("%s", problem.text);
  return scene;
}

struct draw {
  struct rng_key key;
  uint64_t path;
};

static inline struct draw draw_named(const char *test) {
  return (struct draw){.key = rng_key(rng_hash_name(test), 1, RNG_TEST)};
}

static inline void draw_pair(struct draw *draw, double *u0, double *u1) {
  rng_fill(draw->key, 1, &draw->path, 1, 0, u0, u1);
  draw->path++;
}

static inline double draw_between(struct draw *draw, double lo, double hi) {
  double u0, u1;
  draw_pair(draw, &u0, &u1);
  return lo + (hi - lo) * u0;
}

static inline struct vec draw_direction(struct draw *draw) {
  double u0, u1;
  draw_pair(draw, &u0, &u1);
  double z = 1 - 2 * u0, r = sqrt(1 - z * z), phi = 2 * acos(-1.0) * u1;
  return vec(r * cos(phi), r * sin(phi), z);
}

// The z of level 3e-7 (one side).
#define Z_LIMIT 5.0

// The chi-squared with `freedom` degrees exceeded with probability 3e-7 (Wilson, Hilferty 1931).
static inline double chi2_limit(double freedom) {
  double a = 2 / (9 * freedom), root = 1 - a + Z_LIMIT * sqrt(a);
  return freedom * root * root * root;
}

#endif
