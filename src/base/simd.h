// SIMD levels: instruction sets for which the hot loops are compiled apart. All levels give the
// same bits. The highest one the machine has is used, or the one named by the environment variable
// PHOTONLAB_SIMD.
//
// A file NAME.lanes.c is compiled once for each level of the architecture (Makefile: SIMD is then
// scalar, avx2 or avx512) and defines a table of its bodies, all names with SIMD_NAME:
//   const struct thing_level SIMD_NAME(thing_level) = {...};
// Whoever calls them declares SIMD_TABLES(thing_level) and asks SIMD_TABLE(thing_level)->body().
#ifndef BASE_SIMD_H
#define BASE_SIMD_H

enum simd { SIMD_SCALAR, SIMD_AVX2, SIMD_AVX512, SIMD_LEVELS };
extern const char *const simd_names[SIMD_LEVELS];

// The machine's highest.
enum simd simd_best(void);

// The one in use.
enum simd simd_chosen(void);

// For tests and benchmarks, which compare levels: at most the best.
void simd_choose(enum simd);

#define SIMD_PASTE(name, level) name##_##level
#define SIMD_PASTE_EXPANDED(name, level) SIMD_PASTE(name, level)
#define SIMD_NAME(name) SIMD_PASTE_EXPANDED(name, SIMD)

#ifdef __x86_64__
#define SIMD_TABLES(table) extern const struct table table##_scalar, table##_avx2, table##_avx512
#define SIMD_TABLE(table)                                                                          \
  ((const struct table *const[SIMD_LEVELS]){&table##_scalar, &table##_avx2,                        \
                                            &table##_avx512}[simd_chosen()])
#else
#define SIMD_TABLES(table) extern const struct table table##_scalar
#define SIMD_TABLE(table) (&table##_scalar)
#endif

#endif
