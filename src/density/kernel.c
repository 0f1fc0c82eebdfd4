#include "density/kernel.h"

#include "base/simd.h"

#include <string.h>

SIMD_TABLES(kernel_level);

const struct kernel *kernel_find(const char *name) {
  for (int k = 0; k < n_kernels; k++)
    if (strcmp(kernels[k].name, name) == 0) return &kernels[k];
  return NULL;
}

int kernel_weigh(const struct kernel *kernel, const double *distance2, double r, double *w, int n) {
  return SIMD_TABLE(kernel_level)->row[kernel - kernels].weigh(distance2, r, w, n);
}

double kernel_value(const struct kernel *kernel, int d, double t2) {
  double w;
  kernel_weigh(kernel, &t2, 1, &w, 1);
  return kernel->constants(d).c * w;
}
