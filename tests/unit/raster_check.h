// Images made byte by byte in the tests, decoded and compared.
#ifndef TESTS_UNIT_RASTER_CHECK_H
#define TESTS_UNIT_RASTER_CHECK_H

#include "image/raster.h"
#include "numeric/rng.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

// A file being made.
struct bytes {
  unsigned char data[1 << 16];
  int n;
};

static inline void put(struct bytes *file, const void *data, int n) {
  assert_true(file->n + n <= (int)sizeof file->data);
  memcpy(file->data + file->n, data, (size_t)n);
  file->n += n;
}
static inline void put_text(struct bytes *file, const char *text) {
  put(file, text, (int)strlen(text));
}
static inline void put_byte(struct bytes *file, int byte) {
  put(file, &(unsigned char){(unsigned char)byte}, 1);
}

static const struct encoding as_srgb = {ENCODING_SRGB, 1}, as_linear = {ENCODING_LINEAR, 1};
static struct arena raster_arena, raster_scratch;

// Under asan a byte read behind the file shows: it is decoded from a copy of exactly its length.
static inline bool decode(const struct bytes *file, const char *path, struct encoding encoding,
                          struct raster *raster, struct problem *problem) {
  struct arena scratch = raster_scratch;
  unsigned char *copy = arena_new(&scratch, unsigned char, file->n ? file->n : 1);
  memcpy(copy, file->data, (size_t)file->n);
  *problem = (struct problem){0};
  return raster_decode((struct text){(char *)copy, file->n}, path, encoding, &raster_arena, scratch,
                       raster, problem);
}

static inline struct raster decode_ok(const struct bytes *file, const char *path,
                                      struct encoding encoding) {
  struct raster raster;
  struct problem problem;
  if (!decode(file, path, encoding, &raster, &problem)) fail_msg("%s", problem.text);
  return raster;
}

static inline void assert_shape(const struct raster *raster, int width, int height, int n) {
  assert_int_equal(raster->width, width);
  assert_int_equal(raster->height, height);
  assert_int_equal(raster->n_channels, n);
}

// Encoded values, rows from the top.
static inline void assert_bytes(const struct raster *raster, const unsigned char *expected) {
  assert_non_null(raster->byte);
  assert_memory_equal(raster->byte, expected,
                      (size_t)raster->width * (size_t)raster->height * (size_t)raster->n_channels);
}

static inline void assert_refused(const struct bytes *file, const char *path, const char *says) {
  struct raster raster;
  struct problem problem;
  assert_false(decode(file, path, as_srgb, &raster, &problem));
  if (!strstr(problem.text, says)) fail_msg("\nexpected %s\ngot      %s", says, problem.text);
  assert_true(strncmp(problem.text, path, strlen(path)) == 0 && !strchr(problem.text, '\n'));
}

// Every prefix is refused in one line; with bytes changed it is read or refused. Returns how many
// changed files were refused.
static inline int assert_survives(const struct bytes *file, const char *path, int trials) {
  static struct bytes bad;
  struct rng_key key = rng_key(rng_hash_name(path), 1, RNG_TEST);
  struct raster raster;
  struct problem problem;
  int refused = 0;
  for (bad = *file, bad.n = 0; bad.n < file->n; bad.n++) {
    struct arena kept = raster_arena;
    assert_false(decode(&bad, path, as_srgb, &raster, &problem));
    assert_true(problem.text[0] && !strchr(problem.text, '\n'));
    raster_arena = kept;
  }
  for (int trial = 0; trial < trials; trial++) {
    uint32_t word[4];
    rng_philox(key, (uint32_t[4]){(uint32_t)trial, 0, 0, 0}, word);
    bad = *file;
    bad.data[word[0] % (uint32_t)file->n] = (unsigned char)word[1];
    if (trial % 3 == 0) bad.data[word[2] % (uint32_t)file->n] = (unsigned char)word[3];
    struct arena kept = raster_arena;
    bool ok = decode(&bad, path, as_srgb, &raster, &problem);
    assert_true(ok == (problem.text[0] == 0) && !strchr(problem.text, '\n'));
    refused += !ok;
    raster_arena = kept;
  }
  return refused;
}

#endif
