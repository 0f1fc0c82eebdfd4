// What an interface reflects and where it sends the rest. Directions are unit vectors that point
// away from the surface. eta is relative: the index on the side the normal points away from, over
// the index on its side.
#ifndef SCENE_MATERIAL_FRESNEL_H
#define SCENE_MATERIAL_FRESNEL_H

#include "base/vec.h"

#include <stdbool.h>

// Mirror image of w about n.
static inline struct vec fresnel_reflect(struct vec w, struct vec n) {
  return vec_along(vec_scale(w, -1), n, 2 * vec_dot(w, n));
}

// Snell: eta^2 cos^2(theta_t), negative where reflection is total. Not 1 - sin^2 / eta^2, which
// loses grazing angles at eta = 1.
static inline double fresnel_snell(double cosine, double eta) {
  return (eta - 1) * (eta + 1) + cosine * cosine;
}

// The direction that continues w beyond the interface with normal n, from whichever side w is on.
// *eta_path: the index beyond over the index at w. False: total internal reflection.
static inline bool fresnel_refract(struct vec w, struct vec n, double eta, double *eta_path,
                                   struct vec *out) {
  double cosine = vec_dot(w, n);
  if (cosine < 0) {
    cosine = -cosine;
    n = vec_scale(n, -1);
    eta = 1 / eta;
  }
  *eta_path = eta;
  double g2 = fresnel_snell(cosine, eta);
  if (!(g2 > 0)) return false;
  *out = vec_scale(vec_along(vec_scale(w, -1), n, cosine - sqrt(g2)), 1 / eta);
  return true;
}

// Unpolarised reflectance of a dielectric; cosine < 0: from the far side. 1 where total.
static inline double fresnel_dielectric(double cosine, double eta) {
  if (cosine < 0) {
    cosine = -cosine;
    eta = 1 / eta;
  }
  double g2 = fresnel_snell(cosine, eta);
  if (!(g2 > 0)) return 1;
  double g = sqrt(g2), across = eta * eta * cosine;
  double perpendicular = (cosine - g) / (cosine + g), parallel = (across - g) / (across + g);
  return (perpendicular * perpendicular + parallel * parallel) / 2;
}

// Unpolarised reflectance of a conductor of relative index eta + i k; cosine in [0, 1]. With
// (a + i b)^2 = (eta + i k)^2 - sin^2, a >= 0 (Born and Wolf 14.2):
//   R_s = |cos - (a + i b)|^2 / |cos + (a + i b)|^2,
//   R_p = R_s |a + i b - sin^2 / cos|^2 / |a + i b + sin^2 / cos|^2.
static inline double fresnel_conductor(double cosine, double eta, double k) {
  double cos2 = cosine * cosine, sin2 = 1 - cos2;
  double real = fresnel_snell(cosine, eta) - k * k, imaginary = 2 * eta * k;
  double square = sqrt(real * real + imaginary * imaginary); // a^2 + b^2
  // The other form of the root loses its digits where eta << k.
  double a = real >= 0 ? sqrt((square + real) / 2) : imaginary / sqrt(2 * (square - real));
  double even = square + cos2, odd = 2 * a * cosine;
  double perpendicular = (even - odd) / (even + odd);
  double even_p = cos2 * square + sin2 * sin2, odd_p = odd * sin2;
  double sum_p = even_p + odd_p; // 0 for eta = k = 0 seen straight on
  double ratio = sum_p > 0 ? (even_p - odd_p) / sum_p : 1;
  return perpendicular * (1 + ratio) / 2;
}

#endif
