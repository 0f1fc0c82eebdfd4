// Kernels psi on the unit ball: k_r(y) = r^-d psi(|y|/r), integral 1 in d dimensions (theory 1.2).
// A radius is always the support. A kernel is one row of the table in kernel.lanes.c; nothing else
// knows one.
#ifndef DENSITY_KERNEL_H
#define DENSITY_KERNEL_H

struct kernel_constants {
  double c;          // psi(0)
  double mu2;        // integral of u_1^2 psi
  double roughness;  // R, integral of psi^2
  double roughness2; // R2, integral of |u|^2 psi^2
};

struct kernel {
  const char *name, *formula, *source;
  // The body of kernel_weigh.
  int (*weigh)(const double *distance2, double r, double *w, int n);
  // Closed forms in d = 1, 2, 3 dimensions.
  struct kernel_constants (*constants)(int d);
};

// The table; each SIMD level has one, with the same rows but for `weigh`.
struct kernel_level {
  const struct kernel *row;
  int n;
};
extern const struct kernel_level kernel_level_scalar;
#define kernels (kernel_level_scalar.row)
#define n_kernels (kernel_level_scalar.n)

const struct kernel *kernel_find(const char *name); // NULL if unknown

// w[j] = psi(u) / psi(0) at |u|^2 = distance2[j] * (1 / (r * r)), j < n; 0 where that is not below
// 1. Returns at how many it is.
int kernel_weigh(const struct kernel *, const double *distance2, double r, double *w, int n);

// psi at |u|^2 = t2 in dimension d; 0 for t2 >= 1.
double kernel_value(const struct kernel *, int d, double t2);

#endif
