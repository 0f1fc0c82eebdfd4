// SIMD levels: instruction sets for which the hot loops are compiled apart. All levels give the
// same bits. The highest one the machine has is used, or the one named by the environment variable
// PHOTONLAB_SIMD.
//
// A file NAME.lanes.c is compiled once for each level of the architecture (Makefile: LEVEL is then
// scalar, avx2 or avx512) and defines a table of its bodies, all names with LEVEL_NAME:
//   const struct thing_level LEVEL_NAME(thing_level) = {...};
// Whoever calls them declares LEVEL_TABLES(thing_level) and asks LEVEL_TABLE(thing_level)->body().
#ifndef BASE_LEVEL_H
#define BASE_LEVEL_H

enum level { LEVEL_SCALAR, LEVEL_AVX2, LEVEL_AVX512, LEVELS };
extern const char *const level_names[LEVELS];

// The machine's highest.
enum level level_best(void);

// The one in use.
enum level level_chosen(void);

// For tests and benchmarks, which compare levels: at most the best.
void level_choose(enum level);

#define LEVEL_PASTE(name, level) name##_##level
#define LEVEL_PASTE_EXPANDED(name, level) LEVEL_PASTE(name, level)
#define LEVEL_NAME(name) LEVEL_PASTE_EXPANDED(name, LEVEL)

#ifdef __x86_64__
#define LEVEL_TABLES(table) extern const struct table table##_scalar, table##_avx2, table##_avx512
#define LEVEL_TABLE(table)                                                                         \
  ((const struct table *const[LEVELS]){&table##_scalar, &table##_avx2,                             \
                                       &table##_avx512}[level_chosen()])
#else
#define LEVEL_TABLES(table) extern const struct table table##_scalar
#define LEVEL_TABLE(table) (&table##_scalar)
#endif

#endif
