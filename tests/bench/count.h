// How many rays, those towards lights included, the walks have traced since the last call.
#ifndef TESTS_BENCH_COUNT_H
#define TESTS_BENCH_COUNT_H

#include <stdint.h>

int64_t count_rays(void);

#endif
