#define _GNU_SOURCE // setenv
#include "base/threads.h"

#include <omp.h>
#include <stdlib.h>

// Threads wait for each other asleep. By OpenMP's default they spin, which on a busy machine takes
// the core from the very thread they wait for. The user may still say otherwise. LLVM's run time
// looks when it is first used, GNU's before main: it is linked statically (Makefile), since what a
// shared library does first comes before any of this.
__attribute__((constructor(101))) static void wait_asleep(void) {
  setenv("OMP_WAIT_POLICY", "passive", 0);
}

int threads_available(void) { return omp_get_max_threads(); }
