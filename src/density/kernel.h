// Kernels psi on the unit ball: k_r(y) = r^-d psi(|y|/r), integral 1 in d dimensions (theory 1.2).
// A radius is always the support. A kernel is one row of the table in kernel.c; nothing else knows one.
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
  // w[j] = psi(u) / psi(0) at |u|^2 = t2[j] in [0, 1), j < n; the caller makes the test |u| < 1.
  void (*shape)(const double *t2, double *w, int n);
  // Closed forms in d = 1, 2, 3 dimensions.
  struct kernel_constants (*constants)(int d);
};

extern const struct kernel kernels[];
extern const int n_kernels;

const struct kernel *kernel_find(const char *name); // NULL if unknown

// psi at |u|^2 = t2 in dimension d; 0 for t2 >= 1.
double kernel_value(const struct kernel *, int d, double t2);

#endif
